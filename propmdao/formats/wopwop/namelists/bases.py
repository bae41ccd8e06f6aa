"""Changes of base and grids of observers, as namelist groups describe them."""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Frame, Motion, poses, rotation, translation
from propmdao.formats.wopwop.namelists.groups import Group
from propmdao.formats.wopwop.namelists.keys import HARMONICS

#: Largest number of observers of a case.
MOST_OBSERVERS = 10_000


class Turning(NamedTuple):
    """Azimuth of a rotor, psi = rate t + angle, which periodic angles within it follow.

    Attributes
    ----------
    rate : float
        Rotation speed of the base with ``rotation = .true.`` [rad/s].
    angle : float
        Azimuth at time 0 [rad].
    """

    rate: float
    angle: float


def rotor_azimuth(group: Group) -> Turning | None:
    """Azimuth that a change of base sets for what is within it.

    Parameters
    ----------
    group : Group
        Group ``&CB`` of a namelist.

    Returns
    -------
    Turning or None
        Azimuth of the rotor, None if the group is not its rotation.
    """
    if not group.flag("rotation") or "omega" not in group.values:
        return None
    return Turning(group.number("omega"), group.number("psi0", 0.0))


def change_of_base(group: Group, rotor: Turning | None = None) -> Motion:
    """Frames of a ``&CB`` group, a change of base: its translation, then its rotation.

    Parameters
    ----------
    group : Group
        Group ``&CB`` of a namelist.
    rotor : Turning, optional
        Azimuth of the rotor around the base, for periodic angles without an Omega of their own.

    Returns
    -------
    Motion
        Chain of no frame, one or two.

    Raises
    ------
    WopwopFileError
        If a type is not one of those computed: time-independent, known function or periodic.
    """
    if group.flag("windframe"):
        raise group.error("a wind frame (windFrame) is not computed")
    moves = _type(group, "translation", ("TimeIndependent", "KnownFunction"))
    keys = ("translationvalue",) if moves == "timeindependent" else ("y0", "vh", "ah")
    steps = [group.vector(key) for key in keys]
    frames: list[Frame] = [translation(*steps)] if np.any(steps) else []
    turns = _type(group, "angle", ("TimeIndependent", "KnownFunction", "Periodic"))
    if turns == "timeindependent" and not group.number("anglevalue", 0.0):
        return tuple(frames)
    axis = group.vector("axisvalue")
    _type(group, "axis", ("TimeIndependent",))
    if not any(axis):
        raise group.error("AxisValue must be three numbers, not all zero, where a base turns")
    if turns == "timeindependent":
        frames.append(rotation(axis, group.number("anglevalue")))
    elif turns == "knownfunction":
        frames.append(rotation(axis, group.number("psi0", 0.0), group.number("omega")))
    else:
        frames.append(_periodic(group, axis, rotor))
    return tuple(frames)


# Keys that have an effect with the type KnownFunction only.
_OF_FUNCTIONS = {"translation": ("ah", "vh", "y0"), "angle": ("omega", "psi0"), "axis": ()}


def _type(group: Group, kind: str, known: tuple[str, ...]) -> str:
    """Return the type of a translation, angle or axis; time-independent if it is not given."""
    written = group.text(f"{kind}type")
    if written is None:
        for key in _OF_FUNCTIONS[kind]:
            value = group.values.get(key)
            if any(value) if isinstance(value, list) else value:
                raise group.error(f"{key} needs {kind.capitalize()}Type 'KnownFunction'")
    chosen = (written or known[0]).lower()
    if chosen not in map(str.lower, known):
        raise group.error(
            f"{kind.capitalize()}Type {written!r} is not computed, only {' and '.join(known)}"
        )
    return chosen


def _periodic(group: Group, axis: tuple[float, float, float], rotor: Turning | None) -> Frame:
    """Angle A0 - A1 cos psi - B1 sin psi - ... with the azimuth psi of the rotor."""
    if group.number("psi0", 0.0):
        raise group.error("Psi0 is not computed with AngleType 'periodic': psi is the rotor's")
    if "omega" in group.values:
        rotor = Turning(group.number("omega"), 0.0)
    if rotor is None:
        raise group.error(
            "AngleType 'periodic' needs an Omega, or rotation = .true. in a base around this one"
        )
    a, b = ([group.number(f"{q}{k}", 0.0) for k in HARMONICS] for q in "ab")
    # cos k psi and sin k psi in terms of cos and sin of k times rate t
    turned = (np.array(a) - 1j * np.array(b)) * np.exp(1j * rotor.angle * np.array(HARMONICS))
    swing = [-turned.real, turned.imag]
    return rotation(axis, group.number("a0", 0.0), 0.0, swing, rotor.rate)


def uniform_motion(
    group: Group, chain: Motion, points: NDArray[np.float64]
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Position at time 0 and velocity of observers behind a chain of frames.

    Parameters
    ----------
    group : Group
        Group of the observers, which errors name.
    chain : Motion
        Frames that neither turn nor accelerate.
    points : (n, 3) array
        Positions in the innermost frame [m].

    Returns
    -------
    position : (n, 3) array
        Positions on the ground at time 0 [m].
    velocity : (3,) array
        Velocity on the ground [m/s].

    Raises
    ------
    WopwopFileError
        If a frame turns or accelerates.
    """
    if not all(frame.uniform for frame in chain):
        raise group.error("observers must be fixed or in uniform motion; these turn or accelerate")
    pose = poses(chain, np.zeros(1))
    position = pose.origin[0] + points @ pose.rotation[0].T
    return position, pose.velocity[0]


def observer_points(group: Group) -> tuple[NDArray[np.float64], tuple[int, int]]:
    """Observers in their own frame: one, a box or a part of a sphere.

    Parameters
    ----------
    group : Group
        An ``&ObserverIn`` group.

    Returns
    -------
    points : (n, 3) array
        Positions, the first index (x, or theta of a sphere) fastest [m].
    shape : tuple of int
        Numbers along the first and the second index of the grid; those of a box are i and j of the
        first two of its directions that have more than one, k counting with j.

    Raises
    ------
    WopwopFileError
        If the group describes the observers in another way.
    """
    if "filename" in group.values:
        raise group.error(
            "observers of a file (fileName) are not read: give xLoc ..., nbx ... or radius ..."
        )
    if "radius" in group.values:
        theta, psi = _grid(group, {"theta": "nbtheta", "psi": "nbpsi"})
        x, y, z = np.cos(psi) * np.cos(theta), np.cos(psi) * np.sin(theta), np.sin(psi)
        shape = group.count("nbtheta", 1), group.count("nbpsi", 1)
        return group.number("radius") * np.stack([x, y, z], axis=-1), shape
    if {"nbx", "nby", "nbz"} & group.values.keys():
        points = np.stack(_grid(group, {q: f"nb{q}" for q in "xyz"}), axis=-1)
        counts = [n for q in "xyz" if (n := group.count(f"nb{q}", 1)) > 1]
        first = counts[0] if len(counts) > 1 else 1
        return points, (first, len(points) // first)
    if {"xloc", "yloc", "zloc", "attachedto"} & group.values.keys():
        return np.array([[group.number(f"{q}loc", 0.0) for q in "xyz"]]), (1, 1)
    raise group.error("observers must be given as xLoc ..., nbx ... or radius ...")


def _grid(group: Group, axes: dict[str, str]) -> list[NDArray[np.float64]]:
    """Coordinates of all points of a grid, the first of the axes fastest."""
    counts = [group.count(key, 1, 1, MOST_OBSERVERS) for key in axes.values()]
    if math.prod(counts) > MOST_OBSERVERS:
        raise group.error(
            f"{' x '.join(axes.values())} must be at most {MOST_OBSERVERS} observers; "
            f"they are {math.prod(counts)}"
        )
    lines = [
        np.linspace(group.number(f"{name}min"), group.number(f"{name}max"), n)
        for name, n in zip(axes, counts, strict=True)
    ]
    return [a.ravel() for a in np.meshgrid(*lines[::-1], indexing="ij")][::-1]

"""Changes of base and grids of observers, as namelist groups describe them."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.motion import Frame, Motion, poses, rotation, translation
from propmdao.formats.wopwop.namelists import HARMONICS, Group


def change_of_base(group: Group) -> Motion:
    """Frames of a ``&CB`` group, a change of base: its translation, then its rotation.

    Parameters
    ----------
    group : Group
        Group ``&CB`` of a namelist.

    Returns
    -------
    Motion
        Chain of no frame, one or two.

    Raises
    ------
    WopwopFileError
        If a type is not one of those computed: time-independent, known function or periodic.
    """
    frames: list[Frame] = []
    moves, turns = ((group.text(f"{kind}type") or "").lower() for kind in ("translation", "angle"))
    if moves == "timeindependent":
        frames.append(translation(group.vector("translationvalue")))
    elif moves == "knownfunction":
        frames.append(translation(*(group.vector(key) for key in ("y0", "vh", "ah"))))
    elif moves:
        raise group.error(
            f"TranslationType {moves!r} is not computed, only TimeIndependent and KnownFunction"
        )
    if not turns:
        return tuple(frames)
    axis_type = (group.text("axistype") or "timeindependent").lower()
    axis = group.vector("axisvalue")
    if axis_type != "timeindependent" or not any(axis):
        raise group.error(
            "AxisType must be TimeIndependent with an AxisValue that is not zero; "
            f"it is {axis_type!r} with {axis}"
        )
    if turns == "timeindependent":
        frames.append(rotation(axis, group.number("anglevalue")))
    elif turns == "knownfunction":
        frames.append(rotation(axis, group.number("psi0", 0.0), group.number("omega")))
    elif turns == "periodic":
        if group.number("psi0", 0.0):
            raise group.error("Psi0 is not computed with AngleType 'periodic': psi is Omega t")
        # A0 - A1 cos psi - B1 sin psi - ...
        swing = [[-group.number(f"{q}{k}", 0.0) for k in HARMONICS] for q in "ab"]
        mean, omega = group.number("a0", 0.0), group.number("omega")
        frames.append(rotation(axis, mean, 0.0, swing, omega))
    else:
        raise group.error(
            f"AngleType {turns!r} is not computed, only TimeIndependent, KnownFunction and Periodic"
        )
    return tuple(frames)


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


def observer_points(group: Group) -> NDArray[np.float64]:
    """Observers in their own frame: one, a box or a part of a sphere.

    Parameters
    ----------
    group : Group
        An ``&ObserverIn`` group.

    Returns
    -------
    (n, 3) array
        Positions, the first index (x, or theta of a sphere) fastest [m].

    Raises
    ------
    WopwopFileError
        If the group describes the observers in another way.
    """

    def line(name: str, count: str) -> NDArray[np.float64]:
        n = group.count(count, 1)
        return np.linspace(group.number(f"{name}min"), group.number(f"{name}max"), max(n, 1))

    if "filename" in group.values:
        raise group.error(
            "observers of a file (fileName) are not read: give xLoc ..., nbx ... or radius ..."
        )
    if "radius" in group.values:
        theta, psi = line("theta", "nbtheta"), line("psi", "nbpsi")
        psi, theta = (a.ravel() for a in np.meshgrid(psi, theta, indexing="ij"))
        x, y, z = np.cos(psi) * np.cos(theta), np.cos(psi) * np.sin(theta), np.sin(psi)
        return group.number("radius") * np.stack([x, y, z], axis=-1)
    if "xloc" in group.values:
        return np.array([[group.number(f"{q}loc", 0.0) for q in "xyz"]])
    if "nbx" in group.values:
        x, y, z = (line(q, f"nb{q}") for q in "xyz")
        z, y, x = (a.ravel() for a in np.meshgrid(z, y, x, indexing="ij"))
        return np.stack([x, y, z], axis=-1)
    raise group.error("observers must be given as xLoc ..., nbx ... or radius ...")

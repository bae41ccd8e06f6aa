"""Microphones that fly along with the rotor: their positions from its centre.

Directions have the names of the rotor's tests: elevation from the rotor plane, negative below it
(the wake side), and azimuth about the rotor axis from the +x axis. Microphones on the ground are in
`propmdao.acoustics.kinematics.tracks`.
"""

from __future__ import annotations

import math
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.records.listening import DISTANCE, require_number_of_observers
from propmdao.records.units import Range

Positions = NDArray[np.float64]
# Ten turns: a larger angle is no direction that anybody means.
_AZIMUTH = Range(-3600.0, 3600.0, "deg")
_STEP = Range(1.0, 90.0, "deg")


class Directions(NamedTuple):
    """Directions of observers from the rotor centre, arrays of the shape of the positions.

    Attributes
    ----------
    radius : (...,) array
        Distance from the rotor centre [m].
    elevation_deg : (...,) array
        Angle from the rotor plane [deg], -90 (below, the wake side) to +90 (ahead).
    azimuth_deg : (...,) array
        Angle about the rotor axis from +x [deg], above -180 to 180, in the sense of the rotation.
    """

    radius: NDArray[np.float64]
    elevation_deg: NDArray[np.float64]
    azimuth_deg: NDArray[np.float64]

    def rounded(self) -> Directions:
        """Directions rounded to 1e-9 m and deg, so that rounding errors of zero vanish.

        Returns
        -------
        Directions
            Rounded directions for columns, tables and JSON.
        """
        # Adding zero makes a zero that has a sign one that has none.
        return Directions(*(np.round(values, 9) + 0.0 for values in self))


def point(radius: ArrayLike, elevation_deg: ArrayLike, azimuth_deg: ArrayLike = 0.0) -> Positions:
    """Place observers by direction and distance.

    Parameters
    ----------
    radius : float or (n_observers,)
        Distance from the rotor centre [m].
    elevation_deg : float or (n_observers,)
        Angle from the rotor plane [deg], from -90 (below, the wake side) to +90 (ahead).
    azimuth_deg : float or (n_observers,)
        Angle about the rotor axis from +x [deg].

    Returns
    -------
    (n_observers, 3) array
        ``radius (cos el cos az, cos el sin az, sin el)`` [m].

    Raises
    ------
    ValueError
        If a radius is not positive or beyond 1000 km, an elevation is outside -90 ... 90 deg or an
        azimuth is more than ten turns.
    """
    r, elevation, azimuth = np.broadcast_arrays(
        *(np.atleast_1d(np.asarray(q, float)) for q in (radius, elevation_deg, azimuth_deg))
    )
    near, far = DISTANCE.lowest, DISTANCE.highest
    _require(f"radius must be {DISTANCE}", r, (near <= r) & (r <= far))
    _require("elevation must be within -90 ... 90 deg", elevation, np.abs(elevation) <= 90)
    turn = _AZIMUTH.highest
    _require(f"azimuth must be {_AZIMUTH}", azimuth, np.abs(azimuth) <= turn)
    el, az = np.radians(elevation), np.radians(azimuth)
    return np.stack(
        [r * np.cos(el) * np.cos(az), r * np.cos(el) * np.sin(az), r * np.sin(el)], axis=-1
    )


def _require(rule: str, values: Positions, holds: NDArray[np.bool_]) -> None:
    """Refuse observers of which a value does not keep the rule; the message has the first."""
    wrong = values[~holds]
    if wrong.size:
        raise ValueError(f"observer {rule}; got {wrong[0]:g}")


def arc(radius: ArrayLike, elevation_deg: ArrayLike) -> Positions:
    """Place observers on a vertical arc around the rotor centre.

    Parameters
    ----------
    radius : float or (n_observers,)
        Distance from the rotor centre [m].
    elevation_deg : float or (n_observers,)
        Angle from the rotor plane [deg], from -90 (below, the wake side) to +90 (ahead).

    Returns
    -------
    (n_observers, 3) array
        ``radius (cos el, 0, sin el)`` [m].

    Raises
    ------
    ValueError
        If a radius is not positive or an elevation is outside -90 ... 90 deg.
    """
    return point(radius, elevation_deg)


def circle(radius: float, n: int, elevation_deg: float = 0.0) -> Positions:
    """Place observers evenly around the rotor axis, from azimuth 0 in the sense of the rotation.

    Parameters
    ----------
    radius : float
        Distance from the rotor centre [m].
    n : int
        Number of observers.
    elevation_deg : float
        Angle from the rotor plane [deg]: 0 in the plane, negative on a cone below it.

    Returns
    -------
    (n, 3) array
        Positions [m].

    Raises
    ------
    ValueError
        If there is no observer, the radius is not positive or the elevation is outside
        -90 ... 90 deg.
    """
    if n < 1:
        raise ValueError(f"a circle needs at least 1 observer; got {n}")
    require_number_of_observers(n)
    return point(radius, elevation_deg, 360 / n * np.arange(n))


def sphere(radius: float, elevation_deg: ArrayLike, azimuth_deg: ArrayLike) -> Positions:
    """Place observers on a sphere: every elevation with every azimuth, as a map wants them.

    Parameters
    ----------
    radius : float
        Distance from the rotor centre [m].
    elevation_deg : (n_elevations,) array_like
        Angles from the rotor plane [deg]; -90 ... 0 is the hemisphere below the rotor.
    azimuth_deg : (n_azimuths,) array_like
        Angles about the rotor axis from +x [deg].

    Returns
    -------
    (n_elevations * n_azimuths, 3) array
        Positions [m], azimuths running fastest, so that levels at these observers take
        ``reshape(n_elevations, n_azimuths)``.

    Raises
    ------
    ValueError
        If the radius is not positive, an elevation is outside -90 ... 90 deg or an azimuth is not
        finite.
    """
    require_number_of_observers(np.size(elevation_deg) * np.size(azimuth_deg))
    elevation, azimuth = np.meshgrid(elevation_deg, azimuth_deg, indexing="ij")
    return point(radius, elevation.ravel(), azimuth.ravel())


def hemisphere(radius: float, step_deg: float = 10.0) -> Positions:
    """Place observers on the hemisphere below the rotor, where people are.

    Parameters
    ----------
    radius : float
        Distance from the rotor centre [m].
    step_deg : float
        Step between neighbours in elevation (-90 ... 0) and azimuth [deg], a divisor of 90.

    Returns
    -------
    (1 + (90 / step) * (360 / step), 3) array
        Positions [m]: one straight below, then those of `sphere` at each elevation from the lowest
        to 0, every one in its own place; `on_map` lays out their levels.

    Raises
    ------
    ValueError
        If the step does not divide 90 deg or makes more than `MOST_OBSERVERS`, or the radius is
        not positive.
    """
    _STEP.require("step of a hemisphere", step_deg)
    n = round(90 / step_deg)
    if abs(n * step_deg - 90) > 1e-9:
        raise ValueError(f"step of a hemisphere must divide 90 deg; got {step_deg:g}")
    elevation, azimuth = np.linspace(-90, 0, n + 1)[1:], np.linspace(0, 360, 4 * n + 1)[:-1]
    return np.concatenate([point(radius, -90), sphere(radius, elevation, azimuth)])


class HemisphereMap(NamedTuple):
    """Values at the observers of `hemisphere` as a table over elevation and closed azimuth.

    Attributes
    ----------
    elevation_deg : (n + 1,) array
        Elevations from -90 to 0 [deg].
    azimuth_deg : (4 n + 1,) array
        Azimuths from 0 to 360 [deg].
    values : (n + 1, 4 n + 1) array
        Values; the first row repeats the one straight below, the last column the first.
    """

    elevation_deg: NDArray[np.float64]
    azimuth_deg: NDArray[np.float64]
    values: NDArray[np.float64]


def on_map(values: ArrayLike) -> HemisphereMap:
    """Lay out values at the observers of a hemisphere as a map wants them.

    Parameters
    ----------
    values : (n_observers,) array_like
        Values in the order of `hemisphere`.

    Returns
    -------
    HemisphereMap
        Values over elevation and azimuth.

    Raises
    ------
    ValueError
        If no hemisphere has this number of observers.
    """
    below, *rest = np.asarray(values, float)
    n = round(np.sqrt(len(rest) / 4))
    if n < 1 or 4 * n * n != len(rest):
        raise ValueError(f"a hemisphere has 1 + 4 n^2 observers; got {len(rest) + 1}")
    around = np.reshape(rest, (n, 4 * n))
    closed = np.concatenate([around, around[:, :1]], axis=1)
    table = np.concatenate([np.full((1, 4 * n + 1), below), closed])
    return HemisphereMap(np.linspace(-90, 0, n + 1), np.linspace(0, 360, 4 * n + 1), table)


def grid(x: ArrayLike, y: ArrayLike, z: ArrayLike) -> Positions:
    """Place observers at every combination of coordinates.

    Parameters
    ----------
    x, y, z : float or (n,) array_like
        Coordinates [m]; on a plane one of the three is a single value.

    Returns
    -------
    (n_x * n_y * n_z, 3) array
        Positions [m], z running fastest.

    Raises
    ------
    ValueError
        If there would be more than `MOST_OBSERVERS`.
    """
    require_number_of_observers(math.prod(np.size(values) for values in (x, y, z)))
    return np.stack(np.meshgrid(x, y, z, indexing="ij"), axis=-1).reshape(-1, 3).astype(float)


def directions(positions: ArrayLike) -> Directions:
    """Distance and direction of observers from the rotor centre, for tables and figures.

    Parameters
    ----------
    positions : (..., 3) array_like
        Positions from the rotor centre [m].

    Returns
    -------
    Directions
        Radius, elevation and azimuth.
    """
    x, y, z = np.moveaxis(np.asarray(positions, float), -1, 0)
    across = np.hypot(x, y)
    return Directions(
        np.hypot(across, z), np.degrees(np.arctan2(z, across)), np.degrees(np.arctan2(y, x))
    )


def labels(positions: ArrayLike) -> list[str]:
    """Names of observers by elevation, and by azimuth and distance where those are not all equal.

    Parameters
    ----------
    positions : (n_observers, 3) array_like
        Positions from the rotor centre [m].

    Returns
    -------
    list of str
        Name of each observer, such as ``"-45°"``, or ``"-45°, azimuth 90°, 3 m"``.
    """
    seen = directions(np.reshape(positions, (-1, 3)))
    names = [f"{elevation:.4g}°" for elevation in seen.elevation_deg]
    # At a pole of the sphere there is no azimuth.
    turned = np.where(np.abs(seen.elevation_deg) > 90 - 1e-9, 0.0, seen.azimuth_deg)
    if np.any(np.abs(turned) > 1e-9):
        names = [f"{name}, azimuth {a:.4g}°" for name, a in zip(names, turned, strict=True)]
    if np.ptp(seen.radius) > 1e-9 * seen.radius.max():
        names = [f"{name}, {r:.4g} m" for name, r in zip(names, seen.radius, strict=True)]
    return names

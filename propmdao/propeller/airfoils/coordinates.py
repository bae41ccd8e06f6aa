"""Airfoil coordinates: contour to camber and thickness."""

from __future__ import annotations

import numpy as np
from scipy.interpolate import CubicSpline, PchipInterpolator

from propmdao.propeller.airfoils.airfoil import (
    CHORD_ANGLE,
    CHORD_FRACTION,
    Airfoil,
    AirfoilError,
    FloatArray,
)
from propmdao.propeller.airfoils.contours import CLOSE, closed, onto_chord_line, selig_order

#: Points as near as this to the leading edge are the nose: their chord angle is 0 [chord].
_NOSE = 1e-12
#: Sides may cross by this much: published points are rounded to as little [chord].
_ROUNDING = 1e-3
#: A spline that leaves the monotone one by more than this swings between points that lie close and
#: points that do not; through 2,174 public sections it does so 4 times [chord].
_SWING = 0.01
#: Least thickness over distance from the trailing edge where sides touch: it is never negative.
_LEAST_WEDGE = 0.002


def airfoil_from_coordinates(name: str, x: FloatArray, z: FloatArray, source: str = "") -> Airfoil:
    """Split a contour into camber and thickness at equal chord fraction.

    Parameters
    ----------
    name : str
        Name of the section.
    x, z : (n,) arrays
        Contour, over chord or in per cent, best from the trailing edge over the upper side to the
        leading edge at the origin and back along the lower side (Selig's order); other orders are
        understood.
    source : str
        Origin of the coordinates.

    Returns
    -------
    Airfoil
        The section in the axes given: the chord stays the x axis, so angles of attack mean what
        they mean in the section's published polars. If nose and trailing edge are not on it, the
        section is turned and scaled onto its chord line, and a warning says so.

    Raises
    ------
    AirfoilError
        If there are fewer than 10 points, one is not finite, they are no contour of a section, a
        side folds back or the sides cross.

    Notes
    -----
    z is a smooth single-valued function of the signed chord angle, x = (1 - cos(angle)) / 2, also
    round the nose, so one cubic spline takes it to the shared grid. Behind the last points ahead of
    where the spline's sides would cross, which those of thin trailing edges do between points that
    do not, a monotone cubic takes its place (Fritsch, Carlson, SIAM J. Numer. Anal. 17, 1980). The
    nose is put at the origin; published tables have no point there or pass it by some 1e-4 of the
    chord.
    """
    points = onto_chord_line(name, closed(name, selig_order(name, x, z)))
    x, z = points.T
    nose = int(np.argmin(x))
    split = nose if z[nose] < 0.0 else nose + 1
    upper = _side(name, x[:split][::-1], z[:split][::-1])
    lower = _side(name, x[split:], z[split:])
    z_upper, z_lower = _on_grid(name, upper, lower)
    thickness = np.maximum(z_upper - z_lower, 0.0)
    return Airfoil(name, 0.5 * (z_upper + z_lower), thickness, source)


def _side(name: str, x: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return chord angle and z of one side behind the nose, its last point put at x = 1."""
    x, z = x[x > _NOSE], z[x > _NOSE]
    if x.size < 2:
        raise AirfoilError(f"airfoil '{name}': a side has {x.size} points behind the nose")
    # Points behind the last that is furthest aft lie on the base of a blunt trailing edge.
    last = x.size - 1 - int(np.argmax(x[::-1]))
    if x[last] - x[last:].min() <= CLOSE:
        x, z = x[: last + 1], z[: last + 1]
    if x[-2] >= 1.0:
        x = x / x[-1]
    angle = np.arccos(np.clip(1.0 - 2.0 * x, -1.0, 1.0))
    angle[-1] = np.pi
    if np.any(np.diff(angle) <= 0.0):
        fold = x[:-1][np.diff(angle) <= 0.0][0]
        raise AirfoilError(f"airfoil '{name}': a side folds back at x/c {fold:.3f}")
    return angle, z


def _on_grid(
    name: str, upper: tuple[FloatArray, FloatArray], lower: tuple[FloatArray, FloatArray]
) -> tuple[FloatArray, FloatArray]:
    """Interpolate both sides, chord angle and z of each, to z on the shared grid."""
    contour = (
        np.concatenate([-lower[0][::-1], [0.0], upper[0]]),
        np.concatenate([lower[1][::-1], [0.0], upper[1]]),
    )
    angles = np.stack([CHORD_ANGLE, -CHORD_ANGLE])
    smooth, monotone = CubicSpline(*contour)(angles), PchipInterpolator(*contour)(angles)
    if np.abs(smooth - monotone).max() > _SWING:
        smooth = monotone
    crossed = np.flatnonzero((smooth[0] - smooth[1])[1:-1] <= 0.0) + 1
    if crossed.size == 0:
        return smooth[0], smooth[1]
    knots = np.unique(np.concatenate([upper[0], lower[0]]))
    apart = np.interp(knots, *upper) - np.interp(knots, *lower)
    if apart.min() < -_ROUNDING:
        worst = 0.5 * (1.0 - np.cos(knots[apart.argmin()]))
        raise AirfoilError(
            f"airfoil '{name}': the sides cross; at x/c {worst:.3f} the upper one is "
            f"{-apart.min():.4g} of the chord below the lower one"
        )
    start = CHORD_ANGLE[crossed[0]]
    ahead = [knot[max(int(np.sum(knot < start)) - 1, 0)] for knot, _ in (upper, lower)]
    z_upper, z_lower = np.where(CHORD_ANGLE >= np.array(ahead)[:, None], monotone, smooth)
    # Sides that touch within rounding keep a wedge: a surface needs two of them.
    middle, half = 0.5 * (z_upper + z_lower), 0.5 * (z_upper - z_lower)
    half = np.maximum(half, 0.5 * _LEAST_WEDGE * (1.0 - CHORD_FRACTION))
    half[0] = 0.0
    return middle + half, middle - half

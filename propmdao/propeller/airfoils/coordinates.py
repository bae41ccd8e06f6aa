"""Airfoil coordinates: contour to camber and thickness, and the files that hold contours."""

from __future__ import annotations

from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from propmdao.propeller.airfoils.airfoil import (
    CHORD_ANGLE,
    CHORD_FRACTION,
    Airfoil,
    AirfoilError,
    FloatArray,
)
from propmdao.runtime.input_files import read_text, table_rows


def airfoil_from_coordinates(name: str, x: FloatArray, z: FloatArray, source: str = "") -> Airfoil:
    """Split a contour into camber and thickness at equal chord fraction.

    Parameters
    ----------
    name : str
        Name of the section.
    x, z : (n,) arrays
        Contour of unit chord from the trailing edge over the upper side to the leading edge at
        the origin and back along the lower side (Selig's order).
    source : str
        Origin of the coordinates.

    Returns
    -------
    Airfoil
        The section in the axes given: the chord stays the x axis, so angles of attack mean what
        they mean in the section's published polars.

    Raises
    ------
    AirfoilError
        If there are fewer than 10 points, one is not finite, the chord does not run from the
        origin to x = 1, a side folds back or the sides cross.

    Notes
    -----
    z is a smooth single-valued function of the signed chord angle, x = (1 - cos(angle)) / 2, also
    round the nose, so one cubic spline takes it to the shared grid. The nose is put at the origin;
    published tables have no point there or pass it by some 1e-4 of the chord.
    """
    x, z = np.asarray(x, dtype=float), np.asarray(z, dtype=float)
    if x.size < 10 or not (np.isfinite(x).all() and np.isfinite(z).all()):
        raise AirfoilError(f"airfoil '{name}' needs at least 10 finite points")
    nose, tail = int(np.argmin(x)), 0.5 * (x[0] + x[-1])
    if np.hypot(x[nose], z[nose]) > 0.01 or abs(tail - 1.0) > 0.01:
        raise AirfoilError(
            f"airfoil '{name}' must have unit chord, leading edge at the origin; its chord runs "
            f"from ({x[nose]:g}, {z[nose]:g}) to x = {tail:g}"
        )
    split = nose if z[nose] < 0.0 else nose + 1
    upper = _side(name, x[:split][::-1] / tail, z[:split][::-1] / tail)
    lower = _side(name, x[split:] / tail, z[split:] / tail)
    contour = CubicSpline(
        np.concatenate([-lower[0][::-1], [0.0], upper[0]]),
        np.concatenate([lower[1][::-1], [0.0], upper[1]]),
    )
    z_upper, z_lower = contour(CHORD_ANGLE), contour(-CHORD_ANGLE)
    thickness = z_upper - z_lower
    if np.any(thickness[1:-1] <= 0.0):
        worst = CHORD_FRACTION[1:-1][np.argmin(thickness[1:-1])]
        raise AirfoilError(
            f"airfoil '{name}': thickness must be positive; it is not at x/c {worst:.3f} "
            "(points must run trailing edge, upper side, leading edge, lower side)"
        )
    return Airfoil(name, 0.5 * (z_upper + z_lower), np.maximum(thickness, 0.0), source)


def read_coordinates(path: Path) -> Airfoil:
    """Read a coordinate file in Selig's or Lednicer's order.

    Parameters
    ----------
    path : Path
        Text file: a title line, which may be missing, then x and z over chord. Selig: trailing
        edge, upper side, leading edge, lower side. Lednicer: the number of points of each side,
        then each side from the leading edge.

    Returns
    -------
    Airfoil
        The section, named after the file.

    Raises
    ------
    AirfoilError
        If the file cannot be read or holds no airfoil.
    """
    label = f"airfoil file '{path}'"
    # Titles may be in any encoding, the numbers are ASCII.
    text = read_text(path, AirfoilError, complaint=f"{label} cannot be read", undecodable="replace")
    rows = table_rows(text, 2, "two numbers x z", AirfoilError, label)
    points = np.array(rows).reshape(-1, 2)
    if points.size and points[0, 0] > 1.5:
        n_upper = int(points[0, 0])
        upper, lower = points[1 : n_upper + 1], points[n_upper + 1 :]
        points = np.concatenate([upper[::-1], lower[1:]])
    return airfoil_from_coordinates(path.stem, points[:, 0], points[:, 1], str(path))


def _side(name: str, x: FloatArray, z: FloatArray) -> tuple[FloatArray, FloatArray]:
    """Return chord angle and z of one side behind the nose, its last point put at x = 1."""
    x, z = x[x > 0.0], z[x > 0.0]
    if np.any(np.diff(x) <= 0.0):
        fold = x[:-1][np.diff(x) <= 0.0][0]
        raise AirfoilError(f"airfoil '{name}': a side folds back at x/c {fold:.3f}")
    angle = np.arccos(np.clip(1.0 - 2.0 * x, -1.0, 1.0))
    angle[-1] = np.pi
    return angle, z

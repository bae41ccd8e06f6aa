"""Contours as files have them, put in one order and onto the chord line."""

from __future__ import annotations

import warnings

import numpy as np

from propmdao.propeller.airfoils.airfoil import AirfoilError, FloatArray

#: Nose off the origin, or chord off 1, up to which a contour stays in its own axes [chord].
CLOSE = 0.01
_FEWEST = 10
#: Larger coordinates are in no unit of a chord, and their squares would overflow.
LARGEST = 1e6
#: Ends of the sides that are rounded alike are both at the trailing edge [chord].
_ROUNDED = 1e-4
#: So are the corners of a blunt one, which is higher than it is oblique, up to the first gap: each
#: moves by half of it. Any other gap is closed, in silence up to the second, and up to the third
#: where points are dense [chord].
_OBLIQUE, _SILENT, _WIDEST_GAP = 0.01, 0.02, 0.05
#: A gap of at most so many steps of the other side is one point that was left out.
_STEPS = 1.5
#: Largest angle by which a contour is turned onto its chord line [deg].
_LARGEST_TURN_DEG = 15.0


class AirfoilFrameWarning(UserWarning):
    """A contour was closed at its trailing edge, or turned or scaled onto its chord line."""


def selig_order(name: str, x: FloatArray, z: FloatArray) -> FloatArray:
    """Put the points of a contour in Selig's order, whatever order they have.

    Parameters
    ----------
    name : str
        Name of the section.
    x, z : (n,) arrays
        Contour in one round, either way, from any point; or one side and then the other, each from
        its nose or from its trailing edge.

    Returns
    -------
    (m, 2) array
        The points x, z from the trailing edge over the higher side to the nose and back along the
        lower side; repeated points once.

    Raises
    ------
    AirfoilError
        If there are fewer than 10 points, one is not finite or out of all proportion, or they are
        no such contour.
    """
    points = _checked(name, x, z)
    chord = float(np.ptp(points[:, 0]))
    jumps = np.flatnonzero(np.abs(np.diff(points[:, 0])) > 0.5 * chord)
    if jumps.size > 1:
        raise AirfoilError(
            f"airfoil '{name}': points must run round the section, or along one side and then the "
            f"other; they jump along the chord {jumps.size} times"
        )
    if jumps.size == 1:
        sides = np.split(points, jumps + 1)
        first, second = (side if side[0, 0] < side[-1, 0] else side[::-1] for side in sides)
        points = _without_repeats(np.concatenate([first[::-1], second]))
    elif points[:, 0].max() - max(points[0, 0], points[-1, 0]) > 0.1 * chord:
        points = _from_trailing_edge(name, points, chord)
    # Twice the area within, positive where the points run counter-clockwise: upper side first.
    following = np.roll(points, -1, axis=0)
    area = float(np.sum(points[:, 0] * following[:, 1] - following[:, 0] * points[:, 1]))
    return points if area >= 0.0 else points[::-1]


def closed(name: str, points: FloatArray) -> FloatArray:
    """Close a contour one side of which ends before the trailing edge.

    Parameters
    ----------
    name : str
        Name of the section.
    points : (n, 2) array
        Contour in Selig's order.

    Returns
    -------
    (n, 2) or (n + 1, 2) array
        The contour; a side that ends ahead of the other is led to its end.

    Raises
    ------
    AirfoilError
        If a side lacks more than the points about the trailing edge.

    Warns
    -----
    AirfoilFrameWarning
        If the gap is more than an oblique trailing edge.
    """
    chord = float(np.ptp(points[:, 0]))
    upper_end, lower_end = points[0], points[-1]
    gap, base = np.abs(upper_end - lower_end) / chord
    if gap <= max(_ROUNDED, min(_OBLIQUE, base)):
        return points
    lower_short = lower_end[0] < upper_end[0]
    side, short, tail = (
        ("lower", lower_end, upper_end) if lower_short else ("upper", upper_end, lower_end)
    )
    beside = abs(points[1, 0] - points[0, 0] if lower_short else points[-2, 0] - points[-1, 0])
    said = (
        f"airfoil '{name}': its {side} side ends at x = {short[0]:.6g}, ahead of the trailing edge "
        f"at x = {tail[0]:.6g}"
    )
    if gap > max(_WIDEST_GAP, _STEPS * beside / chord):
        raise AirfoilError(f"{said}; the points between are missing")
    if gap > _SILENT:
        warnings.warn(f"{said}; a straight line closes it", AirfoilFrameWarning, stacklevel=2)
    ends = [points, tail[None]] if lower_short else [tail[None], points]
    return np.concatenate(ends)


def onto_chord_line(name: str, points: FloatArray) -> FloatArray:
    """Bring a contour to unit chord.

    Parameters
    ----------
    name : str
        Name of the section.
    points : (n, 2) array
        Contour in Selig's order, its ends at the trailing edge.

    Returns
    -------
    (n, 2) array
        The contour in its own axes where its nose is within `CLOSE` of the origin and its chord as
        near to 1, or to 100 (per cent), so that angles of attack mean what they mean in the
        section's published polars. Any other is moved, turned and scaled so that the point furthest
        from the middle of its trailing edge is the origin and that middle (1, 0).

    Raises
    ------
    AirfoilError
        If the chord line is inclined by more than 15 degrees.

    Warns
    -----
    AirfoilFrameWarning
        If the contour is turned or scaled; the message says by how much.
    """
    tail = 0.5 * (points[0] + points[-1])
    nose = points[np.argmin(points[:, 0])]
    for unit in (1.0, 100.0):
        if np.hypot(*nose) <= CLOSE * unit and abs(tail[0] - unit) <= CLOSE * unit:
            own_axes: FloatArray = points / tail[0]
            return own_axes
    nose = points[np.argmax(np.hypot(*(points - tail).T))]
    along = tail - nose
    chord, angle = float(np.hypot(*along)), float(np.degrees(np.arctan2(along[1], along[0])))
    if abs(angle) > _LARGEST_TURN_DEG:
        raise AirfoilError(
            f"airfoil '{name}': the chord line must be within {_LARGEST_TURN_DEG:g} deg of the x "
            f"axis; from ({nose[0]:.6g}, {nose[1]:.6g}) to ({tail[0]:.6g}, {tail[1]:.6g}) it is "
            f"inclined by {angle:.4g} deg"
        )
    warnings.warn(
        f"airfoil '{name}': its nose is at ({nose[0]:.6g}, {nose[1]:.6g}) and its trailing edge at "
        f"({tail[0]:.6g}, {tail[1]:.6g}); it was turned by {-angle:.3g} deg and scaled by "
        f"{1.0 / chord:.6g} onto its chord line, from which angles of attack count",
        AirfoilFrameWarning,
        stacklevel=2,
    )
    forward = along / chord
    turn = np.array([[forward[0], -forward[1]], [forward[1], forward[0]]])
    turned: FloatArray = (points - nose) @ turn / chord
    return turned


def _checked(name: str, x: FloatArray, z: FloatArray) -> FloatArray:
    """Points of a contour that can be one, (n, 2), repeated ones once."""
    points = np.stack([np.asarray(x, dtype=float), np.asarray(z, dtype=float)], axis=1)
    if len(points) < _FEWEST or not np.isfinite(points).all():
        raise AirfoilError(f"airfoil '{name}' needs at least {_FEWEST} finite points")
    if np.abs(points).max() > LARGEST:
        raise AirfoilError(
            f"airfoil '{name}': coordinates must be within {-LARGEST:g}..{LARGEST:g}; there is "
            f"{points.flat[np.abs(points).argmax()]:g}"
        )
    points = _without_repeats(points)
    chord, height = np.ptp(points, axis=0)
    if len(points) < _FEWEST or not chord > height:
        raise AirfoilError(
            f"airfoil '{name}' needs at least {_FEWEST} different points along a chord in x; it "
            f"has {len(points)}, {chord:g} long and {height:g} high"
        )
    return points


def _without_repeats(points: FloatArray) -> FloatArray:
    """Points without those that repeat the one before them."""
    return points[np.append(True, (np.diff(points, axis=0) != 0.0).any(axis=1))]


def _from_trailing_edge(name: str, points: FloatArray, chord: float) -> FloatArray:
    """Points of a closed round that begins elsewhere, begun and ended at the trailing edge."""
    first, last = points[0], points[-1]
    if np.hypot(*(first - last)) > 0.1 * chord:
        raise AirfoilError(
            f"airfoil '{name}': points must run round the section; they begin at x = "
            f"{first[0]:.6g} and end at x = {last[0]:.6g}, with the trailing edge at x = "
            f"{points[:, 0].max():.6g}"
        )
    points = points[:-1] if (first == last).all() else points
    tail = np.flatnonzero(points[:, 0] >= points[:, 0].max() - 1e-6 * chord)
    points = np.roll(points, -tail[-1], axis=0)
    if tail.size == 1:
        return np.concatenate([points, points[:1]])
    # Both corners of a blunt trailing edge; what lies on its base between them is no side.
    return points[: len(points) - (tail[-1] - tail[0] - 1)]

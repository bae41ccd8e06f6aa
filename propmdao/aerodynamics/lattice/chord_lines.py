"""Flow that is smooth along the chord, read at a few points of each strip.

What vortices far from a blade induce there changes little along its chord: on a chord 2 h long, at
the distance d from a vortex, the polynomial through n Chebyshev points misses it by about q^-n,
q = d / h + sqrt(1 + (d / h)^2) (Trefethen, Approximation Theory and Approximation Practice, 2013,
theorem 8.2). So a few points of a strip stand for all of its collocation points and segments.
Between the middles of the strips, for the chordwise segments, a cubic goes through the nearest
four, and a straight line beyond the outer ones; strips are cosine spaced, so that both are in the
angle of that cosine.

Vortices still farther away need fewer points: every second of a strip, and those of every second
strip. In the same way every second filament stands for all of a sheet that is so far away.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import panel_fractions, strip_points
from propmdao.records.pytrees import record

#: Points of a strip.
LINE_POINTS = 5


@record
class ChordLines:
    """Points of the strips of a lattice from which all others are read.

    Attributes
    ----------
    points, normals : (n * ns, 3) arrays
        Chebyshev points of each strip [m], and unit normals of the camber surface there.
    """

    points: Array
    normals: Array


def chord_lines(nodes: Array) -> ChordLines:
    """Choose the points of the strips.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Panel corners, from leading edge and root [m].

    Returns
    -------
    ChordLines
        The points.
    """
    points, normals = strip_points(nodes, _fractions(nodes.shape[0] - 1))
    return ChordLines(points.reshape(-1, 3), normals.reshape(-1, 3))


def at_collocation(values: Array, n_chordwise: int) -> Array:
    """Read values at the collocation points.

    Parameters
    ----------
    values : (..., n * ns) array
        Values at the points of `ChordLines`.
    n_chordwise : int
        Chordwise panels, nc.

    Returns
    -------
    (..., nc * ns) array
        Values at the collocation points.
    """
    lines = values.reshape(*values.shape[:-1], LINE_POINTS, -1)
    reading = _reading(n_chordwise, panel_fractions(n_chordwise)[1])
    return jnp.einsum("im,...ms->...is", reading, lines).reshape(*values.shape[:-1], -1)


def at_segments(values: Array, n_chordwise: int) -> Array:
    """Read values at the middles of all segments.

    Parameters
    ----------
    values : (..., n * ns) array
        Values at the points of `ChordLines`.
    n_chordwise : int
        Chordwise panels, nc.

    Returns
    -------
    (..., nc * ns + nc * (ns + 1)) array
        Values at the segments, in the order of `ring_segments`.
    """
    lines = values.reshape(*values.shape[:-1], LINE_POINTS, -1)
    quarter, three_quarter = panel_fractions(n_chordwise)
    # The last corners lie behind the blade as far as the last three-quarter point lies ahead.
    corner = np.append(quarter, 2.0 - three_quarter[-1])
    middle = 0.5 * (corner[1:] + corner[:-1])
    bound = jnp.einsum("im,...ms->...is", _reading(n_chordwise, quarter), lines)
    chordwise = jnp.einsum(
        "im,...ms,fs->...if",
        _reading(n_chordwise, middle),
        lines,
        jnp.asarray(_to_edges(lines.shape[-1])),
    )
    ends = *values.shape[:-1], -1
    return jnp.concatenate([bound.reshape(ends), chordwise.reshape(ends)], axis=-1)


def coarse_points(lines: ChordLines, n_spanwise: int) -> Array:
    """Every second of the points of every second strip.

    Parameters
    ----------
    lines : ChordLines
        Points of all strips.
    n_spanwise : int
        Number of strips, ns.

    Returns
    -------
    (n, 3) array
        The points [m].
    """
    points = lines.points.reshape(LINE_POINTS, n_spanwise, 3)
    return points[::2, every_second(n_spanwise)].reshape(-1, 3)


def from_coarse(values: Array, n_spanwise: int) -> Array:
    """Read values at the points of all strips.

    Parameters
    ----------
    values : (..., n) array
        Values at the points of `coarse_points`.
    n_spanwise : int
        Number of strips, ns.

    Returns
    -------
    (..., n * ns) array
        Values at the points of `ChordLines`.
    """
    number, kept = np.arange(n_spanwise), every_second(n_spanwise)
    place = _chebyshev()
    coarse = values.reshape(*values.shape[:-1], -1, kept.size)
    along, across = _polynomial(place[::2], place), through_nearest(kept, number)
    fine = jnp.einsum("im,...ms,ts->...it", jnp.asarray(along), coarse, jnp.asarray(across))
    return fine.reshape(*values.shape[:-1], -1)


def every_second(n: int) -> np.ndarray:
    """Every second of the numbers from 0 to n - 1, both ends included."""
    return np.union1d(np.arange(0, n, 2), [n - 1])


def _fractions(n_chordwise: int) -> np.ndarray:
    """Chebyshev points between the first quarter point and the last collocation point."""
    quarter, three_quarter = panel_fractions(n_chordwise)
    first, last = quarter[0], three_quarter[-1]
    return 0.5 * (first + last) - 0.5 * (last - first) * _chebyshev()


def _chebyshev() -> np.ndarray:
    """Chebyshev points from 1 down to -1, ends left out, as many as a strip has."""
    cosine: np.ndarray = np.cos(np.pi * (np.arange(LINE_POINTS) + 0.5) / LINE_POINTS)
    return cosine


def _reading(n_chordwise: int, fractions: np.ndarray) -> Array:
    """Matrix from the points of a strip to chord fractions, (n_fractions, n)."""
    return jnp.asarray(_polynomial(_fractions(n_chordwise), fractions))


def _to_edges(n_spanwise: int) -> np.ndarray:
    """Matrix from the middles of the strips to their edges, (ns + 1, ns)."""
    middle, edge = np.arange(n_spanwise) + 0.5, np.arange(n_spanwise + 1)
    matrix = through_nearest(middle, edge)
    # Beyond the last strips a straight line: a cubic there would enlarge what is rough.
    matrix[[0, -1]] = through_nearest(middle, edge[[0, -1]], 2)
    return matrix


def through_nearest(places: np.ndarray, wanted: np.ndarray, n_nearest: int = 4) -> np.ndarray:
    """Matrix from values at places, rising, to those of polynomials through the nearest of them.

    Parameters
    ----------
    places : (n_places,) array
        Where values are given.
    wanted : (n_wanted,) array
        Where they are wanted.
    n_nearest : int
        Places that a polynomial goes through: four for a cubic.

    Returns
    -------
    (n_wanted, n_places) array
        The matrix.
    """
    n = min(n_nearest, places.size)
    matrix = np.zeros((wanted.size, places.size))
    first = np.clip(np.searchsorted(places, wanted) - n // 2, 0, places.size - n)
    for i, near in enumerate(first[:, None] + np.arange(n)):
        matrix[i, near] = _polynomial(places[near], wanted[i : i + 1])[0]
    return matrix


def _polynomial(places: np.ndarray, wanted: np.ndarray) -> np.ndarray:
    """Matrix from values at places to those of the polynomial through them."""
    others = ~np.eye(places.size, dtype=bool)
    factors = (wanted[:, None, None] - places) / np.where(others, places[:, None] - places, 1.0)
    product: np.ndarray = np.where(others, factors, 1.0).prod(axis=-1)
    return product

"""Vortex rings on the camber surface of one blade, and what a unit of their circulation induces.

Ring (i, j) runs root to tip along the quarter line of panel (i, j), downstream on the tip side and
back on the root side (Katz and Plotkin 2001, section 12.3). Summed over the rings, every bound
segment carries the difference of two rows, every chordwise segment and trailing filament the
difference of two strips; in steady flow the last row trails into the wake unchanged.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from scipy.interpolate import CubicSpline

from propmdao.aerodynamics.vortices.biot_savart import segment_normalwash, segment_velocities
from propmdao.geometry.lattice import lattice_chord_fraction, strip_middle
from propmdao.records.pytrees import Scalar, record

# Bound vortices need no physical core; this one only keeps a segment's velocity on itself at zero.
BOUND_CORE = 1.0e-4  # of the tip radius


@record
class Rings:
    """Vortex lattice of blade 1.

    Attributes
    ----------
    corner : (nc + 1, ns + 1, 3) array
        Corners of the rings; the last row is where the wake begins [m].
    collocation : (nc * ns, 3) array
        Collocation points, three quarters down each panel [m].
    normal : (nc * ns, 3) array
        Unit normals at the collocation points, toward the suction side.
    """

    corner: Array
    collocation: Array
    normal: Array


def panel_fractions(n_chordwise: int) -> tuple[np.ndarray, np.ndarray]:
    """Chord fractions of the quarter and the three-quarter points of the panels, (nc,) each."""
    x = lattice_chord_fraction(n_chordwise)
    return x[:-1] + 0.25 * np.diff(x), x[:-1] + 0.75 * np.diff(x)


def _from_nodes(n_chordwise: int, fractions: np.ndarray) -> np.ndarray:
    """Matrix from nodes to points between them at chord fractions, (n, nc + 1)."""
    x = lattice_chord_fraction(n_chordwise)
    return np.array([np.interp(fractions, x, row) for row in np.eye(n_chordwise + 1)]).T


def strip_points(nodes: Array, fractions: np.ndarray) -> tuple[Array, Array]:
    """Points in the strips at chord fractions, and the normals of the camber surface there.

    A panel's own slope is that of the camber line at its middle, short by a quarter panel of
    curvature at the collocation point: 0.6 deg of twist at 4 % camber and 8 panels. The slope of
    the spline through the nodes leaves 0.06 deg (E63, Clark-Y, NACA 4412 at 8 cosine panels).

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Panel corners, from leading edge and root [m].
    fractions : (n,) array
        Chord fractions.

    Returns
    -------
    points, normals : (n, ns, 3) arrays
        Points [m], and unit normals toward the suction side.
    """
    nc, ns = nodes.shape[0] - 1, nodes.shape[1] - 1
    slope = CubicSpline(lattice_chord_fraction(nc), np.eye(nc + 1))(fractions, 1)
    f = jnp.asarray(strip_middle(ns))[None, :, None]
    line = _along(jnp.asarray(_from_nodes(nc, fractions)), nodes)
    points = (1.0 - f) * line[:, :-1] + f * line[:, 1:]
    tangent = _along(jnp.asarray(slope), nodes)
    chordwise = (1.0 - f) * tangent[:, :-1] + f * tangent[:, 1:]
    spanwise = line[:, 1:] - line[:, :-1]
    # Leading to trailing edge (-y) times root to tip (+x) points up, to the suction side.
    normals = jnp.cross(chordwise, spanwise)
    return points, normals / jnp.linalg.norm(normals, axis=-1, keepdims=True)


def vortex_rings(nodes: Array) -> Rings:
    """Place the rings on the panels.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Panel corners, from leading edge and root [m].

    Returns
    -------
    Rings
        Lattice of blade 1.
    """
    nc = nodes.shape[0] - 1
    quarter, three_quarter = panel_fractions(nc)
    behind = nodes[-1:] + 0.25 * (nodes[-1:] - nodes[-2:-1])
    corner = jnp.concatenate([_along(jnp.asarray(_from_nodes(nc, quarter)), nodes), behind])
    collocation, normal = strip_points(nodes, three_quarter)
    return Rings(corner, collocation.reshape(-1, 3), normal.reshape(-1, 3))


def _along(operator: Array, nodes: Array) -> Array:
    """Apply a chordwise operator to the nodes."""
    return jnp.tensordot(operator, nodes, axes=1)


def ring_segments(rings: Rings) -> tuple[Array, Array]:
    """Start and end of all segments, (n_segments, 3) each [m].

    First the bound ones (nc * ns), root to tip, then the chordwise ones (nc * (ns + 1)),
    downstream.
    """
    corner = rings.corner
    start = jnp.concatenate([corner[:-1, :-1].reshape(-1, 3), corner[:-1].reshape(-1, 3)])
    end = jnp.concatenate([corner[:-1, 1:].reshape(-1, 3), corner[1:].reshape(-1, 3)])
    return start, end


def segment_circulation(circulation: Array) -> Array:
    """Circulation of all segments of rings (nc, ns), in the order of `ring_segments`."""
    bound = circulation - jnp.pad(circulation, ((1, 0), (0, 0)))[:-1]
    padded = jnp.pad(circulation, ((0, 0), (1, 1)))
    return jnp.concatenate([bound.ravel(), (padded[:, :-1] - padded[:, 1:]).ravel()])


def spun(vectors: Array, angle: Array) -> Array:
    """Vectors (..., 3) turned about +z by angles (...) [rad]."""
    cos, sin = jnp.cos(angle), jnp.sin(angle)
    x, y, z = jnp.moveaxis(vectors, -1, 0)
    return jnp.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1)


def turned(points: Array, azimuths: np.ndarray) -> Array:
    """Copies of points (n, 3) of blade 1 on the blades at some azimuths: (n_blades, n, 3)."""
    cos, sin, none = np.cos(azimuths), np.sin(azimuths), np.zeros(azimuths.size)
    turns = np.array([[cos, -sin, none], [sin, cos, none], [none, none, none + 1.0]])
    return jnp.einsum("ijb,nj->bni", turns, points)


def blade_influence(points: Array, rings: Rings, azimuths: np.ndarray, core: Scalar) -> Array:
    """Velocity at the points per unit circulation of each ring of some blades, wake left out.

    Blades that carry the same circulation are summed in one call, which is the fast path of flow
    that is symmetric about the axis: all azimuths together. Where blades differ, each has a call.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    rings : Rings
        Lattice of blade 1.
    azimuths : (n_blades,) array
        Azimuths of the blades that are summed, from that of blade 1 [rad].
    core : float
        Core radius of the segments, positive [m].

    Returns
    -------
    (3, nc, ns, n_points) array
        Velocity per unit circulation [1/m].
    """
    start, end = (turned(ends, azimuths) for ends in ring_segments(rings))
    return _of_rings(segment_velocities(points, start, end, core), rings)


def blade_normalwash(rings: Rings, azimuths: np.ndarray, core: Scalar) -> Array:
    """Normalwash at the collocation points per unit circulation of each ring, wake left out.

    Parameters
    ----------
    rings : Rings
        Lattice of blade 1.
    azimuths : (n_blades,) array
        Azimuths of the blades that are summed, from that of blade 1 [rad].
    core : float
        Core radius of the segments, positive [m].

    Returns
    -------
    (nc, ns, nc * ns) array
        Normal velocity per unit circulation [1/m].
    """

    def add(total: Array, ends: tuple[Array, Array]) -> tuple[Array, None]:
        return total + segment_normalwash(rings.collocation, rings.normal, *ends, core), None

    start, end = (turned(ends, azimuths) for ends in ring_segments(rings))
    total = jnp.zeros((start.shape[1], len(rings.collocation)))
    # Two at a time, which saves writing and reading sums, most of all of derivatives.
    return _of_rings(jax.lax.scan(add, total, (start, end), unroll=2)[0], rings)


def _of_rings(of_segments: Array, rings: Rings) -> Array:
    """What a ring induces, (..., nc, ns, n_points), from what its segments do."""
    nc, ns = rings.corner.shape[0] - 1, rings.corner.shape[1] - 1
    rest, n_points = of_segments.shape[:-2], of_segments.shape[-1]
    bound = of_segments[..., : nc * ns, :].reshape(*rest, nc, ns, n_points)
    chordwise = of_segments[..., nc * ns :, :].reshape(*rest, nc, ns + 1, n_points)
    ring = bound + chordwise[..., 1:, :] - chordwise[..., :-1, :]
    return ring.at[..., :-1, :, :].add(-bound[..., 1:, :, :])

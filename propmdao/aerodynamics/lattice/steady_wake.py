"""What the wake of all blades induces on blade 1, per unit circulation of its strips.

A wake in steady flow is some four thousand segments, and most of them are far away, where their
flow is smooth. So it is taken in three parts:

- the rings that blade 1 has just shed act on every collocation point and segment;
- the others of the first turn act on a few points of each strip, between which their flow is read
  (`lattice.chord_lines`);
- of what is older, every second filament acts on fewer points still, and the filaments between are
  read as the points are.

On the default lattice, 8 x 24 panels and six turns of two blades, a tenth of the pairs of segments
and points is left, 0.24 of 2.25 million. Over the catalogue, from hover to windmilling, thrust and
torque change by less than 0.05 % (tests/validation/test_steady_wake.py).
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import (
    LINE_POINTS,
    ChordLines,
    at_collocation,
    at_segments,
    coarse_points,
    every_second,
    from_coarse,
    through_nearest,
)
from propmdao.aerodynamics.vortices.biot_savart import filament_velocities
from propmdao.records.pytrees import record

# Strips of a lattice on which fewer points and filaments do for what is older than a turn.
_ENOUGH_STRIPS = 16


@record
class WakeInfluence:
    """Velocity per unit circulation of each strip's last ring, by its wake.

    Attributes
    ----------
    at_points : (3, ns, n_points) array
        At the collocation points, then the segments' points, of the part that acts there [1/m].
    at_lines : (3, ns, n_lines) array or None
        At the points of the strips' lines, of the part that is read between them [1/m]; None if
        there is none.
    """

    at_points: Array
    at_lines: Array | None = None

    def normalwash(self, normals: Array, lines: ChordLines) -> Array:
        """Velocity along the normal at the collocation points.

        Parameters
        ----------
        normals : (n_panels, 3) array
            Unit normals at the collocation points.
        lines : ChordLines
            Points of the strips.

        Returns
        -------
        (ns, n_panels) array
            Velocity per unit circulation [1/m].
        """
        n_panels, ns = normals.shape[0], self.at_points.shape[1]
        at_points = (self.at_points[:, :, :n_panels] * normals.T[:, None]).sum(axis=0)
        if self.at_lines is None:
            return at_points
        read = (self.at_lines * lines.normals.T[:, None]).sum(axis=0)
        return at_points + at_collocation(read, n_panels // ns)

    def velocities(self, circulation: Array, n_panels: int) -> Array:
        """Velocity at the segments.

        Parameters
        ----------
        circulation : (ns,) array
            Circulation of the strips' last rings [m^2/s].
        n_panels : int
            Number of collocation points.

        Returns
        -------
        (3, n_segments) array
            Velocity [m/s].
        """
        velocity = jnp.einsum("s,csp->cp", circulation, self.at_points[:, :, n_panels:])
        if self.at_lines is None:
            return velocity
        read = jnp.einsum("s,csp->cp", circulation, self.at_lines)
        return velocity + at_segments(read, n_panels // circulation.size)


def steady_wake(
    points: Array, lines: ChordLines, nodes: Array, core_radius: Array, rings: tuple[int, int]
) -> WakeInfluence:
    """Velocity at the points of blade 1, in the three parts.

    Parameters
    ----------
    points : (n_points, 3) array
        Collocation points of blade 1, then the points of its segments [m].
    lines : ChordLines
        Points of its strips.
    nodes : (ns + 1, n_blades, n_nodes, 3) array
        Trailing filaments of all blades, blade 1 first [m].
    core_radius : (n_nodes - 1,) array
        Core radius along the filaments [m].
    rings : (int, int)
        Rings of blade 1 that are near to it, and rings behind a blade within the first turn.

    Returns
    -------
    WakeInfluence
        The velocity; a lattice with few panels along the chord has nothing to read between.
    """
    n_near, n_turn = rings
    ns, n_rings = nodes.shape[0] - 1, core_radius.size
    n_chordwise = (len(points) - ns) // (3 * ns + 1) + 1
    if n_chordwise <= LINE_POINTS or n_near >= n_rings:
        return WakeInfluence(wake_influence(points, nodes, core_radius))
    near = wake_influence(points, nodes[:, :1, : n_near + 1], core_radius[:n_near])
    n_turn = _read_finely(ns, n_turn, n_rings)
    first, rest = nodes[:, :1, n_near : n_turn + 1], nodes[:, 1:, : n_turn + 1]
    start, end, core = (
        jnp.concatenate(parts, axis=-2 if parts[0].ndim == 3 else 0)
        for parts in zip(
            _segments(first, core_radius[n_near:n_turn]),
            _segments(rest, core_radius[:n_turn]),
            strict=True,
        )
    )
    read = filament_velocities(lines.points, start, end, core)
    if n_turn < n_rings:
        read += _older(lines, nodes[:, :, n_turn:], core_radius[n_turn:])
    return WakeInfluence(near, _of_strips(read))


def wake_influence(points: Array, wake_nodes: Array, wake_core_radius: Array) -> Array:
    """Velocity at the points per unit circulation of each strip's last ring, by its whole wake.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    wake_nodes : (ns + 1, n_blades, n_nodes, 3) array
        Trailing filaments of the blades that are summed, because their circulation is the same [m].
    wake_core_radius : (n_nodes - 1,) array
        Core radius along the filaments [m].

    Returns
    -------
    (3, ns, n_points) array
        Velocity per unit circulation [1/m].
    """
    return _of_strips(_filaments(points, wake_nodes, wake_core_radius))


def left_by_coarse_reading(
    lines: ChordLines, nodes: Array, core_radius: Array, n_turn: int
) -> Array:
    """What `steady_wake` has at the points of the strips beyond what the wake induces there.

    Parameters
    ----------
    lines : ChordLines
        Points of the strips of blade 1.
    nodes : (ns + 1, n_blades, n_nodes, 3) array
        Trailing filaments of all blades, blade 1 first [m].
    core_radius : (n_nodes - 1,) array
        Core radius along the filaments [m].
    n_turn : int
        Rings behind a blade within the first turn.

    Returns
    -------
    (3, ns, n_lines) array
        Velocity per unit circulation of the strips [1/m].
    """
    n_turn = _read_finely(nodes.shape[0] - 1, n_turn, core_radius.size)
    if n_turn == core_radius.size:
        return jnp.zeros((3, nodes.shape[0] - 1, len(lines.points)))
    older, core = nodes[:, :, n_turn:], core_radius[n_turn:]
    return _of_strips(_older(lines, older, core) - _filaments(lines.points, older, core))


def _read_finely(n_strips: int, n_turn: int, n_rings: int) -> int:
    """Rings that act by all filaments on the points of all strips."""
    return n_rings if n_strips < _ENOUGH_STRIPS else min(n_turn, n_rings)


def _older(lines: ChordLines, nodes: Array, core_radius: Array) -> Array:
    """Velocity at the points of the strips by each filament, read from every second one.

    Of shape (3, ns + 1, n_lines) [1/m].
    """
    number, ns = np.arange(nodes.shape[0]), nodes.shape[0] - 1
    kept = every_second(number.size)
    coarse = _filaments(coarse_points(lines, ns), nodes[kept], core_radius)
    to_all = jnp.asarray(through_nearest(kept, number))
    return jnp.einsum("fk,ckp->cfp", to_all, from_coarse(coarse, ns))


def _filaments(points: Array, nodes: Array, core_radius: Array) -> Array:
    """Velocity at the points by each filament, summed over the blades, (3, ns + 1, n_points)."""
    return filament_velocities(points, *_segments(nodes, core_radius))


def _segments(nodes: Array, core_radius: Array) -> tuple[Array, Array, Array]:
    """Start and end of the segments of each filament, those of all blades, and their core."""
    n_filaments, n_blades = nodes.shape[:2]
    start, end = (
        ends.reshape(n_filaments, n_blades * core_radius.size, 3)
        for ends in (nodes[:, :, :-1], nodes[:, :, 1:])
    )
    return start, end, jnp.tile(core_radius, n_blades)


def _of_strips(filaments: Array) -> Array:
    """Velocity by both filaments of each strip, whose circulation is opposite."""
    return filaments[:, 1:] - filaments[:, :-1]

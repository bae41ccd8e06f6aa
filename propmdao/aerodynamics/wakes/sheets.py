"""What the sheets behind the blades induce: rings of known circulation, and of that of the moment.

A sheet is rings between neighbouring filaments. Along a filament runs the difference of the strips
on its sides, across a strip the change from one ring to the next; the last ring is open, for the
wake goes on.
"""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.vortices.biot_savart import summed_velocities
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.lags import shed
from propmdao.records.pytrees import Scalar, record, static
from propmdao.records.states import RotorState

#: For what is far away or smoothed: 1e-5 of a velocity, at half the time.
SINGLE = np.float32


@record
class Sheets:
    """Sheets behind all blades, at one moment.

    Attributes
    ----------
    nodes : (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, from the trailing edge [m].
    trailing_core, shed_core : (n_nodes - 1,) arrays
        Core radius of the segments along the filaments, and across them at their younger end [m].
    """

    nodes: Array
    trailing_core: Array
    shed_core: Array

    def scaled(self, length: Scalar) -> Sheets:
        """The sheets in lengths of one's own, in single precision."""
        return jax.tree.map(lambda x: (x / length).astype(SINGLE), self)

    @property
    def cores(self) -> tuple[Array, Array]:
        """Core radii, trailing and shed, of the segments behind all blades."""
        n_blades = self.nodes.shape[1]
        return jnp.tile(self.trailing_core, n_blades), jnp.tile(self.shed_core, n_blades)

    def youngest(self, n_rings: int) -> Sheets:
        """The part of the sheets next to the blades, so many rings long."""
        return Sheets(
            self.nodes[:, :, : n_rings + 1],
            self.trailing_core[:n_rings],
            self.shed_core[:n_rings],
        )

    def older(self, n_rings: int) -> Sheets:
        """The part of the sheets behind so many rings next to the blades."""
        return Sheets(
            self.nodes[:, :, n_rings:], self.trailing_core[n_rings:], self.shed_core[n_rings:]
        )


def aged_sheets(nodes: Array, ages: Array, state: RotorState, initial: Scalar) -> Sheets:
    """Sheets whose cores have grown with their age.

    Parameters
    ----------
    nodes : (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, from the trailing edge [m].
    ages : (n_nodes,) array
        Azimuths of the nodes behind their blade [rad].
    state : RotorState
        Rotation speed and air of the rotor.
    initial : float
        Core radius at the blade [m].

    Returns
    -------
    Sheets
        The sheets; a trailing segment is as old as its middle.
    """
    trailing, shed = (core_radius(at_age, state, initial) for at_age in (middles(ages), ages[:-1]))
    return Sheets(nodes, trailing, shed)


@record
class WakeParts:
    """Parts of the sheets by age; the oldest has fewer filaments, and is in single precision.

    Attributes
    ----------
    chosen : (n_chosen,) array of int
        Filaments that are left, root and tip among them.
    to_strips : (n_chosen - 1, ns) array
        Weights from the circulation of the strips to that between them.
    length : scalar
        Length of the order of the rotor's [m].
    n_young : int
        Rings next to the blades that may depend on their present circulation: those younger than
        two time steps and the next one.
    n_near : int
        Rings next to the blades with all filaments.
    n_close : int or None
        Rings next to the blades that act on every point, the young ones among them; the flow of all
        others is read between a few points of each strip (`lattice.chord_lines`). None: all do.
    """

    chosen: Array
    to_strips: Array
    length: Scalar
    n_young: int = static()
    n_near: int = static()
    n_close: int | None = static(None)


def fewer_filaments(edge: Array, n_filaments: int) -> tuple[np.ndarray, np.ndarray]:
    """Choose some of the filaments of a lattice; call it outside ``jit``.

    Parameters
    ----------
    edge : (ns + 1, 3) array
        Where the lattice's filaments leave blade 1 [m].
    n_filaments : int
        Filaments wanted; there are no more than those of the lattice.

    Returns
    -------
    chosen, to_strips : (n_chosen,), (n_chosen - 1, ns) arrays
        Filaments, root and tip among them, and weights from the circulation of the lattice's strips
        to that between them: means over their width, which keep the impulse.
    """
    n_edges = edge.shape[0]
    chosen = np.unique(np.round(np.linspace(0, n_edges - 1, min(n_filaments, n_edges))).astype(int))
    width = np.linalg.norm(np.diff(np.asarray(edge), axis=0), axis=1)
    to_strips = np.zeros((chosen.size - 1, n_edges - 1))
    for k, (first, last) in enumerate(zip(chosen[:-1], chosen[1:], strict=True)):
        to_strips[k, first:last] = width[first:last] / width[first:last].sum()
    return chosen, to_strips


def wake_velocities(
    points: Array, sheets: Sheets, parts: WakeParts, ring: Array, present: Array
) -> Array:
    """Velocity at points by sheets whose older part has fewer filaments.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets of ns strips behind all blades.
    parts : WakeParts
        Parts of the sheets.
    ring : (n_blades, ns, n_rings) array
        Circulation of their rings [m^2/s].
    present : (n_blades, ns) array
        Circulation of the strips of the blades [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    n = parts.n_near
    near = youngest_velocities(points, sheets, n, ring, present)
    old = sheets.older(n)
    older = dataclasses.replace(old, nodes=old.nodes[parts.chosen]).scaled(parts.length)
    strips = jnp.einsum("ks,bsr->bkr", parts.to_strips, ring[..., n:])
    strips, places = (x.astype(SINGLE) for x in (strips / parts.length, points / parts.length))
    none = jnp.zeros(strips.shape[:2], SINGLE)
    return near + sheet_velocities(places, older, strips, none).astype(float)


def youngest_velocities(
    points: Array, sheets: Sheets, n_rings: int, ring: Array, present: Array
) -> Array:
    """Velocity at points by the rings of sheets next to the blades.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets of ns strips behind all blades.
    n_rings : int
        Rings that act.
    ring : (n_blades, ns, n_rings) array
        Circulation of all rings [m^2/s].
    present : (n_blades, ns) array
        Circulation of the strips of the blades [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    # Rings are closed on both sides of the cut: this sheet ends with a ring of no circulation.
    ended = ring[..., : n_rings + 1].at[..., n_rings].set(0.0)
    return sheet_velocities(points, sheets.youngest(n_rings + 1), ended, present)


def older_velocities(
    points: Array, sheets: Sheets, n_rings: int, parts: WakeParts, ring: Array
) -> Array:
    """Velocity at points by the rings behind those next to the blades.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets of ns strips behind all blades.
    n_rings : int
        Rings that do not act.
    parts : WakeParts
        Parts of the sheets.
    ring : (n_blades, ns, n_rings) array
        Circulation of all rings [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    left = dataclasses.replace(parts, n_near=parts.n_near - n_rings)
    still = jnp.zeros(ring.shape[:2])
    return wake_velocities(points, sheets.older(n_rings), left, ring[..., n_rings:], still)


def sheet_velocities(points: Array, sheets: Sheets, ring: Array, present: Array) -> Array:
    """Velocity at points by sheets of known circulation.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets of ns strips behind all blades.
    ring : (n_blades, ns, n_rings) array
        Circulation of their rings [m^2/s].
    present : (n_blades, ns) array
        Circulation of the strips of the blades [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    rings, segments = (
        strengths.swapaxes(0, 1).reshape(ring.shape[1], -1)
        for strengths in (ring, shed(ring, present))
    )
    return velocities_of_strips(points, sheets, rings, segments)


def velocities_of_strips(points: Array, sheets: Sheets, ring: Array, shed: Array) -> Array:
    """Velocity at points by the strips of sheets behind all blades.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets behind all blades.
    ring, shed : (ns, n_blades * (n_nodes - 1)) arrays
        Circulation of the rings, and of the segments at their younger ends [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    nodes, (trailing_core, shed_core) = sheets.nodes, sheets.cores
    padded = jnp.pad(ring, ((1, 1), (0, 0)))

    # The checkpoints keep reverse mode from storing every block of segments x points.
    @jax.checkpoint
    def of_filament(filament: tuple[Array, Array]) -> Array:
        place, strength = filament
        start, end = place[:, :-1].reshape(-1, 3), place[:, 1:].reshape(-1, 3)
        return summed_velocities(points, start, end, trailing_core, strength)

    @jax.checkpoint
    def across_strip(strip: tuple[Array, Array, Array]) -> Array:
        *edges, strength = strip
        start, end = (edge[:, :-1].reshape(-1, 3) for edge in edges)
        return summed_velocities(points, start, end, shed_core, strength)

    along = jax.lax.map(of_filament, (nodes, padded[:-1] - padded[1:]))
    across = jax.lax.map(across_strip, (nodes[:-1], nodes[1:], shed))
    return along.sum(axis=0) + across.sum(axis=0)


def normalwash_of_strips(points: Array, normals: Array, sheets: Sheets, now: Array) -> Array:
    """Normalwash by sheets per unit of the circulation that the strips have at the moment.

    Parameters
    ----------
    points, normals : (n_points, 3) arrays
        Points [m], and unit vectors along which the velocity is wanted.
    sheets : Sheets
        Sheets of ns strips behind all blades.
    now : (ns, n_rings) array
        Share of the strips' present circulation in their rings.

    Returns
    -------
    (n_blades, ns, n_points) array
        Normalwash per unit circulation of the strips of each blade [1/m].
    """

    def induced(start: Array, end: Array, core: Array, circulation: Array) -> Array:
        """Normalwash of a chain behind each blade, for each of some circulations of it."""

        # The chain's kernel is computed once for all of its circulations.
        def by_chain(start: Array, end: Array) -> Array:
            return jax.vmap(lambda g: summed_velocities(points, start, end, core, g))(circulation)

        return jnp.einsum("bkcp,pc->bkp", jax.vmap(by_chain)(start, end), normals)

    def of_filament(filament: tuple[Array, Array]) -> Array:
        nodes, circulation = filament
        return induced(nodes[:, :-1], nodes[:, 1:], sheets.trailing_core, circulation)

    def across_strip(strip: tuple[Array, Array, Array]) -> Array:
        root, tip, circulation = strip
        return induced(root[:, :-1], tip[:, :-1], sheets.shed_core, circulation[None])[:, 0]

    # A filament is the outer edge of one strip and the inner one of the next.
    padded = jnp.pad(now, ((1, 1), (0, 0)))
    edges = jnp.stack([padded[:-1], padded[1:]], axis=1)
    along = jax.lax.map(of_filament, (sheets.nodes, edges))
    change = shed(now, jnp.ones(now.shape[0]))
    across = jax.lax.map(across_strip, (sheets.nodes[:-1], sheets.nodes[1:], change))
    return (along[1:, :, 0] - along[:-1, :, 1] + across).swapaxes(0, 1)

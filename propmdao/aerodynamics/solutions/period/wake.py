"""What the wake induces at every azimuth of blade 1.

The wake is a rigid one for each azimuth, whose segments carry circulation of the past. What it
induces is folded on the circulation of the strips at the azimuths before anything is solved: with
N azimuths, ns strips and np panels N^2 ns np numbers (50 MB for 36, 24 and 192).

It is computed in two parts. The rings that blade 1 has just shed act on each collocation point and
segment. All others act on a few points of each strip, between which their flow is read
(`lattice.chord_lines`). What that leaves out is added as it is in axial flight, where the wake does
not drift and each strip has the same circulation at all azimuths: so without incidence nothing is
left out.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import at_collocation, at_segments
from propmdao.aerodynamics.lattice.rings import wake_influence
from propmdao.aerodynamics.solutions.period.lattice import PeriodLattice
from propmdao.aerodynamics.vortices.biot_savart import segment_normalwash
from propmdao.aerodynamics.wakes.history import history_weights
from propmdao.aerodynamics.wakes.sheets import Sheets, velocities_of_strips
from propmdao.records.pytrees import record

# Rings that act on every point: at least so many, and such a part of the wake.
_LEAST_NEAR, _NEAR_PART = 12, 0.08


@record
class PeriodWake:
    """Wake of all blades at every azimuth of blade 1.

    Attributes
    ----------
    nodes : (ns + 1, n_blades, n_nodes, 3) array
        Nodes of the filaments before they drift sideways [m].
    drift : (n_azimuths, n_nodes, 3) array
        Sideways displacement at each azimuth [m].
    ages : (n_nodes,) array
        Azimuths of the nodes behind their blade [rad].
    delay : (ns,) array
        Azimuth by which the circulation of each strip's wake is older than its nodes [rad].
    trailing_core, shed_core : (n_nodes - 1,) arrays
        Core radius of the segments along the filaments, and across them at their younger end [m].
    """

    nodes: Array
    drift: Array
    ages: Array
    delay: Array
    trailing_core: Array
    shed_core: Array

    @property
    def n_near(self) -> int:
        """Rings of blade 1 that act on every point."""
        n_rings = self.ages.shape[0] - 1
        return min(max(_LEAST_NEAR, int(_NEAR_PART * n_rings)), n_rings - 1)

    def parts(self) -> tuple[_WakePart, _WakePart]:
        """The rings that blade 1 has just shed, and all others."""
        n_blades, n_rings, near = self.nodes.shape[1], self.ages.shape[0] - 1, self.n_near
        ring, shed = history_weights(self.ages, self.delay, self.drift.shape[0], n_blades)
        # The shed segment at the cut is near, so that none is far where all carry the same.
        number = np.arange(n_blades * n_rings)
        sheets = Sheets(self.nodes, self.trailing_core, self.shed_core)
        return (
            _WakePart(
                Sheets(self.nodes[:, :1], self.trailing_core, self.shed_core).youngest(near + 1),
                self.drift[:, : near + 2],
                jnp.where(number < near, ring, 0.0)[..., : near + 1],
                shed[..., : near + 1],
            ),
            _WakePart(
                sheets,
                self.drift,
                jnp.where(number < near, 0.0, ring),
                jnp.where(number <= near, 0.0, shed),
            ),
        )


@record
class _WakePart:
    """Sheets at every azimuth, and what their circulation is made of.

    Attributes
    ----------
    sheets : Sheets
        Sheets before they drift.
    drift : (n_azimuths, n_nodes, 3) array
        Sideways displacement at each azimuth [m].
    ring, shed : (ns, n_azimuths, n_blades * n_rings) arrays
        Weights of `history_weights`.
    """

    sheets: Sheets
    drift: Array
    ring: Array
    shed: Array


def wake_normalwash(lattice: PeriodLattice, wake: PeriodWake) -> Array:
    """Normalwash at the collocation points by the wake.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    wake : PeriodWake
        Wake of all blades.

    Returns
    -------
    (n_azimuths, n_azimuths, ns, n_panels) array
        Normalwash at an azimuth (first axis) per unit circulation of a strip at another [1/m].
    """
    rings, lines, nc = lattice.lattice.rings, lattice.lines, lattice.n_chordwise
    near, far = wake.parts()
    total = _normalwash(rings.collocation, rings.normal, near)
    total += at_collocation(_normalwash(lines.points, lines.normals, far), nc)
    exact, read = (_steady(points, wake) for points in (rings.collocation, lines.points))
    left_out = jnp.einsum("csp,pc->sp", exact, rings.normal) - at_collocation(
        jnp.einsum("csp,pc->sp", read, lines.normals), nc
    )
    same = jnp.arange(total.shape[0])
    return total.at[same, same].add(left_out)


def wake_velocities(lattice: PeriodLattice, wake: PeriodWake, circulation: Array) -> Array:
    """Velocity at the segments of blade 1 by the wake of known circulation.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    wake : PeriodWake
        Wake of all blades.
    circulation : (n_azimuths, ns) array
        Circulation of the strips at the azimuths of blade 1 [m^2/s].

    Returns
    -------
    (n_azimuths, 3, n_segments) array
        Velocity at each azimuth [m/s].
    """
    lines, nc = lattice.lines.points, lattice.n_chordwise
    segments = lattice.lattice.points[lattice.lattice.rings.normal.shape[0] :]
    near, far = wake.parts()
    total = _velocities(segments, near, circulation)
    total += at_segments(_velocities(lines, far, circulation), nc)
    left_out = _steady(segments, wake) - at_segments(_steady(lines, wake), nc)
    return total + jnp.einsum("csp,ks->kcp", left_out, circulation)


def _steady(points: Array, wake: PeriodWake) -> Array:
    """Velocity per unit circulation of the strips by their far wake, as in axial flight.

    Of shape (3, ns, n_points) [1/m].
    """
    near, nodes, core = wake.n_near, wake.nodes, wake.trailing_core
    total = wake_influence(points, nodes[:, :1, near:], core[near:])
    if nodes.shape[1] > 1:
        total += wake_influence(points, nodes[:, 1:], core)
    return total


def _normalwash(points: Array, normals: Array, part: _WakePart) -> Array:
    """Normalwash by a part of the wake, of shape (n_azimuths, n_azimuths, ns, n_points) [1/m]."""
    trailing_core, shed_core = part.sheets.cores
    n_azimuths = part.ring.shape[1]

    # One strip at a time: the block of segments x points stays in cache. The checkpoint keeps
    # reverse mode from storing every block.
    @jax.checkpoint
    def by_filament(nodes: Array) -> Array:
        start, end = nodes[:, :-1].reshape(-1, 3), nodes[:, 1:].reshape(-1, 3)
        return segment_normalwash(points, normals, start, end, trailing_core)

    @jax.checkpoint
    def of_strip(inner: Array, strip: tuple[Array, ...]) -> tuple[Array, Array]:
        root, tip, ring, shed = strip
        outer = by_filament(tip)
        start, end = (edge[:, :-1].reshape(-1, 3) for edge in (root, tip))
        across = segment_normalwash(points, normals, start, end, shed_core)
        return outer, ring @ (outer - inner) + shed @ across

    def at_azimuth(place: tuple[Array, Array]) -> Array:
        number, drift = place
        nodes = part.sheets.nodes + drift
        strips = nodes[:-1], nodes[1:], part.ring, part.shed
        later = jax.lax.scan(of_strip, by_filament(nodes[0]), strips)[1]
        # From so many azimuths later to the azimuth itself.
        return later.swapaxes(0, 1)[(jnp.arange(n_azimuths) - number) % n_azimuths]

    return jax.lax.map(at_azimuth, (jnp.arange(n_azimuths), part.drift))


def _velocities(points: Array, part: _WakePart, circulation: Array) -> Array:
    """Velocity by a part of the wake of known circulation, (n_azimuths, 3, n_points) [m/s]."""
    n_azimuths = part.ring.shape[1]

    def at_azimuth(place: tuple[Array, Array]) -> Array:
        number, drift = place
        later = circulation[(jnp.arange(n_azimuths) + number) % n_azimuths]
        ring, shed = (jnp.einsum("snc,ns->sc", weight, later) for weight in (part.ring, part.shed))
        nodes = part.sheets.nodes + drift
        return velocities_of_strips(points, nodes, ring, shed, part.sheets.cores)

    return jax.lax.map(at_azimuth, (jnp.arange(n_azimuths), part.drift))

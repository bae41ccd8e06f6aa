"""What the wake induces at every azimuth of blade 1.

The wake is a rigid one for each azimuth, whose segments carry circulation of the past. What it
induces is folded on the circulation of the strips at the azimuths before anything is solved: with
N azimuths, ns strips and np panels N^2 ns np numbers (50 MB for 36, 24 and 192).

Most of this flow is smooth, and that is where the time is saved:

- The rings that blade 1 has just shed act on each collocation point and segment. All others act on
  a few points of each strip, between which their flow is read (`lattice.chord_lines`), if it has
  more panels than that.
- What a ring does to a point changes slowly as the blade turns with it: where there are many
  azimuths, every second one is enough, and their Fourier series gives the others.

In axial flight what is older than a turn is read more coarsely still (`lattice.steady_wake`). The
little that this changes is added here, so that without incidence both are the same flow.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import at_collocation, at_segments
from propmdao.aerodynamics.lattice.steady_wake import left_by_coarse_reading
from propmdao.aerodynamics.solutions.period.lattice import PeriodLattice
from propmdao.aerodynamics.vortices.biot_savart import segment_normalwash
from propmdao.aerodynamics.wakes.history import history_weights
from propmdao.aerodynamics.wakes.sheets import Sheets, velocities_of_strips
from propmdao.records.pytrees import record, static

_ENOUGH_AZIMUTHS = 18


@record
class PeriodWake:
    """Wake of all blades at every azimuth of blade 1.

    Attributes
    ----------
    sheets : Sheets
        Sheets behind all blades before they drift sideways.
    drift : (n_azimuths, n_nodes, 3) array
        Sideways displacement at each azimuth [m].
    ages : (n_nodes,) array
        Azimuths of the nodes behind their blade [rad].
    delay : (ns,) array
        Azimuth by which the circulation of each strip's wake is older than its nodes [rad].
    n_near : int or None
        Rings of blade 1 that act on every point; None if those of all blades do.
    n_turn : int
        Rings behind a blade that are younger than a turn.
    """

    sheets: Sheets
    drift: Array
    ages: Array
    delay: Array
    n_near: int | None = static(None)
    n_turn: int = static(1)

    def parts(self) -> tuple[_WakePart, _WakePart | None]:
        """The rings that act on every point, and all others."""
        n_blades, n_rings = self.sheets.nodes.shape[1], self.ages.shape[0] - 1
        near, sheets = self.n_near, self.sheets
        ring, shed = history_weights(self.ages, self.delay, self.drift.shape[0], n_blades)
        if near is None:
            return _WakePart(sheets, self.drift, ring, shed), None
        # The shed segment at the cut is near, so that none is far where all carry the same.
        number = np.arange(n_blades * n_rings)
        behind_blade_1 = dataclasses.replace(sheets, nodes=sheets.nodes[:, :1])
        return (
            _WakePart(
                behind_blade_1.youngest(near + 1),
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
    rings, lines, nc = lattice.lattice.rings, lattice.lattice.lines, lattice.n_chordwise
    near, far = wake.parts()
    later = _normalwash(rings.collocation, rings.normal, near)
    if far is not None:
        later += at_collocation(_normalwash(lines.points, lines.normals, far), nc)
        in_axial_flight = jnp.einsum(
            "csp,pc->sp", _as_in_axial_flight(lattice, wake), lines.normals
        )
        later = later.at[:, 0].add(at_collocation(in_axial_flight, nc))
    later = _at_all(later, wake.drift.shape[0])
    # From so many azimuths later to the azimuth itself.
    number = jnp.arange(later.shape[0])
    return later[number[:, None], (number - number[:, None]) % number.size]


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
    lines, nc = lattice.lattice.lines.points, lattice.n_chordwise
    segments = lattice.lattice.points[lattice.lattice.rings.normal.shape[0] :]
    near, far = wake.parts()
    total = _velocities(segments, near, circulation)
    if far is None:
        return _at_all(total, circulation.shape[0])
    total += at_segments(_velocities(lines, far, circulation), nc)
    in_axial_flight = at_segments(_as_in_axial_flight(lattice, wake), nc)
    total = _at_all(total, circulation.shape[0])
    return total + jnp.einsum("csp,ks->kcp", in_axial_flight, circulation)


def _as_in_axial_flight(lattice: PeriodLattice, wake: PeriodWake) -> Array:
    """What the wake of axial flight has at the strips' lines beyond this one, (3, ns, n_lines)."""
    sheets = wake.sheets
    return left_by_coarse_reading(
        lattice.lattice.lines, sheets.nodes, sheets.trailing_core, wake.n_turn
    )


def _normalwash(points: Array, normals: Array, part: _WakePart) -> Array:
    """Normalwash by a part of the wake, at the azimuths that are computed.

    Of shape (n_computed, n_azimuths, ns, n_points), per circulation so many azimuths later [1/m].
    """
    trailing_core, shed_core = part.sheets.cores

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

    def at_azimuth(drift: Array, _: Array) -> Array:
        nodes = part.sheets.nodes + drift
        strips = nodes[:-1], nodes[1:], part.ring, part.shed
        return jax.lax.scan(of_strip, by_filament(nodes[0]), strips)[1].swapaxes(0, 1)

    return _at_some(at_azimuth, part.drift)


def _velocities(points: Array, part: _WakePart, circulation: Array) -> Array:
    """Velocity by a part of the wake of known circulation, (n_computed, 3, n_points) [m/s]."""

    def at_azimuth(drift: Array, number: Array) -> Array:
        later = jnp.roll(circulation, -number, axis=0)
        ring, shed = (jnp.einsum("snc,ns->sc", weight, later) for weight in (part.ring, part.shed))
        sheets = dataclasses.replace(part.sheets, nodes=part.sheets.nodes + drift)
        return velocities_of_strips(points, sheets, ring, shed)

    return _at_some(at_azimuth, part.drift)


def _at_some(at_azimuth: Callable[[Array, Array], Array], drift: Array) -> Array:
    """Map a function of drift and number of the azimuth over the azimuths that are computed."""
    n = drift.shape[0]
    every = n // _n_computed(n)
    return jax.lax.map(lambda place: at_azimuth(*place), (drift[::every], jnp.arange(0, n, every)))


def _at_all(computed: Array, n_azimuths: int) -> Array:
    """Read the Fourier series of what is computed at some azimuths, the first axis, at all."""
    n = computed.shape[0]
    if n == n_azimuths:
        return computed
    apart = 2.0 * np.pi * (np.arange(n_azimuths)[:, None] / n_azimuths - np.arange(n) / n)
    orders = np.arange(1, (n + 1) // 2)
    series = 1.0 + 2.0 * np.cos(apart[..., None] * orders).sum(axis=-1)
    if n % 2 == 0:
        series += np.cos(0.5 * n * apart)
    return jnp.einsum("kj,j...->k...", jnp.asarray(series / n), computed)


def _n_computed(n_azimuths: int) -> int:
    """Azimuths that are computed: every second one, if that is enough."""
    enough = n_azimuths % 2 == 0 and n_azimuths >= 2 * _ENOUGH_AZIMUTHS
    return n_azimuths // 2 if enough else n_azimuths

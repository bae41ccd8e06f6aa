"""One time step: circulation and forces of the blades in the wake that they have shed.

The equations are those of a period (`solutions.period.loads`) at one moment: Neumann condition with
the wake of the past, unsteady Kutta condition, for the youngest rings have what the strips have
now, the lattice held to the polars, Kutta-Joukowski force with the local velocity, Bernoulli's
unsteady term with a backward difference of second order.

Arrays begin with the blades that are marched, m of them: all, or in axial flow one, of which the
others are copies.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import at_collocation, at_segments
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.period.coupling import (
    blade_forces,
    held_lattice,
    onset_laws,
    velocity_by_air_and_blades,
)
from propmdao.aerodynamics.solutions.period.lattice import (
    PeriodLattice,
    at_the_blades,
    bound_inverse,
)
from propmdao.aerodynamics.solutions.period.onset import PeriodOnset
from propmdao.aerodynamics.wakes.lags import remembered
from propmdao.aerodynamics.wakes.sheets import (
    Sheets,
    WakeParts,
    normalwash_of_strips,
    older_velocities,
    wake_velocities,
    youngest_velocities,
)
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record


@record
class MarchedLattice:
    """Part of the lattice that no step changes.

    Attributes
    ----------
    period : PeriodLattice
        Lattice of blade 1 and what the rings of each blade induce there.
    inverse : (n_blades, n_panels, n_panels) array
        Circulation of the rings per normalwash, see `bound_inverse` [m].
    """

    period: PeriodLattice
    inverse: Array


@record
class Past:
    """What the blades had before.

    Attributes
    ----------
    strips : (n_lags, m, ns) array
        Circulation of the strips one step ago, two steps ago, and so on [m^2/s].
    rings : (2, m, n_panels) array
        Circulation of the rings one and two steps ago [m^2/s].
    """

    strips: Array
    rings: Array


@record
class StepLoads:
    """Loads of the blades at a time step.

    Attributes
    ----------
    circulation : (m, n_panels) array
        Circulation of the rings [m^2/s].
    force : (m, n, 3) array
        Force on the blade in its frame: Kutta-Joukowski on the segments, Bernoulli's unsteady term
        on the rings, profile drag on the sections [N].
    sections : SectionStates
        Flow, lift and drag of the sections, (m, ns) each.
    recambering : (m, ns) array
        Recambering of the sections, 0 in inviscid flow [rad].
    """

    circulation: Array
    force: Array
    sections: SectionStates
    recambering: Array


def marched_lattice(period: PeriodLattice) -> MarchedLattice:
    """Prepare a lattice for marching.

    Parameters
    ----------
    period : PeriodLattice
        Lattice of blade 1.

    Returns
    -------
    MarchedLattice
        The lattice with the inverse of its equations.
    """
    return MarchedLattice(period, bound_inverse(period))


def step_loads(
    lattice: MarchedLattice,
    sheets: Sheets,
    parts: WakeParts,
    lag: Array,
    onset: PeriodOnset,
    past: Past,
    medium: tuple[Scalar, Air, ViscousSections | None],
) -> StepLoads:
    """Solve for the circulation at a time step and take the forces.

    Parameters
    ----------
    lattice : MarchedLattice
        Lattice of blade 1.
    sheets : Sheets
        Wake of all blades, seen from each blade that is marched (a leading axis of m).
    parts : WakeParts
        Parts of the wake.
    lag : (ns, n_rings) array
        Time since the rings of the wake were shed, in steps.
    onset : PeriodOnset
        Air that meets the blades before their vortices act, with the blades in place of azimuths.
    past : Past
        Circulation at the steps before.
    medium : tuple
        Time step [s], undisturbed air, polars that the lattice is held to or None.

    Returns
    -------
    StepLoads
        Loads of the blades.
    """
    timestep, air, polars = medium
    period, geometry = lattice.period, lattice.period.lattice
    normal, points = geometry.rings.normal, geometry.points
    n_blades, n_panels = lattice.inverse.shape[:2]
    ns = onset.relative_speed.shape[1]
    collocation, on_segments = points[:n_panels], points[n_panels:]

    known, now = remembered(lag, past.strips)
    seen_known = seen_from_each(known, n_blades)
    still = jnp.zeros((n_blades, ns))
    older = None
    if (n := parts.n_close) is not None:
        lines = period.lattice.lines.points
        older = jax.lax.map(
            lambda place: older_velocities(lines, place[0], n, parts, place[1]),
            (sheets, seen_known),
        )

    def by_rings(points: Array, seen: Sheets, ring: Array, present: Array) -> Array:
        """Velocity by the rings that act on every point."""
        if parts.n_close is None:
            return wake_velocities(points, seen, parts, ring, present)
        return youngest_velocities(points, seen, parts.n_close, ring, present)

    def on_panels(place: tuple[Sheets, Array]) -> tuple[Array, Array]:
        seen, ring = place
        young = seen.youngest(parts.n_young)
        by_strips = normalwash_of_strips(collocation, normal, young, now[:, : parts.n_young])
        return by_rings(collocation, seen, ring, still), by_strips

    velocity, by_strips = jax.lax.map(on_panels, (sheets, seen_known))
    if older is not None:
        velocity += at_collocation(older, period.n_chordwise)
    normalwash = jnp.einsum("kcp,pc->kp", onset.velocity[:, :, :n_panels] + velocity, normal)
    by_strips = _by_blade(by_strips)
    laws = None
    if polars is not None:
        laws = onset_laws(geometry, onset, air, polars)
    held = held_lattice(period, lattice.inverse, onset, normalwash, by_strips, laws)

    velocity = velocity_by_air_and_blades(period, onset, held.circulation)
    ring = known + now * held.strips[..., None]
    velocity += jax.lax.map(
        lambda place: by_rings(on_segments, *place),
        (sheets, seen_from_each(ring, n_blades), seen_from_each(held.strips, n_blades)),
    )
    if older is not None:
        velocity += at_segments(older, period.n_chordwise)

    rate = (1.5 * held.circulation - 2.0 * past.rings[0] + 0.5 * past.rings[1]) / timestep
    return StepLoads(
        held.circulation,
        blade_forces(period, onset, velocity, held, rate, air.density),
        held.by_lattice,
        held.recambering,
    )


def seen_from_each(of_blades: Array, n_blades: int) -> Array:
    """What each marched blade sees of the blades.

    Parameters
    ----------
    of_blades : (m, ...) array
        Anything of the marched blades.
    n_blades : int
        Number of blades.

    Returns
    -------
    (m, n_blades, ...) array
        The same of the blades, counted from the one that sees them.
    """
    return at_the_blades(of_blades, n_blades).swapaxes(0, 1)


def _by_blade(seen: Array) -> Array:
    """From blades counted from the one that feels them to blades marched: (m, m, ...).

    Where one blade is marched, the others have what it has, and their parts add up.
    """
    m = seen.shape[0]
    if m == 1:
        return seen.sum(axis=1, keepdims=True)
    return jnp.stack([jnp.roll(seen[k], k, axis=0) for k in range(m)])

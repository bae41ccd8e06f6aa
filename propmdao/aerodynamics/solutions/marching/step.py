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

from propmdao.aerodynamics.lattice.rings import segment_circulation
from propmdao.aerodynamics.sections.laws import ViscousSections, section_laws
from propmdao.aerodynamics.sections.period_recambering import (
    PeriodFlow,
    period_states,
    solve_period_recambering,
)
from propmdao.aerodynamics.sections.recambering import SectionStates
from propmdao.aerodynamics.solutions.lattice_loads import profile_drag
from propmdao.aerodynamics.solutions.period.lattice import (
    PeriodLattice,
    at_the_blades,
    bound_inverse,
)
from propmdao.aerodynamics.solutions.period.loads import PeriodOnset
from propmdao.aerodynamics.wakes.lags import remembered
from propmdao.aerodynamics.wakes.sheets import (
    Sheets,
    WakeParts,
    normalwash_of_strips,
    wake_velocities,
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
    attached : (m, ns) array
        Share of the lattice in the angle of attack.
    recambering : (m, ns) array
        Recambering of the sections, 0 in inviscid flow [rad].
    """

    circulation: Array
    force: Array
    sections: SectionStates
    attached: Array
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
    normal = period.lattice.rings.normal
    on_panels = period.influence[..., : normal.shape[0]]
    return MarchedLattice(period, bound_inverse(jnp.einsum("bcrp,pc->bpr", on_panels, normal)))


def load_positions(lattice: MarchedLattice) -> Array:
    """Points at which the forces of `StepLoads` act, (n, 3) [m]."""
    geometry = lattice.period.lattice
    n_panels = geometry.rings.normal.shape[0]
    return jnp.concatenate(
        [geometry.points[n_panels:], lattice.period.ring_middle, geometry.strips.quarter_chord]
    )


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
    strips, normal, points = geometry.strips, geometry.rings.normal, geometry.points
    n_blades, n_panels = lattice.inverse.shape[:2]
    m, ns = onset.relative_speed.shape
    nc = n_panels // ns
    collocation, on_segments = points[:n_panels], points[n_panels:]

    known, now = remembered(lag, past.strips)
    still = jnp.zeros((n_blades, ns))

    def at_collocation(place: tuple[Sheets, Array]) -> tuple[Array, Array]:
        seen, ring = place
        velocity = wake_velocities(collocation, seen, parts, ring, still)
        young = seen.youngest(parts.n_young)
        by_strips = normalwash_of_strips(collocation, normal, young, now[:, : parts.n_young])
        return jnp.einsum("cp,pc->p", velocity, normal), by_strips

    by_wake, by_strips = jax.lax.map(at_collocation, (sheets, seen_from_each(known, n_blades)))
    normalwash = jnp.einsum("kcp,pc->kp", onset.velocity[:, :, :n_panels], normal) + by_wake
    by_strips = _by_blade(by_strips)
    flow = PeriodFlow(
        strips,
        onset.relative_speed,
        onset.attached,
        onset.motion_angle,
        *_strip_circulation(lattice.inverse[:, -ns:], normalwash, by_strips, onset.relative_speed),
    )
    recambering, laws = jnp.zeros((m, ns)), None
    if polars is not None:
        laws = jax.vmap(
            lambda speed: section_laws(strips, speed, onset.turning_share, air, polars)
        )(onset.relative_speed)
        recambering = solve_period_recambering(flow, laws, recambering)
    by_lattice, by_motion = period_states(flow, recambering, laws)

    strip = flow.circulation + (flow.response @ recambering.ravel()).reshape(m, ns)
    normalwash += jnp.tile(onset.relative_speed * recambering, (1, nc))
    normalwash += jnp.einsum("kqsp,qs->kp", by_strips, strip)
    circulation = -jnp.einsum("bpr,bkr->kp", lattice.inverse, at_the_blades(normalwash, n_blades))

    velocity = onset.velocity[:, :, n_panels:] + jnp.einsum(
        "bcrp,bkr->kcp", period.influence[..., n_panels:], at_the_blades(circulation, n_blades)
    )
    ring = known + now * strip[..., None]
    velocity += jax.lax.map(
        lambda place: wake_velocities(on_segments, place[0], parts, *place[1:]),
        (sheets, seen_from_each(ring, n_blades), seen_from_each(strip, n_blades)),
    )

    def strength(rings: Array) -> Array:
        return jnp.concatenate([g.ravel() for g in segment_circulation(rings.reshape(nc, ns))])

    lift = air.density * jax.vmap(strength)(circulation)[..., None]
    lift = lift * jnp.cross(velocity.swapaxes(1, 2), geometry.segment)
    rate = (1.5 * circulation - 2.0 * past.rings[0] + 0.5 * past.rings[1]) / timestep
    unsteady = air.density * rate[..., None] * period.ring_area

    def drag(states: SectionStates) -> Array:
        return jax.vmap(lambda at: profile_drag(strips, at, air.density))(states)

    share = onset.attached[..., None]
    profile = share * drag(by_lattice) + (1.0 - share) * drag(by_motion)
    return StepLoads(
        circulation,
        jnp.concatenate([lift, unsteady, profile], axis=1),
        by_lattice,
        onset.attached,
        recambering,
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


def _strip_circulation(
    inverse: Array, normalwash: Array, by_strips: Array, relative_speed: Array
) -> tuple[Array, Array]:
    """Circulation of the strips of the marched blades, and its change per recambering.

    Parameters
    ----------
    inverse : (n_blades, ns, n_panels) array
        Rows of `bound_inverse` that belong to the last rings.
    normalwash : (m, n_panels) array
        Normalwash by the air and by the wake of the past.
    by_strips : (m, m, ns, n_panels) array
        Normalwash per present circulation of the strips of each marched blade.
    relative_speed : (m, ns) array
        Speed of the air relative to the sections.

    Returns
    -------
    circulation, response : (m, ns), (m * ns, m * ns) arrays
        Circulation, and response as in `PeriodFlow`.
    """
    (m, ns), n_blades = relative_speed.shape, inverse.shape[0]
    size = m * ns

    def summed(of_blade: Array) -> Array:
        """Sum over the blades of what is felt there, at the marched blades."""
        felt = [jnp.roll(of_blade[b], -b, axis=0) for b in range(n_blades)]
        return jnp.stack(felt).sum(axis=0)

    by_onset = summed(jnp.einsum("bsp,kp->bks", inverse, normalwash))
    coupled = summed(jnp.einsum("bsp,kqtp->bksqt", inverse, by_strips))
    # A recambering of 1 is a normalwash W on all panels of its strip.
    all_panels = inverse.reshape(n_blades, ns, -1, ns).sum(axis=2)
    same = jnp.eye(m)[:, :, None] * relative_speed
    recambered = summed(all_panels[:, None, :, None, :] * same[:, None])
    matrix = jnp.eye(size) + coupled.reshape(size, size)
    right = jnp.column_stack([by_onset.ravel(), recambered.reshape(size, size)])
    unit = jnp.linalg.solve(matrix, -right)
    return unit[:, 0].reshape(m, ns), unit[:, 1:]

"""Lattice held to the polars at several places of the turn at once, and the forces on its blade.

The places are the azimuths of a period, or in a march the blades at one moment: equally spaced, as
many as the blades or a multiple; or one, where all blades are alike.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import segment_circulation
from propmdao.aerodynamics.sections.laws import SectionLaws, ViscousSections, section_laws
from propmdao.aerodynamics.sections.period_recambering import (
    HeldPeriod,
    PeriodFlow,
    solve_period_recambering,
)
from propmdao.aerodynamics.sections.recambering import SectionStates, unheld_states
from propmdao.aerodynamics.solutions.lattice_loads import LatticeGeometry, profile_drag
from propmdao.aerodynamics.solutions.period.lattice import PeriodLattice, at_the_blades
from propmdao.aerodynamics.solutions.period.onset import PeriodOnset
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime import linear_algebra


@record
class HeldLattice:
    """Circulation of a lattice that is held to the polars.

    Attributes
    ----------
    circulation : (n, n_panels) array
        Circulation of the rings [m^2/s].
    strips : (n, ns) array
        Circulation of the strips [m^2/s].
    recambering : (n, ns) array
        Recambering of the sections, 0 in inviscid flow [rad].
    by_lattice, by_motion : SectionStates
        Flow, lift and drag of the sections by the lattice, and by the motion of the blade where the
        air comes from behind.
    """

    circulation: Array
    strips: Array
    recambering: Array
    by_lattice: SectionStates
    by_motion: SectionStates


def onset_laws(
    lattice: LatticeGeometry, onset: PeriodOnset, air: Air, sections: ViscousSections
) -> SectionLaws:
    """Polars of the strips at all places, with a leading axis.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    onset : PeriodOnset
        Air that meets the blade before its vortices act.
    air : Air
        The undisturbed air.
    sections : ViscousSections
        Polars that the lattice is held to.

    Returns
    -------
    SectionLaws
        The polars.
    """
    strips = lattice.strips
    return jax.vmap(lambda speed: section_laws(strips, speed, onset.turning_share, air, sections))(
        onset.relative_speed
    )


def held_lattice(
    lattice: PeriodLattice,
    inverse: Array,
    onset: PeriodOnset,
    normalwash: Array,
    by_strips: Array,
    laws: SectionLaws | None,
    start: Array | None = None,
) -> HeldLattice:
    """Solve for the circulation.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    inverse : (n_blades, n_panels, n_panels) array
        Circulation of the rings per normalwash, see `bound_inverse` [m].
    onset : PeriodOnset
        Air that meets the blade before its vortices act.
    normalwash : (n, n_panels) array
        Normalwash by this air, and by a wake that is known [m/s].
    by_strips : (n, n, ns, n_panels) array
        Normalwash at a place (first axis) by the wake, per circulation of the strips at another
        [1/m].
    laws : SectionLaws or None
        Polars by `onset_laws`; None for inviscid flow.
    start : (n, ns) array, optional
        Recambering from which the search for it starts [rad]; by default none.

    Returns
    -------
    HeldLattice
        The circulation, and the flow of the sections.
    """
    n_blades = inverse.shape[0]
    n, ns = onset.relative_speed.shape
    # The last rings carry the circulation of their whole strip, and the wake that of the strips.
    flow = PeriodFlow(
        lattice.lattice.strips,
        onset.relative_speed,
        onset.attached,
        onset.motion_angle,
        *_strip_circulation(inverse[:, -ns:], normalwash, by_strips, onset.relative_speed),
    )
    none = jnp.zeros((n, ns))
    if laws is None:
        states = unheld_states(flow)
        held = HeldPeriod(none, states, states)
    else:
        held = solve_period_recambering(flow, laws, none if start is None else start)
    strips = flow.circulation + (flow.response @ held.recambering.ravel()).reshape(n, ns)
    by_recambering = onset.relative_speed * held.recambering
    normalwash += jnp.tile(by_recambering, (1, normalwash.shape[1] // ns))
    normalwash += jnp.einsum("kqsp,qs->kp", by_strips, strips)
    circulation = -jnp.einsum("bpr,bkr->kp", inverse, at_the_blades(normalwash, n_blades))
    return HeldLattice(circulation, strips, *held)


def velocity_by_air_and_blades(
    lattice: PeriodLattice, onset: PeriodOnset, circulation: Array
) -> Array:
    """Velocity at the segments of blade 1 without that by the wake.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    onset : PeriodOnset
        Air that meets the blade before its vortices act.
    circulation : (n, n_panels) array
        Circulation of the rings [m^2/s].

    Returns
    -------
    (n, 3, n_segments) array
        Velocity [m/s].
    """
    n_blades, n_panels = lattice.influence.shape[0], circulation.shape[1]
    return onset.velocity[:, :, n_panels:] + jnp.einsum(
        "bcrp,bkr->kcp", lattice.influence[..., n_panels:], at_the_blades(circulation, n_blades)
    )


def blade_forces(
    lattice: PeriodLattice,
    onset: PeriodOnset,
    velocity: Array,
    held: HeldLattice,
    rate: Array,
    density: Scalar,
) -> Array:
    """Force on the blade, in its frame.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.
    onset : PeriodOnset
        Air that meets the blade before its vortices act.
    velocity : (n, 3, n_segments) array
        Velocity at the segments [m/s].
    held : HeldLattice
        Circulation, and flow of the sections.
    rate : (n, n_panels) array
        Rate of the circulation of the rings [m^2/s^2].
    density : float
        Density of the air [kg/m^3].

    Returns
    -------
    (n, n_points, 3) array
        Kutta-Joukowski on the segments, Bernoulli's unsteady term on the rings, profile drag on the
        sections [N].
    """
    strips, segment = lattice.lattice.strips, lattice.lattice.segment
    n, ns = onset.relative_speed.shape
    strength = jax.vmap(segment_circulation)(held.circulation.reshape(n, -1, ns))
    lift = density * strength[..., None] * jnp.cross(velocity.swapaxes(1, 2), segment)
    unsteady = density * rate[..., None] * lattice.ring_area

    def drag(states: SectionStates) -> Array:
        return jax.vmap(lambda at: profile_drag(strips, at, density))(states)

    share = onset.attached[..., None]
    profile = share * drag(held.by_lattice) + (1.0 - share) * drag(held.by_motion)
    return jnp.concatenate([lift, unsteady, profile], axis=1)


def _strip_circulation(
    inverse: Array, normalwash: Array, by_strips: Array, relative_speed: Array
) -> tuple[Array, Array]:
    """Circulation of the strips at all places, and its change per recambering.

    Parameters
    ----------
    inverse : (n_blades, ns, n_panels) array
        Rows of `bound_inverse` that belong to the last rings.
    normalwash : (n, n_panels) array
        Normalwash by the air that meets the blade, and by a wake that is known.
    by_strips : (n, n, ns, n_panels) array
        Normalwash by the wake, per circulation of the strips.
    relative_speed : (n, ns) array
        Speed of the air relative to the sections.

    Returns
    -------
    circulation, response : (n, ns), (n * ns, n * ns) arrays
        Circulation, and response as in `PeriodFlow`.
    """
    (n, ns), n_blades = relative_speed.shape, inverse.shape[0]
    numbers = jnp.arange(n)

    def summed(of_blade: Array) -> Array:
        """Sum over the blades of what is felt there, at the places of blade 1."""
        step = n // n_blades
        felt = [jnp.roll(of_blade[b], -step * b, axis=0) for b in range(n_blades)]
        return jnp.stack(felt).sum(axis=0)

    by_onset = summed(jnp.einsum("bsp,kp->bks", inverse, normalwash))
    coupled = summed(jnp.einsum("bsp,kqtp->bksqt", inverse, by_strips))
    # A recambering of 1 is a normalwash W on all panels of its strip.
    all_panels = inverse.reshape(n_blades, ns, -1, ns).sum(axis=2)
    same = jnp.zeros((n_blades, n, ns, n, ns))
    same = same.at[:, numbers, :, numbers].set(all_panels[None] * relative_speed[:, None, None, :])
    size = n * ns
    matrix = jnp.eye(size) + coupled.reshape(size, size)
    right = jnp.column_stack([by_onset.ravel(), summed(same).reshape(size, size)])
    unit = linear_algebra.solve(matrix, -right)
    return unit[:, 0].reshape(n, ns), unit[:, 1:]

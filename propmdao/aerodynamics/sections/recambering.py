"""The lattice held to the lift that its sections have in viscous flow.

Each strip may meet the air at an angle other than its geometry's, by its recambering delta: a
normalwash W delta more on its panels, the decambering of Mukherjee and Gopalarathnam (J. Aircraft
43, 2006) with the opposite sign. The circulation is linear in it, Gamma = Gamma_0 + S delta. With

    alpha = Gamma / (pi c W) + alpha_0 - delta      effective angle of attack,
    R     = 2 Gamma / (W c) - cl(alpha, Re, M) = 0  lift of lattice and polar,

a polar with the lift cl_p = 2 pi (alpha - alpha_0) of thin-airfoil theory needs no recambering at
all: the inviscid lattice is a limit of this one, exactly. W is the resultant of rotation, flight
and induced velocity at the disk.

What the polar takes off the lift of thin-airfoil theory enters as its mean over the span nearby
(`section_laws`), which leaves one solution on any mesh.
"""

from __future__ import annotations

from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.laws import SectionLaws
from propmdao.records.pytrees import record
from propmdao.runtime import linear_algebra

_TOLERANCE = 1.0e-9  # in the lift coefficient
_MAX_STEPS = 60
_LONGEST_STEP = np.radians(8.0)
# Fractions of a Newton step that are tried: the polars bend sharply near stall.
_FRACTIONS = 0.5 ** np.arange(7)


@record
class SectionStates:
    """How the sections of blade 1 work, one value per strip.

    Attributes
    ----------
    relative_speed : (ns,) array
        W, speed of the air relative to the section [m/s].
    angle_of_attack : (ns,) array
        Effective angle of attack, from the chord line [rad].
    lift_coefficient, drag_coefficient : (ns,) arrays
        Lift and drag coefficients of the section; without polars the lift is the lattice's and
        the drag 0.
    borrowed_lift : (ns,) array
        Lift coefficient that the mean over the span nearby adds to what the section's own polar
        has at its angle of attack.
    residual : (ns,) array
        Lift coefficient of the lattice less that of the polar: 0 where they agree.
    """

    relative_speed: Array
    angle_of_attack: Array
    lift_coefficient: Array
    drag_coefficient: Array
    borrowed_lift: Array
    residual: Array


@record
class StripFlow:
    """Strips of the lattice at an operating point, linear in their recambering.

    Attributes
    ----------
    strips : Strips
        Sections of blade 1.
    relative_speed : (ns,) array
        W, speed of the air relative to the section [m/s].
    circulation : (ns,) array
        Circulation of the strips without recambering [m^2/s].
    response : (ns, ns) array
        Change of each strip's circulation per radian of each strip's recambering [m^2/s].
    """

    strips: Strips
    relative_speed: Array
    circulation: Array
    response: Array

    def angle_and_lift(self, recambering: Array) -> tuple[Array, Array]:
        """Angle of attack [rad] and lift coefficient of the lattice, (ns,) each."""
        circulation = self.circulation + self.response @ recambering
        speed_chord = self.relative_speed * self.strips.chord
        alpha = circulation / (jnp.pi * speed_chord) + self.strips.zero_lift_angle - recambering
        return alpha, 2.0 * circulation / speed_chord


def section_states(flow: StripFlow, recambering: Array, laws: SectionLaws | None) -> SectionStates:
    """How the sections work with a given recambering.

    Parameters
    ----------
    flow : StripFlow
        Strips of the lattice at an operating point.
    recambering : (ns,) array
        Recambering of each strip [rad].
    laws : SectionLaws or None
        Polars of the strips; None takes the lift of the lattice, and no drag.

    Returns
    -------
    SectionStates
        Flow of the sections, and the residual that the recambering has to bring to zero.
    """
    alpha, lift = flow.angle_and_lift(recambering)
    held, cd, borrowed = lift, jnp.zeros_like(lift), jnp.zeros_like(lift)
    if laws is not None:
        more, cd = laws.beyond_thin(alpha)
        borrowed = laws.mean @ more - more
        held = laws.thin(alpha) + laws.mean @ more
    return SectionStates(flow.relative_speed, alpha, held, cd, borrowed, lift - held)


def solve_recambering(flow: StripFlow, laws: SectionLaws) -> Array:
    """Recambering that brings lattice and polars to the same lift.

    Damped Newton steps, always from no recambering, so that the answer does not depend on what was
    computed before. Derivatives are those of the implicit function.

    Parameters
    ----------
    flow : StripFlow
        Strips of the lattice at an operating point.
    laws : SectionLaws
        Polars of the strips at the operating point.

    Returns
    -------
    (ns,) array
        Recambering of each strip [rad]; where the search fails, the last one tried, whose residual
        is not 0.
    """
    fixed_flow, fixed_laws = jax.lax.stop_gradient((flow, laws))
    ns = flow.circulation.size
    fractions = jnp.asarray(_FRACTIONS)[:, None]

    def residual(delta: Array) -> Array:
        return _residual(fixed_flow, fixed_laws, delta)

    def unfinished(state: _Newton) -> Array:
        return (state.n_trials < _MAX_STEPS) & (jnp.abs(state.missing).max() > _TOLERANCE)

    def step(state: _Newton) -> _Newton:
        delta = state.recambering
        missing, slope = _residual_and_slope(fixed_flow, fixed_laws, delta)
        newton = -linear_algebra.solve(slope, missing)
        newton = newton * jnp.minimum(1.0, _LONGEST_STEP / jnp.abs(newton).max())
        trials = delta + fractions * newton
        best = jnp.argmin((jax.vmap(residual)(trials) ** 2).sum(axis=1))
        settled = jnp.abs(missing).max() <= _TOLERANCE
        return _Newton(state.n_trials + 1, jnp.where(settled, delta, trials[best]), missing, slope)

    start = _Newton(0, jnp.zeros(ns), jnp.full(ns, jnp.inf), jnp.eye(ns))
    end = jax.lax.while_loop(unfinished, step, start)
    # One more Newton step, in which alone the arguments count: its slope is that of the solution.
    delta, slope = jax.lax.stop_gradient((end.recambering, end.slope))
    return delta - linear_algebra.solve(slope, _residual(flow, laws, delta))


class _Newton(NamedTuple):
    """State of Newton's method."""

    n_trials: Array | int
    recambering: Array
    missing: Array
    slope: Array


def _residual(flow: StripFlow, laws: SectionLaws, recambering: Array) -> Array:
    """Lift coefficient of the lattice less that of the polars: (ns,)."""
    alpha, lift = flow.angle_and_lift(recambering)
    return lift - laws.thin(alpha) - laws.mean @ laws.beyond_thin(alpha)[0]


def _residual_and_slope(
    flow: StripFlow, laws: SectionLaws, recambering: Array
) -> tuple[Array, Array]:
    """Residual and its slope: (ns,), (ns, ns)."""
    alpha, lift = flow.angle_and_lift(recambering)
    # A section's lift depends on its own angle alone: one direction gives all slopes.
    (more, _), (by_alpha, _) = jax.jvp(laws.beyond_thin, (alpha,), (jnp.ones_like(alpha),))
    held_slope = 2.0 * jnp.pi * jnp.eye(alpha.size) + laws.mean * by_alpha
    per_circulation = 1.0 / (flow.relative_speed * flow.strips.chord)[:, None]
    angle_slope = per_circulation / jnp.pi * flow.response - jnp.eye(alpha.size)
    slope = 2.0 * per_circulation * flow.response - held_slope @ angle_slope
    return lift - laws.thin(alpha) - laws.mean @ more, slope

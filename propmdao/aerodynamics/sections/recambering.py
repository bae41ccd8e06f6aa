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

from typing import NamedTuple, Protocol

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


class SectionFlow(Protocol):
    """Strips of a lattice, at an operating point or around a turn."""

    @property
    def relative_speed(self) -> Array:
        """Speed of the air relative to the sections [m/s]."""

    @property
    def circulation(self) -> Array:
        """Circulation of the strips without recambering [m^2/s]."""

    def angle_and_lift(self, recambering: Array) -> tuple[Array, Array]:
        """Angle of attack [rad] and lift coefficient of the lattice."""


def unheld_states(flow: SectionFlow) -> SectionStates:
    """How the sections work without polars: with the lift of the lattice, and no drag.

    Parameters
    ----------
    flow : SectionFlow
        Strips of the lattice.

    Returns
    -------
    SectionStates
        Flow of the sections.
    """
    alpha, lift = flow.angle_and_lift(jnp.zeros_like(flow.circulation))
    none = jnp.zeros_like(lift)
    return SectionStates(flow.relative_speed, alpha, lift, none, none, none)


def solve_recambering(flow: StripFlow, laws: SectionLaws) -> tuple[Array, SectionStates]:
    """Recambering that brings lattice and polars to the same lift, and how the sections work then.

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
    recambering : (ns,) array
        Recambering of each strip [rad]; where the search fails, the last one tried, whose residual
        is not 0.
    states : SectionStates
        Flow of the sections.
    """
    fixed_flow, fixed_laws = jax.lax.stop_gradient((flow, laws))
    ns = flow.circulation.size
    fractions = jnp.asarray(_FRACTIONS)[:, None]

    def trial(delta: Array) -> Trial:
        alpha, lift = fixed_flow.angle_and_lift(delta)
        # A section's lift depends on its own angle alone: one direction gives all slopes.
        at, by_alpha = jax.jvp(fixed_laws.beyond_thin, (alpha,), (jnp.ones_like(alpha),))
        return Trial(delta, _missing(fixed_laws, alpha, lift, at[0]), *by_alpha)

    def unfinished(state: tuple[Array | int, Trial]) -> Array:
        n_trials, best = state
        left = jnp.abs(best.missing).max() > _TOLERANCE
        return (n_trials == 0) | (n_trials < _MAX_STEPS) & left

    def step(state: tuple[Array | int, Trial]) -> tuple[Array | int, Trial]:
        n_trials, best = state
        newton = -linear_algebra.solve(_slope(fixed_flow, fixed_laws, best), best.missing)
        newton = newton * jnp.minimum(1.0, _LONGEST_STEP / jnp.abs(newton).max())
        trials = jax.vmap(trial)(best.recambering + fractions * newton)
        closest = jnp.argmin((trials.missing**2).sum(axis=1))
        return n_trials + 1, jax.tree.map(lambda of_trials: of_trials[closest], trials)

    # Nothing is missing yet: the first step goes nowhere, and looks at no recambering.
    none = jnp.zeros(ns)
    start: tuple[Array | int, Trial] = (0, Trial(none, none, none, none))
    _, best = jax.lax.while_loop(unfinished, step, start)
    best = jax.lax.stop_gradient(best)
    # One more Newton step, in which alone the arguments count: its slope is that of the solution.
    # It is so short that the polars are straight along it.
    alpha, lift = flow.angle_and_lift(best.recambering)
    more, cd = laws.beyond_thin(alpha)
    missing = _missing(laws, alpha, lift, more)
    newton = -linear_algebra.solve(_slope(fixed_flow, fixed_laws, best), missing)
    settled = jnp.abs(best.missing).max() <= _TOLERANCE
    recambering = best.recambering + jnp.where(settled, newton, 0.0)
    end, lift = flow.angle_and_lift(recambering)
    more += best.more_by_alpha * (end - alpha)
    cd += best.cd_by_alpha * (end - alpha)
    near = laws.mean @ more
    held = laws.thin(end) + near
    return recambering, SectionStates(
        flow.relative_speed, end, held, cd, borrowed_lift=near - more, residual=lift - held
    )


class Trial(NamedTuple):
    """Recambering that is tried, and what it leaves missing.

    Attributes
    ----------
    recambering : array
        Recambering of each strip [rad].
    missing : array
        Lift coefficient of the lattice less that of the polars.
    more_by_alpha, cd_by_alpha : arrays
        Slopes of what the polars add to the lift of thin-airfoil theory, and of drag [1/rad].
    """

    recambering: Array
    missing: Array
    more_by_alpha: Array
    cd_by_alpha: Array


def _missing(laws: SectionLaws, alpha: Array, lift: Array, more: Array) -> Array:
    """Lift coefficient of the lattice less that of the polars: (ns,)."""
    return lift - laws.thin(alpha) - laws.mean @ more


def _slope(flow: StripFlow, laws: SectionLaws, trial: Trial) -> Array:
    """Slope of the lift that is missing with the recambering: (ns, ns)."""
    identity = jnp.eye(trial.recambering.size)
    held_slope = 2.0 * jnp.pi * identity + laws.mean * trial.more_by_alpha
    per_circulation = 1.0 / (flow.relative_speed * flow.strips.chord)[:, None]
    angle_slope = per_circulation / jnp.pi * flow.response - identity
    return 2.0 * per_circulation * flow.response - held_slope @ angle_slope

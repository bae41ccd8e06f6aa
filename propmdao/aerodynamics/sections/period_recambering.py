"""The lattice of a whole period held to the lift that its sections have in viscous flow.

The equations are those of `recambering`, of every strip at every azimuth, solved together: by the
wake each strip acts on all others at all azimuths, and where the retreating side stalls, one
azimuth after the other finds no solution.

Where the air comes from behind, the angle alpha = Gamma / (pi c W) + alpha_0 - delta of the lattice
means nothing. There the angle follows from how the section moves and from the induced velocity at
the disk, alpha = atan2(U_n, U_t) in the axes of its chord, which the polars know up to 180 deg, and
the mean over the span is left out. It counts from a share U_t / W of the tangential speed below
`_REVERSED`, relative to that of the mean over a turn, so that axial flight never has any.
Attached flow that changes in time needs nothing of its own: the lattice has it. Dynamic stall is
not modelled.
"""

from __future__ import annotations

from operator import itemgetter
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.sections.laws import SectionLaws
from propmdao.aerodynamics.sections.recambering import SectionStates, Trial
from propmdao.records.pytrees import record
from propmdao.runtime import linear_algebra

_TOLERANCE = 1.0e-9  # in the lift coefficient
_LONGEST_STEP = np.radians(15.0)
# First pseudo-time step, in times in which a thin section settles, of one attempt after the other,
# the steps of an attempt, and how much faster the time falls than it grows.
_FIRST_TIMES = 2.0, 0.5, 0.1
_MAX_STEPS = 60
_FALL, _LEAST_FALL = 1.5, 0.05
# Share of the tangential speed at which lattice and motion count half each for the angle of attack,
# and half of the width over which one takes over from the other.
_REVERSED, _BLEND = 0.2, 0.1


@record
class PeriodFlow:
    """Strips of the lattice at all azimuths, linear in their recambering.

    Attributes
    ----------
    strips : Strips
        Sections of blade 1.
    relative_speed : (n_azimuths, ns) array
        W, speed of the air relative to the sections [m/s].
    attached : (n_azimuths, ns) array
        Share of the lattice in the angle of attack: 1, and 0 where the air comes from behind.
    motion_angle : (n_azimuths, ns) array
        Angle of attack by the motion of the section and the induced velocity at the disk [rad].
    circulation : (n_azimuths, ns) array
        Circulation of the strips without recambering [m^2/s].
    response : (n_azimuths * ns, n_azimuths * ns) array
        Change of the circulation of each strip at each azimuth per radian of recambering of each
        strip at each azimuth [m^2/s].
    """

    strips: Strips
    relative_speed: Array
    attached: Array
    motion_angle: Array
    circulation: Array
    response: Array

    def angle_and_lift(self, recambering: Array) -> tuple[Array, Array]:
        """Angle of attack [rad] and lift coefficient of the lattice, (n_azimuths, ns) each."""
        change = (self.response @ recambering.ravel()).reshape(recambering.shape)
        circulation = self.circulation + change
        speed_chord = self.relative_speed * self.strips.chord
        alpha = circulation / (jnp.pi * speed_chord) + self.strips.zero_lift_angle - recambering
        return alpha, 2.0 * circulation / speed_chord


def attached_share(tangential_share: Array) -> Array:
    """Share of the lattice in the angle of attack, smooth.

    Parameters
    ----------
    tangential_share : array
        Tangential share U_t / W of the speed, relative to that of the mean over a turn.

    Returns
    -------
    array
        1 in flow from ahead, 0 in flow from behind.
    """
    x = jnp.clip(0.5 + 0.5 * (tangential_share - _REVERSED) / _BLEND, 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


class HeldPeriod(NamedTuple):
    """Recambering of the strips at all azimuths, and how the sections work with it.

    Attributes
    ----------
    recambering : (n_azimuths, ns) array
        Recambering of each strip [rad]; where the search fails, the last one tried, whose residual
        is not 0.
    by_lattice, by_motion : SectionStates
        Flow of the sections, (n_azimuths, ns) each: with the angle of the lattice and with that of
        the motion, of which `attached` is the share of the first. The lift coefficient, what it
        borrows and the residual are those of both together.
    """

    recambering: Array
    by_lattice: SectionStates
    by_motion: SectionStates


def solve_period_recambering(flow: PeriodFlow, laws: SectionLaws, start: Array) -> HeldPeriod:
    """Recambering that brings lattice and polars to the same lift at every azimuth.

    Newton's method in pseudo-time: as if every recambering moved towards its root at the rate of a
    thin section, dx/dt = -R / (2 pi), in implicit steps that grow as the residual falls (switched
    evolution relaxation, Mulder and van Leer, J. Comput. Phys. 59, 1985). Past stall, plain Newton
    steps and those of a line search end in circles, for the residual has minima that are no roots.
    Where the residual rises again, the steps shrink faster than they had grown, so that a circle
    does not last; and where that does not help, another attempt begins with shorter ones.
    Derivatives are those of the implicit function.

    Parameters
    ----------
    flow : PeriodFlow
        Strips of the lattice at all azimuths.
    laws : SectionLaws
        Polars of the strips, with a leading axis of azimuths.
    start : (n_azimuths, ns) array
        Recambering at which the first attempt begins, 0 where nothing is known; all others begin
        at 0.

    Returns
    -------
    HeldPeriod
        Recambering, and the flow of the sections.
    """
    fixed_flow, fixed_laws = jax.lax.stop_gradient((flow, laws))
    shape = flow.circulation.shape
    # Where the air hardly moves, lift coefficients are large and recambering does little: residuals
    # count by circulation, and no step is too long where the angle is not that of the lattice.
    speed = fixed_flow.relative_speed
    weight = speed / speed.mean(axis=0)
    longest = _LONGEST_STEP / jnp.maximum(fixed_flow.attached, _LONGEST_STEP / 1.0e6)

    def norm(missing: Array) -> Array:
        return jnp.sqrt(((weight * missing) ** 2).mean())

    fixed_motion = _by_motion(fixed_flow, fixed_laws)

    def at(delta: Array) -> Trial:
        alpha, lift = fixed_flow.angle_and_lift(delta)
        # A section's lift depends on its own angle alone: one direction gives all slopes.
        (more, _), by_alpha = jax.jvp(
            lambda angle: _beyond_thin(fixed_laws, angle), (alpha,), (jnp.ones_like(alpha),)
        )
        held, _ = _held(fixed_flow, fixed_laws, alpha, more, fixed_motion)
        return Trial(delta, lift - held, *by_alpha)

    def slope_of(trial: Trial) -> Array:
        return _slope(fixed_flow, fixed_laws, trial.more_by_alpha)

    def settled(trial: Trial) -> Array:
        return jnp.abs(weight * trial.missing).max() <= _TOLERANCE

    def unfinished(state: _Newton) -> Array:
        return (state.n_trials < _MAX_STEPS * len(_FIRST_TIMES)) & ~settled(state.trial)

    def step(state: _Newton) -> _Newton:
        last = state.trial
        inertia = 2.0 * jnp.pi / state.time * jnp.diag(fixed_flow.attached.ravel())
        slope = slope_of(last) + inertia
        change = linear_algebra.solve(slope, last.missing.ravel()).reshape(shape)
        # Each strip by itself: one that has just stalled holds up no other.
        delta = last.recambering - jnp.clip(change, -longest, longest)
        following = state.n_trials + 1
        attempt = following // _MAX_STEPS
        afresh = following % _MAX_STEPS == 0
        trial = at(jnp.where(afresh, 0.0, delta))
        fall = norm(last.missing) / norm(trial.missing)
        time = state.time * jnp.where(fall > 1.0, fall, jnp.maximum(fall**_FALL, _LEAST_FALL))
        time = jnp.where(afresh, jnp.asarray(_FIRST_TIMES)[attempt], time)
        return _Newton(following, trial, time)

    # Mapped, so that the polars are compiled once for both.
    both = jax.lax.map(at, jnp.stack([jnp.zeros(shape), jax.lax.stop_gradient(start)]))
    at_none, begin = (jax.tree.map(itemgetter(k), both) for k in range(2))
    # What is near the root already moves on as if it had begun at no recambering.
    time = _FIRST_TIMES[0] * norm(at_none.missing) / norm(begin.missing)
    end = jax.lax.while_loop(unfinished, step, _Newton(0, begin, time))
    last = jax.lax.stop_gradient(end.trial)
    # One more Newton step, in which alone the arguments count: its slope is that of the solution.
    # It is so short that the polars are straight along it.
    before, lift = flow.angle_and_lift(last.recambering)
    more, cd = _beyond_thin(laws, before)
    motion = _by_motion(flow, laws)
    missing = lift - _held(flow, laws, before, more, motion)[0]
    newton = -linear_algebra.solve(slope_of(last), missing.ravel()).reshape(shape)
    recambering = last.recambering + jnp.where(settled(last), newton, 0.0)
    alpha, lift = flow.angle_and_lift(recambering)
    more += last.more_by_alpha * (alpha - before)
    cd += last.cd_by_alpha * (alpha - before)
    held, borrowed = _held(flow, laws, alpha, more, motion)

    def states_of(angle: Array, drag: Array) -> SectionStates:
        return SectionStates(flow.relative_speed, angle, held, drag, borrowed, lift - held)

    return HeldPeriod(recambering, states_of(alpha, cd), states_of(flow.motion_angle, motion.drag))


class _Newton(NamedTuple):
    """State of Newton's method."""

    n_trials: Array | int
    trial: Trial
    time: Array


class _Motion(NamedTuple):
    """Coefficients by the angle of the motion, (n_azimuths, ns)."""

    lift: Array
    drag: Array


def _by_motion(flow: PeriodFlow, laws: SectionLaws) -> _Motion:
    more, cd = _beyond_thin(laws, flow.motion_angle)
    return _Motion(_thin(laws, flow.motion_angle) + more, cd)


def _beyond_thin(laws: SectionLaws, alpha: Array) -> tuple[Array, Array]:
    return jax.vmap(lambda at, angle: at.beyond_thin(angle))(laws, alpha)


def _thin(laws: SectionLaws, alpha: Array) -> Array:
    return 2.0 * jnp.pi * (alpha - laws.zero_lift_angle)


def _mean(flow: PeriodFlow, laws: SectionLaws) -> Array:
    """Means over the span of what flows from ahead, times the share of it: (n_azimuths, ns, ns)."""
    weight = laws.mean * flow.attached[:, None, :]
    total = weight.sum(axis=-1, keepdims=True)
    share = flow.attached[:, :, None]
    return share * weight / jnp.where(share > 0.0, total, 1.0)


def _held(
    flow: PeriodFlow, laws: SectionLaws, alpha: Array, more: Array, motion: _Motion
) -> tuple[Array, Array]:
    """Lift by the angle of the lattice and of the motion together, and what of it is borrowed."""
    share = flow.attached
    near = jnp.einsum("kij,kj->ki", _mean(flow, laws), more)
    held = share * _thin(laws, alpha) + near + (1.0 - share) * motion.lift
    return held, near - share * more


def _slope(flow: PeriodFlow, laws: SectionLaws, more_by_alpha: Array) -> Array:
    """Slope of the lift that is missing, a matrix of all strips at all azimuths."""
    (n, ns), size = more_by_alpha.shape, more_by_alpha.size
    held_slope = _mean(flow, laws) * more_by_alpha[:, None, :]
    held_slope += 2.0 * jnp.pi * flow.attached[:, :, None] * jnp.eye(ns)
    per_circulation = 1.0 / (flow.relative_speed * flow.strips.chord).reshape(-1, 1)
    angle_slope = per_circulation / jnp.pi * flow.response - jnp.eye(size)
    held_change = jnp.einsum("kij,kjm->kim", held_slope, angle_slope.reshape(n, ns, size))
    return 2.0 * per_circulation * flow.response - held_change.reshape(size, size)

"""Search for the rotation speed at which a thrust is met, whatever gives the thrust."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.solutions.roots import empty
from propmdao.records.pytrees import Scalar, record

_ROUNDING = 1.0e-13
_MAX_EVALUATIONS = 60
_NEARBY = 1.02  # of the rotation speed: the second point of a straight line


@record
class Bounds:
    """Rotation speeds between which the one that gives a thrust is looked for.

    Attributes
    ----------
    low, high : scalar
        Lowest and highest rotation speed of the search [rad/s].
    """

    low: Scalar
    high: Scalar


class Start(NamedTuple):
    """Where a search begins, and how the thrust rises with the rotation speed there."""

    rotation_speed: Array
    slope: Array | None = None  # None: the thrust rises as the rotation speed squared


class Search(NamedTuple):
    """State of a search; `low` and `high` are trials that enclose the root, infinite before."""

    n_trials: Array | int
    low: Array
    high: Array
    trial: Array
    last_trial: Array
    last_thrust: Array
    slope: Array  # through the last two trials
    results: Any
    reached: Array
    done: Array


def searched(
    thrust_at: Callable[[Array], tuple[Array, Any]],
    required: Array,
    bounds: Bounds,
    start: Start,
    tolerance: float,
) -> Search:
    """Search for a rotation speed, with the results on the straight line there.

    The next trial comes from CT, which is nearly a straight line in J, drawn through the last two
    trials. Where that leaves the bracket, the bracket is halved. A bound is tried only where a
    trial would lie beyond it; where the thrust lies beyond it, too, the search ends there.

    Parameters
    ----------
    thrust_at : callable
        ``thrust_at(rotation_speed)`` returns the thrust [N], which rises with the rotation speed,
        and the results computed on the way to it, any pytree of floats.
    required : float
        Thrust required [N].
    bounds : Bounds
        Lowest and highest rotation speed of the search.
    start : Start
        Where the search begins; outside of the bounds it begins at the nearer one.
    tolerance : float
        Largest product of the last two steps, relative to the rotation speed squared.

    Returns
    -------
    Search
        The end of the search: rotation speed (`trial`), results there, whether the thrust is
        `reached`, and the slope through the last two trials.
    """
    bottom, top = jnp.asarray(bounds.low), jnp.asarray(bounds.high)

    def unfinished(state: Search) -> Array:
        return (state.n_trials < _MAX_EVALUATIONS) & ~state.done

    def step(state: Search) -> Search:
        x, first = state.trial, state.n_trials == 0
        thrust, results = thrust_at(x)
        last = jnp.where(first, _NEARBY * x, state.last_trial)
        if start.slope is None:
            rise = (_NEARBY**2 - 1.0) * jnp.maximum(jnp.abs(thrust), jnp.abs(required))
        else:
            rise = (_NEARBY - 1.0) * x * start.slope
        last_thrust = jnp.where(first, thrust + rise, state.last_thrust)
        enough = ~(thrust <= required)
        low, high = jnp.where(enough, state.low, x), jnp.where(enough, x, state.high)
        out_of_reach = (enough & (x == bottom)) | ((thrust < required) & (x == top))

        wanted = _where_linear_ct_gives(required, x, thrust, last, last_thrust)
        within = jnp.clip(wanted, bottom, top)  # a bound has been tried once `low` or `high` is one
        inside = (within > low) & (within < high)
        # At the root rounding may put the next trial to the wrong side.
        there = jnp.abs(wanted - x) < _ROUNDING * x
        middle = 0.5 * (jnp.maximum(low, bottom) + jnp.minimum(high, top))
        following = jnp.where(there, wanted, jnp.where(inside, within, middle))
        # A secant step leaves an error of about the product of the last two.
        product = jnp.abs((following - x) * (x - last))
        close = (following == wanted) & ~first & (product <= tolerance * following**2)
        reached = close | (thrust == required)
        following = jnp.where(thrust == required, x, following)
        share = (following - x) / (x - last)
        results = jax.tree.map(
            lambda at, then: jnp.where(close, at + share * (at - then), at), results, state.results
        )
        return Search(
            n_trials=state.n_trials + 1,
            low=low,
            high=high,
            trial=following,
            last_trial=x,
            last_thrust=thrust,
            slope=(thrust - last_thrust) / (x - last),
            results=results,
            reached=reached,
            done=reached | out_of_reach,
        )

    trial = jnp.clip(start.rotation_speed, bottom, top)
    zero, no = jnp.zeros_like(trial), jnp.full_like(trial, False, bool)
    begin = Search(
        n_trials=0,
        low=jnp.full_like(trial, -jnp.inf),
        high=jnp.full_like(trial, jnp.inf),
        trial=trial,
        last_trial=zero,
        last_thrust=zero,
        slope=zero,
        results=empty(thrust_at, trial)[1],
        reached=no,
        done=no,
    )
    return jax.lax.while_loop(unfinished, step, begin)


def _where_linear_ct_gives(thrust: Scalar, x1: Array, t1: Array, x2: Array, t2: Array) -> Array:
    """Rotation speed for a thrust when T / Omega^2 = a + b / Omega holds through two points."""
    u1, u2 = 1.0 / x1, 1.0 / x2
    c1, c2 = t1 * u1**2, t2 * u2**2
    b = (c1 - c2) / (u1 - u2)
    a = c1 - b * u1
    # T u^2 = a + b u, in the form that also holds for T = 0.
    return (-b + jnp.sqrt(b * b + 4.0 * thrust * a)) / (2.0 * a)

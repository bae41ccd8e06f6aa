"""Rotation speed at which the thrust is the one required, for any solver of the loads."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, NamedTuple, Protocol

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.aerodynamics.solutions.roots import at_root, empty
from propmdao.records.pytrees import Scalar, record
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

# Of the product of the last two steps, relative to the rotation speed squared: the results at the
# root lie on the straight line through the last two trials, to less than that.
_TOLERANCE = 1.0e-13
_ROUGH_TOLERANCE = 1.0e-4
_ROUNDING = 1.0e-13
_MAX_EVALUATIONS = 60
_NEARBY = 1.02  # of the rotation speed: the second point of a straight line

# Tip speeds between which a rotation speed is looked for where nobody bounds it [m/s]: that of the
# rotation at least, a hundredth of the speed of sound, and that of the air at most, nine tenths.
LEAST_TIP_SPEED, LARGEST_TIP_SPEED = 3.40294, 306.2646


class TrimError(ValueError):
    """No rotation speed between the bounds gives the required thrust."""


class Solver(Protocol):
    """Functions that a trim needs of a solver, a module as `solutions.axial` or `periodic`."""

    def solve(self, case: RotorCase) -> RotorLoads | TiltedLoads:
        """Return the loads at the rotation speed of the case."""

    def flow_at(self, case: RotorCase) -> Any:
        """Return what does not change with the rotation speed, a pytree of floats."""

    def rough(self, flow: Any, thrust_required: Scalar, rotation_speed: Scalar) -> Array:
        """Return about the thrust of a trial [N], at a small part of its cost."""

    def evaluate(
        self, flow: Any, thrust_required: Scalar, rotation_speed: Scalar
    ) -> tuple[Array, Any]:
        """Return the thrust of a trial [N], exact at the solution, and a pytree of floats."""

    def solution(
        self, flow: Any, thrust_required: Scalar, rotation_speed: Scalar, results: Any
    ) -> RotorLoads | TiltedLoads:
        """Return the loads from the second thing that `evaluate` returned."""


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


@record
class Trimmed:
    """A rotor at the thrust required of it.

    Attributes
    ----------
    rotation_speed : scalar
        Rotation speed that gives the thrust, exactly differentiable [rad/s]; it means nothing
        where the thrust was not reached.
    reached : bool
        Whether a rotation speed between the bounds gives the thrust.
    loads : RotorLoads or TiltedLoads
        Loads at that rotation speed.
    """

    rotation_speed: Array
    reached: Array
    loads: RotorLoads | TiltedLoads


def rotation_bounds(radius: Scalar, speed: Scalar) -> Bounds:
    """Rotation speeds between which a subsonic propeller is looked for.

    Parameters
    ----------
    radius : float
        Tip radius [m].
    speed : float
        Axial flight speed [m/s].

    Returns
    -------
    Bounds
        Lowest and highest rotation speed; the upper one is 0 where the flight alone is too fast,
        which `require_bounds` refuses.
    """
    highest = jnp.sqrt(jnp.maximum(LARGEST_TIP_SPEED**2 - speed**2, 0.0))
    return Bounds(LEAST_TIP_SPEED / radius, highest / radius)


def require_bounds(bounds: Bounds, speed: Scalar) -> None:
    """Refuse bounds that enclose nothing; call it outside ``jit``.

    Parameters
    ----------
    bounds : Bounds
        Lowest and highest rotation speed, as the user gives them or by `rotation_bounds`.
    speed : float
        Axial flight speed [m/s].

    Raises
    ------
    TrimError
        If the flight speed alone is too high, or the bounds are not positive and rising.
    """
    if not speed < LARGEST_TIP_SPEED:
        raise TrimError(
            f"speed must be below {LARGEST_TIP_SPEED:g} m/s to trim; it is {float(speed):g}"
        )
    if not 0.0 < bounds.low < bounds.high:
        raise TrimError(
            "rpm bounds must be positive and increasing; they are "
            f"{float(bounds.low) / RAD_PER_S:g} and {float(bounds.high) / RAD_PER_S:g}"
        )


def trim(
    solver: Solver, case: RotorCase, thrust_required: float, bounds: Bounds
) -> tuple[float, RotorLoads | TiltedLoads]:
    """Solve for the rotation speed that gives the required thrust, and the loads there.

    Parameters
    ----------
    solver : Solver
        Module that solves for the loads, as `solutions.axial`.
    case : RotorCase
        Case to solve; its own rotation speed does not matter.
    thrust_required : float
        Thrust of all blades [N].
    bounds : Bounds
        Lowest and highest rotation speed of the search.

    Returns
    -------
    rotation_speed, loads : float, RotorLoads or TiltedLoads
        Rotation speed, to 1e-8 relative [rad/s], and the loads there.

    Raises
    ------
    TrimError
        The thrust required lies outside what the bounds give; the message has both ends.
    """
    require_bounds(bounds, case.state.speed)
    trimmed = solve_for_thrust(solver, case, float(thrust_required), bounds)
    require_reached(trimmed, solver, case, thrust_required, bounds)
    return float(trimmed.rotation_speed), trimmed.loads


def require_reached(
    trimmed: Trimmed, solver: Solver, case: RotorCase, thrust_required: Scalar, bounds: Bounds
) -> None:
    """Refuse a rotation speed that the bounds do not enclose; call it outside ``jit``.

    Parameters
    ----------
    trimmed : Trimmed
        Result of `solve_for_thrust`.
    solver, case, thrust_required, bounds
        Arguments that `solve_for_thrust` was called with.

    Raises
    ------
    TrimError
        The thrust required lies outside what the bounds give; the message has both ends.
    """
    if trimmed.reached:
        return
    ends = [
        _thrust_in_words(solver, case, end)
        for end in (np.float64(bounds.low), np.float64(bounds.high))  # one type, one program
    ]
    raise TrimError(
        f"thrust {float(thrust_required):g} N is out of reach at {float(case.state.speed):g} m/s: "
        + ", ".join(ends)
    )


def _thrust_in_words(solver: Solver, case: RotorCase, rotation_speed: np.float64) -> str:
    thrust = float(solver.solve(case.turning(rotation_speed)).thrust)
    words = f"{thrust:.4g} N" if np.isfinite(thrust) else "no solution"
    return f"{words} at {float(rotation_speed) / RAD_PER_S:g} rpm"


def rotation_speed_by_interpolation(
    solver: Solver, case: RotorCase, thrust_required: Scalar, bounds: Bounds
) -> Array:
    """Rotation speed by the thesis' rule: thrust linear between the two bounds.

    The rule misses the thrust, which is nearly a parabola, by up to 5 %; it is kept to show this.

    Parameters
    ----------
    solver : Solver
        Module that solves for the loads.
    case : RotorCase
        Case to solve; its own rotation speed does not matter.
    thrust_required : float
        Thrust of all blades [N].
    bounds : Bounds
        The two rotation speeds at which the thrust is computed.

    Returns
    -------
    float
        Rotation speed, extrapolated where it lies beyond the bounds [rad/s].
    """
    low, high = bounds.low, bounds.high
    # Mapped, so that the lattice is compiled once for both.
    at_low, at_high = jax.lax.map(
        lambda end: solver.solve(case.turning(end)).thrust, jnp.stack([low, high])
    )
    return low + (high - low) * (thrust_required - at_low) / (at_high - at_low)


@partial(compiled, static_argnames="solver")
def solve_for_thrust(
    solver: Solver, case: RotorCase, thrust_required: Scalar, bounds: Bounds
) -> Trimmed:
    """Rotation speed for a thrust, and the loads.

    The search begins where elements in uniform inflow have the thrust, and takes three or four
    trials.

    Parameters
    ----------
    solver : Solver
        Module that solves for the loads (static).
    case : RotorCase
        Case to solve; its own rotation speed does not matter.
    thrust_required : float
        Thrust of all blades [N].
    bounds : Bounds
        Lowest and highest rotation speed of the search.

    Returns
    -------
    Trimmed
        Rotation speed and loads, exactly differentiable in every argument but the bounds.
    """
    bounds = jax.tree.map(lambda bound: jnp.asarray(bound, float), bounds)
    flow = solver.flow_at(case.turning(bounds.low))

    def evaluate(params: Any, rotation_speed: Array) -> tuple[Array, Any]:
        flow, required, _ = params
        return solver.evaluate(flow, required, rotation_speed)

    def missing(params: Any, rotation_speed: Array, results: tuple[Array, Any]) -> Array:
        return params[1] - results[0]

    def search(params: Any) -> tuple[Array, tuple[Array, Any], Array]:
        flow, required, bounds = params

        def trial(rotation_speed: Array) -> tuple[Array, tuple[Array, Any]]:
            results = evaluate(params, rotation_speed)
            return results[0], results

        def rough(rotation_speed: Array) -> tuple[Array, tuple[()]]:
            return solver.rough(flow, required, rotation_speed), ()

        middle = jnp.sqrt(bounds.low * bounds.high)
        begun = _search(rough, required, bounds, _Start(middle), _ROUGH_TOLERANCE)
        end = _search(trial, required, bounds, _Start(begun.trial, begun.slope), _TOLERANCE)
        return end.trial, end.results, end.reached.astype(float)

    params = flow, jnp.asarray(thrust_required, float), bounds
    rotation_speed, (_, results), reached = at_root(search, evaluate, missing, params)
    loads = solver.solution(flow, params[1], rotation_speed, results)
    return Trimmed(rotation_speed, reached > 0.5, loads)


class _Start(NamedTuple):
    """Where a search begins, and how the thrust rises with the rotation speed there."""

    rotation_speed: Array
    slope: Array | None = None  # None: the thrust rises as the rotation speed squared


class _Search(NamedTuple):
    """State of a search."""

    n_trials: Array | int
    low: Array
    high: Array
    ends_tried: tuple[Array, Array]
    trial: Array
    last_trial: Array
    last_thrust: Array
    slope: Array  # through the last two trials
    results: Any
    reached: Array
    done: Array


def _search(
    thrust_at: Callable[[Array], tuple[Array, Any]],
    required: Array,
    bounds: Bounds,
    start: _Start,
    tolerance: float,
) -> _Search:
    """Rotation speed for a thrust, and the results on the straight line there.

    The next trial comes from CT, which is nearly a straight line in J, drawn through the last two
    trials. Where that leaves the bracket, the bracket is halved. A bound is tried only where a
    trial would lie beyond it; where the thrust lies beyond it, too, the search ends there.
    """
    bottom, top = jnp.asarray(bounds.low), jnp.asarray(bounds.high)

    def unfinished(state: _Search) -> Array:
        return (state.n_trials < _MAX_EVALUATIONS) & ~state.done

    def step(state: _Search) -> _Search:
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
        ends_tried = state.ends_tried[0] | (x == bottom), state.ends_tried[1] | (x == top)
        out_of_reach = (enough & (x == bottom)) | ((thrust < required) & (x == top))

        wanted = _where_linear_ct_gives(required, x, thrust, last, last_thrust)
        # At the root rounding may put the next trial to the wrong side.
        inside = ((wanted > low) & (wanted < high)) | (jnp.abs(wanted - x) < _ROUNDING * x)
        end = jnp.where(wanted < x, low, high)
        untried = jnp.where(wanted < x, ~ends_tried[0], ~ends_tried[1])
        is_bound = jnp.where(wanted < x, low == bottom, high == top) & jnp.isfinite(wanted)
        otherwise = jnp.where(is_bound & untried, end, 0.5 * (low + high))
        following = jnp.where(inside, wanted, otherwise)
        # A secant step leaves an error of about the product of the last two.
        product = jnp.abs((following - x) * (x - last))
        close = inside & ~first & (product <= tolerance * following**2)
        reached = close | (thrust == required)
        following = jnp.where(thrust == required, x, following)
        share = (following - x) / (x - last)
        results = jax.tree.map(
            lambda at, then: jnp.where(close, at + share * (at - then), at), results, state.results
        )
        return _Search(
            n_trials=state.n_trials + 1,
            low=low,
            high=high,
            ends_tried=ends_tried,
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
    begin = _Search(
        n_trials=0,
        low=bottom,
        high=top,
        ends_tried=(no, no),
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

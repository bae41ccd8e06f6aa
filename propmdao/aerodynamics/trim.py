"""Rotation speed at which the thrust is the one required, for any solver of the loads."""

from __future__ import annotations

from functools import partial
from typing import Any, Protocol

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.aerodynamics.solutions.roots import at_root
from propmdao.aerodynamics.thrust_search import Bounds, Start, searched
from propmdao.records.pytrees import Scalar, record
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

# Of the product of the last two steps, relative to the rotation speed squared: the results at the
# root lie on the straight line through the last two trials, to less than that.
_TOLERANCE = 1.0e-13
_ROUGH_TOLERANCE = 1.0e-4

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
        begun = searched(rough, required, bounds, Start(middle), _ROUGH_TOLERANCE)
        end = searched(trial, required, bounds, Start(begun.trial, begun.slope), _TOLERANCE)
        return end.trial, end.results, end.reached.astype(float)

    params = flow, jnp.asarray(thrust_required, float), bounds
    rotation_speed, (_, results), reached = at_root(search, evaluate, missing, params)
    loads = solver.solution(flow, params[1], rotation_speed, results)
    return Trimmed(rotation_speed, reached > 0.5, loads)

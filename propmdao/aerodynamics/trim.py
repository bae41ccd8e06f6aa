"""Rotation speed at which the thrust is the one required."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.solutions.axial import (
    Flow,
    flow_at,
    induced_velocity,
    loads_at,
    solve_steady,
    steady_solution,
)
from propmdao.aerodynamics.solutions.lattice_loads import LatticeLoads
from propmdao.aerodynamics.solutions.result import SteadySolution
from propmdao.aerodynamics.solutions.roots import at_root, empty
from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled

_TOLERANCE = 1.0e-10
_MAX_EVALUATIONS = 60
_RPM = 30.0 / np.pi
_Asked = tuple[Array, int, float, float, float, float, float, float, ViscousSections | None]
_Params = tuple[Flow, Array, tuple[Array, Array]]  # with the thrust required and the bounds


# Tip speeds between which a rotation speed is looked for where nobody bounds it [m/s]: that of the
# rotation at least, a hundredth of the speed of sound, and that of the air at most, nine tenths.
LEAST_TIP_SPEED, LARGEST_TIP_SPEED = 3.40294, 306.2646


class TrimError(ValueError):
    """No rotation speed between the bounds gives the required thrust."""


def rotation_bounds(radius: float, speed: float) -> tuple[float, float]:
    """Rotation speeds between which a subsonic propeller is looked for.

    Parameters
    ----------
    radius, speed : float
        Tip radius [m], axial flight speed [m/s].

    Returns
    -------
    low, high : float
        Bounds [rad/s].

    Raises
    ------
    TrimError
        The flight speed alone is too high.
    """
    if not speed < LARGEST_TIP_SPEED:
        raise TrimError(f"speed must be below {LARGEST_TIP_SPEED:g} m/s to trim; it is {speed:g}")
    return LEAST_TIP_SPEED / radius, float(np.sqrt(LARGEST_TIP_SPEED**2 - speed**2)) / radius


def rotation_speed_for_thrust(
    nodes: Array,
    n_blades: int,
    radius: float,
    speed: float,
    density: float,
    thrust_required: float,
    bounds: tuple[float, float],
    sections: ViscousSections | None = None,
) -> Array:
    """Solve for the rotation speed that gives the required thrust.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1 [m].
    n_blades : int
        Number of equally spaced blades.
    radius, speed, density, thrust_required : float
        Tip radius [m], axial flight speed [m/s], air density [kg/m^3], thrust of all blades [N].
    bounds : (float, float)
        Lowest and highest rotation speed [rad/s].
    sections : ViscousSections, optional
        Polars that the lattice is held to; without any the flow is inviscid.

    Returns
    -------
    float
        Rotation speed, to 1e-8 relative [rad/s].

    Raises
    ------
    TrimError
        The thrust required lies outside what the bounds give; the message has both ends.
    """
    asked = _asked(nodes, n_blades, radius, speed, density, thrust_required, bounds, sections)
    omega, missing = solve_rotation_speed(*asked)
    require_reached(omega, missing, *asked)
    return omega


def steady_for_thrust(
    nodes: Array,
    n_blades: int,
    radius: float,
    speed: float,
    density: float,
    thrust_required: float,
    bounds: tuple[float, float],
    sections: ViscousSections | None = None,
) -> tuple[Array, SteadySolution]:
    """Solve for the rotation speed that gives the required thrust, and the loads there.

    The last trial of the trim is the solution, so nothing is solved twice.

    Parameters
    ----------
    nodes, n_blades, radius, speed, density, thrust_required, bounds, sections
        As for `rotation_speed_for_thrust`.

    Returns
    -------
    rotation_speed, solution : float, SteadySolution
        Rotation speed [rad/s] and loads.

    Raises
    ------
    TrimError
        As `rotation_speed_for_thrust`.
    """
    asked = _asked(nodes, n_blades, radius, speed, density, thrust_required, bounds, sections)
    omega, missing, solution = solve_trimmed(*asked)
    require_reached(omega, missing, *asked)
    return omega, solution


def _asked(
    nodes: Array,
    n_blades: int,
    radius: float,
    speed: float,
    density: float,
    thrust: float,
    bounds: tuple[float, float],
    sections: ViscousSections | None,
) -> _Asked:
    """Arguments of the compiled trims, of one type each so that they compile once."""
    low, high = (float(bound) for bound in bounds)
    if not 0.0 < low < high:
        raise TrimError(
            "rpm bounds must be positive and increasing; "
            f"they are {low * _RPM:g} and {high * _RPM:g}"
        )
    operating = float(radius), float(speed), float(density), float(thrust)
    return nodes, n_blades, *operating, low, high, sections


def require_reached(
    rotation_speed: Scalar,
    missing: tuple[Scalar, Scalar],
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    speed: Scalar,
    density: Scalar,
    thrust_required: Scalar,
    low: Scalar,
    high: Scalar,
    sections: ViscousSections | None = None,
) -> None:
    """Refuse a rotation speed that the bounds do not enclose; call it outside ``jit``.

    Parameters
    ----------
    rotation_speed, missing : float, (float, float)
        Of `solve_rotation_speed` or `solve_trimmed`.
    nodes, n_blades, radius, speed, density, thrust_required, low, high, sections
        As these took them.

    Raises
    ------
    TrimError
        The thrust required lies outside what the bounds give; the message has both ends.
    """
    at_low, at_high = missing
    if at_low >= 0.0 >= at_high and np.isfinite(rotation_speed):
        return
    at = [
        float(solve_steady(nodes, n_blades, radius, end, speed, density, sections).thrust)
        for end in (low, high)
    ]
    raise TrimError(
        f"thrust {thrust_required:g} N is out of reach at {speed:g} m/s: "
        f"{at[0]:.4g} N at {low * _RPM:g} rpm, {at[1]:.4g} N at {high * _RPM:g} rpm"
    )


def rotation_speed_by_interpolation(
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    speed: Scalar,
    density: Scalar,
    thrust_required: Scalar,
    low: Scalar,
    high: Scalar,
    sections: ViscousSections | None = None,
) -> Array:
    """Rotation speed by the thesis' rule: thrust linear between the two bounds.

    Off by up to 5 % in thrust, which is nearly a parabola; kept to show by how much.

    Parameters
    ----------
    nodes, n_blades, radius, speed, density, thrust_required, sections
        As for `rotation_speed_for_thrust`.
    low, high : float
        The two rotation speeds at which the thrust is computed [rad/s].

    Returns
    -------
    float
        Rotation speed; beyond the two, an extrapolation [rad/s].
    """
    # Mapped, so that the lattice is compiled once for both.
    at_low, at_high = jax.lax.map(
        lambda end: solve_steady(nodes, n_blades, radius, end, speed, density, sections).thrust,
        jnp.stack([low, high]),
    )
    return low + (high - low) * (thrust_required - at_low) / (at_high - at_low)


@partial(compiled, static_argnames="n_blades")
def solve_rotation_speed(
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    speed: Scalar,
    density: Scalar,
    thrust_required: Scalar,
    low: Scalar,
    high: Scalar,
    sections: ViscousSections | None = None,
) -> tuple[Array, tuple[Array, Array]]:
    """Rotation speed for a thrust, and how much thrust is missing at either bound.

    The wake is transported by the induced velocity of the thrust required, which is that of
    the solution, so that one lattice solution a trial is enough; at any other rotation speed the
    thrust found this way errs, but never to the other side of the thrust required.

    Parameters
    ----------
    nodes, n_blades, radius, speed, density, thrust_required, sections
        As for `rotation_speed_for_thrust`.
    low, high : float
        Bounds [rad/s].

    Returns
    -------
    rotation_speed, missing : float, (float, float)
        The root, exactly differentiable, means nothing unless the thrust missing is positive
        at `low` and negative at `high` [rad/s], [N].
    """
    omega, missing, _ = solve_trimmed(
        nodes, n_blades, radius, speed, density, thrust_required, low, high, sections
    )
    return omega, missing


@partial(compiled, static_argnames="n_blades")
def solve_trimmed(
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    speed: Scalar,
    density: Scalar,
    thrust_required: Scalar,
    low: Scalar,
    high: Scalar,
    sections: ViscousSections | None = None,
) -> tuple[Array, tuple[Array, Array], SteadySolution]:
    """Rotation speed for a thrust, the thrust missing at either bound, and the loads.

    Parameters
    ----------
    nodes, n_blades, radius, speed, density, thrust_required, low, high, sections
        As `solve_rotation_speed` takes them.

    Returns
    -------
    rotation_speed, missing, solution : float, (float, float), SteadySolution
        As of `solve_rotation_speed`, and the loads at that rotation speed.
    """
    # The rotation speed in here is that of no trial yet.
    flow = flow_at(nodes, n_blades, radius, low, speed, density, sections)

    def at_speed(params: _Params, omega: Array) -> tuple[Flow, Array]:
        flow, required, _ = params
        flow = dataclasses.replace(flow, rotation_speed=omega)
        return flow, induced_velocity(flow, required)

    def loads(params: _Params, omega: Array) -> LatticeLoads:
        flow, w = at_speed(params, omega)
        return loads_at(flow, n_blades, w)

    def missing(params: _Params, omega: Array, loads: LatticeLoads) -> Array:
        return params[1] - n_blades * loads.thrust

    def solve(params: _Params) -> tuple[Array, LatticeLoads, tuple[Array, Array]]:
        _, required, (low, high) = params

        def trial(omega: Array) -> tuple[Array, LatticeLoads]:
            blade = loads(params, omega)
            return missing(params, omega, blade), blade

        return _bracketed_search(trial, required, low, high)

    bounds = (jnp.asarray(low, float), jnp.asarray(high, float))
    params = (flow, jnp.asarray(thrust_required, float), bounds)
    omega, blade, at_bounds = at_root(solve, loads, missing, params)
    flow, w = at_speed(params, omega)
    return omega, at_bounds, steady_solution(flow, n_blades, w, blade)


def _bracketed_search(
    missing: Callable[[Array], tuple[Array, LatticeLoads]],
    thrust: Scalar,
    low: Scalar,
    high: Scalar,
) -> tuple[Array, LatticeLoads, tuple[Array, Array]]:
    """Root of the missing thrust, the loads there and the thrust missing at either bound.

    Both bounds are evaluated first. Then CT, taken as a straight line in J through the last
    two trials, gives the next (it nearly is one); where that leaves the bracket, bisect. Three to
    six trials.
    """

    def unfinished(state: Any) -> Array:
        count, *_, (at_low, at_high), _, _, done = state
        bracketed = (count < 2) | ((at_low >= 0.0) & (at_high <= 0.0))
        return (count < _MAX_EVALUATIONS) & bracketed & ~done

    def step(state: Any) -> Any:
        count, lo, hi, x, (x1, f1), (at_low, at_high), _, last, _ = state
        f, loads = missing(x)
        at_low = jnp.where(count == 0, f, at_low)
        at_high = jnp.where(count == 1, f, at_high)
        lo, hi = jnp.where(f >= 0.0, x, lo), jnp.where(f < 0.0, x, hi)
        trial = _where_linear_ct_gives(thrust, x, thrust - f, x1, thrust - f1)
        inside = (trial > lo) & (trial < hi)
        following = jnp.where(inside | (f == 0.0), trial, 0.5 * (lo + hi))
        following = jnp.where(count == 0, high, following)
        # A secant step leaves an error of about the product of the last two. Where the next trial
        # will do, it is evaluated once more, for the loads there.
        product = jnp.abs((following - x) * (x - x1))
        close = (count > 1) & (product <= _TOLERANCE * following**2)
        following = jnp.where(last, x, following)
        return count + 1, lo, hi, following, (x, f), (at_low, at_high), loads, close, last

    zero, no = jnp.zeros_like(low), jnp.asarray(False)
    blank = empty(missing, low)[1]
    start: Any = (0, low, high, low, (zero, zero), (zero, zero), blank, no, no)
    _, _, _, omega, _, ends, loads, _, _ = jax.lax.while_loop(unfinished, step, start)
    return omega, loads, ends


def _where_linear_ct_gives(thrust: Scalar, x1: Array, t1: Array, x2: Array, t2: Array) -> Array:
    """Rotation speed for a thrust when T / Omega^2 = a + b / Omega holds through two points."""
    u1, u2 = 1.0 / x1, 1.0 / x2
    c1, c2 = t1 * u1**2, t2 * u2**2
    b = (c1 - c2) / (u1 - u2)
    a = c1 - b * u1
    # T u^2 = a + b u, in the form that also holds for T = 0.
    return (-b + jnp.sqrt(b * b + 4.0 * thrust * a)) / (2.0 * a)

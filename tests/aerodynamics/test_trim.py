"""Rotation speed for a required thrust, from any bounds, or a clear refusal."""

import types

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.trim import (
    LARGEST_TIP_SPEED,
    LEAST_TIP_SPEED,
    Bounds,
    TrimError,
    require_bounds,
    rotation_bounds,
    rotation_speed_by_interpolation,
    solve_for_thrust,
    trim,
)
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled


def bounds_of(low_rpm, high_rpm):
    return Bounds(low_rpm * RAD_PER_S, high_rpm * RAD_PER_S)


def trimmed(rotor, thrust, speed, low, high):
    return trim(axial, rotor.case(speed=speed), thrust, bounds_of(low, high))


def thrust_at(rotor, omega, speed):
    return float(axial.solve(rotor.case(float(omega), float(speed))).thrust)


@pytest.mark.parametrize("speed", [0.0, 8.0, 25.0])
@pytest.mark.parametrize("bounds", [(200.0, 25000.0), (1500.0, 12000.0)])
def test_thrust_is_met_from_any_bounds(slow_flyer, speed, bounds):
    omega, loads = trimmed(slow_flyer, 1.2, speed, *bounds)
    assert bounds[0] * RAD_PER_S < omega < bounds[1] * RAD_PER_S
    assert thrust_at(slow_flyer, omega, speed) == pytest.approx(1.2, rel=1e-7)
    assert float(loads.thrust) == pytest.approx(1.2, rel=1e-7)


def test_zero_thrust_is_found_between_windmilling_and_pulling(slow_flyer):
    omega, _ = trimmed(slow_flyer, 0.0, 8.0, 500.0, 9000.0)
    assert abs(thrust_at(slow_flyer, omega, 8.0)) < 1e-7


@pytest.mark.parametrize(("thrust", "end"), [(50.0, "5500 rpm"), (0.01, "3500 rpm")])
def test_thrust_out_of_reach_is_refused_with_what_the_bounds_give(slow_flyer, thrust, end):
    with pytest.raises(TrimError, match=f"thrust {thrust:g} N is out of reach.*{end}") as error:
        trimmed(slow_flyer, thrust, 0.0, 3500.0, 5500.0)
    assert "\n" not in str(error.value)


def test_bounds_must_increase(slow_flyer):
    with pytest.raises(TrimError, match="rpm bounds must be positive and increasing"):
        trimmed(slow_flyer, 1.0, 0.0, 5500.0, 3500.0)


def test_two_speed_rule_of_the_thesis_errs_by_a_few_percent(slow_flyer):
    two = bounds_of(4000.0, 5000.0)
    omega = rotation_speed_by_interpolation(axial, slow_flyer.case(), 1.8, two)
    error = thrust_at(slow_flyer, omega, 8.0) / 1.8 - 1.0
    # The thrust is convex in the rotation speed, so it lies below the chord: the thesis says < 5 %.
    assert -0.05 < error < -0.005


def test_derivatives_are_those_of_the_implicit_function(slow_flyer):
    nodes = slow_flyer.nodes(2, 5)

    def omega(at):
        speed, density, thrust = at
        case = slow_flyer.case(speed=speed, density=density, nodes=nodes)
        return solve_for_thrust(axial, case, thrust, bounds_of(2000.0, 9000.0)).rotation_speed

    at = np.array([8.0, 1.2, 1.3])
    with_slopes = compiled(jax.value_and_grad(omega), optimisation=0)
    h = 1e-5
    for i, slope in enumerate(with_slopes(at)[1]):
        step = h * np.eye(3)[i]
        central = (with_slopes(at + step)[0] - with_slopes(at - step)[0]) / (2 * h)
        assert float(slope) == pytest.approx(float(central), rel=1e-6)


def test_any_solver_can_be_trimmed(slow_flyer):
    # T = a Omega^2 - b V Omega, a solver that is no lattice.
    def thrust_of(case, rotation_speed):
        return 2e-5 * rotation_speed**2 - 1e-4 * case.state.speed * rotation_speed

    solver = types.SimpleNamespace(
        solve=lambda case: types.SimpleNamespace(thrust=thrust_of(case, case.state.rotation_speed)),
        flow_at=lambda case: case,
        rough=lambda flow, required, omega: 0.8 * thrust_of(flow, omega),
        evaluate=lambda flow, required, omega: (thrust_of(flow, omega), {"twice": 2.0 * omega}),
        solution=lambda flow, required, omega, results: results["twice"],
    )
    solver = _hashable(solver)
    omega, loads = trim(solver, slow_flyer.case(speed=5.0), 2.0, Bounds(10.0, 900.0))
    exact = (5e-4 + np.sqrt(25e-8 + 4 * 2e-5 * 2.0)) / 4e-5
    assert omega == pytest.approx(exact, rel=1e-8)
    assert float(loads) == pytest.approx(2.0 * exact, rel=1e-8)
    with pytest.raises(TrimError, match="out of reach"):
        trim(solver, slow_flyer.case(speed=5.0), 50.0, Bounds(10.0, 900.0))


def _without_solution_above(limit):
    def thrust_of(case, rotation_speed):
        return np.where(rotation_speed > limit, np.nan, 2e-5 * rotation_speed**2)

    return _hashable(
        types.SimpleNamespace(
            solve=lambda case: types.SimpleNamespace(
                thrust=thrust_of(case, case.state.rotation_speed)
            ),
            flow_at=lambda case: case,
            rough=lambda flow, required, omega: 3e-5 * omega**2,
            evaluate=lambda flow, required, omega: (
                jnp.where(omega > limit, jnp.nan, 2e-5 * omega**2),
                {},
            ),
            solution=lambda flow, required, omega, results: results,
        )
    )


def test_ends_without_a_solution_are_told_in_words(slow_flyer):
    with pytest.raises(
        TrimError, match="out of reach at 5 m/s: 0.002 N at .* rpm, no solution at 8594.37 rpm"
    ):
        trim(_without_solution_above(500.0), slow_flyer.case(speed=5.0), 20.0, Bounds(10.0, 900.0))


@pytest.mark.parametrize("limit", [500.0, 317.0])
def test_ends_without_a_solution_do_not_hide_one_between_them(slow_flyer, limit):
    solver = _without_solution_above(limit)
    omega, _ = trim(solver, slow_flyer.case(speed=5.0), 2.0, Bounds(10.0, 900.0))
    assert omega == pytest.approx(np.sqrt(2.0 / 2e-5), rel=1e-10)


@pytest.mark.parametrize("rough", [1.0, 0.3, 4.0, -1.0, 0.0])
def test_a_rough_thrust_that_is_wrong_costs_trials_and_nothing_else(slow_flyer, rough):
    solver = _hashable(
        types.SimpleNamespace(
            flow_at=lambda case: case,
            rough=lambda flow, required, omega: rough * 2e-5 * omega**2,
            evaluate=lambda flow, required, omega: (2e-5 * omega**2 - 4e-3 * omega, omega),
            solution=lambda flow, required, omega, results: results,
        )
    )
    case = slow_flyer.case(speed=5.0)
    trimmed = solve_for_thrust(solver, case, 2.0, Bounds(10.0, 900.0))
    exact = (4e-3 + np.sqrt(16e-6 + 16e-5)) / 4e-5
    assert bool(trimmed.reached)
    assert float(trimmed.rotation_speed) == pytest.approx(exact, rel=1e-10)
    assert float(trimmed.loads) == pytest.approx(exact, rel=1e-10)
    for unreachable in (50.0, -3.0):
        missed = solve_for_thrust(solver, case, unreachable, Bounds(10.0, 900.0))
        assert not bool(missed.reached)


def _hashable(namespace):
    """As modules are: equal to itself alone."""
    return type("Solver", (), {k: staticmethod(v) for k, v in vars(namespace).items()})


@pytest.mark.parametrize("speed", [0.0, 100.0])
def test_bounds_by_the_speed_of_the_tip(speed):
    bounds = rotation_bounds(0.2, speed)
    assert float(bounds.low) == pytest.approx(LEAST_TIP_SPEED / 0.2)
    assert np.hypot(float(bounds.high) * 0.2, speed) == pytest.approx(LARGEST_TIP_SPEED)


def test_a_flight_that_is_too_fast_for_any_rotation_is_refused():
    with pytest.raises(TrimError, match="speed must be below 306.265 m/s to trim; it is 320"):
        require_bounds(rotation_bounds(jnp.asarray(0.2), 320.0), 320.0)

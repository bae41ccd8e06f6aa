"""Steady solution: limits, similarity, energy and derivatives."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.solutions import axial
from propmdao.runtime.compilation import compiled

OMEGA = 440.0


def solve(rotor, omega=OMEGA, speed=8.0, density=1.225, **others):
    return axial.solve(rotor.case(float(omega), float(speed), density, **others))


def numbers(rotor, solution, omega, speed, density=1.225):
    state = rotor.case(omega, speed, density).state
    return coefficients(solution.thrust, solution.torque, state, 2 * rotor.radius)


def test_zero_rotation_speed_gives_zero_loads(slow_flyer):
    solution = solve(slow_flyer, omega=0.0)
    assert solution.thrust == 0.0 and solution.torque == 0.0 and solution.induced_velocity == 0.0
    assert not np.any(solution.point_loads.force) and not np.any(solution.circulation)
    assert solution.converged


def outputs(rotor, inputs):
    """Thrust, torque and induced velocity by rotation and flight speed, density and nodes."""
    omega, speed, density, nodes = inputs
    solution = axial.solve(rotor.case(omega, speed, density, nodes=nodes))
    return jnp.stack([solution.thrust, solution.torque, solution.induced_velocity])


@pytest.fixture(scope="module")
def with_rows(slow_flyer):
    """Outputs, and the derivatives of each by all inputs."""

    def with_rows(inputs):
        values, back = jax.vjp(partial(outputs, slow_flyer), inputs)
        return values, jax.vmap(back)(jnp.eye(3))[0]

    return compiled(with_rows, optimisation=0)


def test_derivatives_at_zero_rotation_speed_are_finite(slow_flyer, with_rows):
    values, rows = with_rows((0.0, 8.0, 1.2, slow_flyer.nodes(2, 5)))
    assert not np.any(values)
    by_omega, by_speed, *others = rows
    assert by_speed[0] == 0.0
    assert all(np.isfinite(slope).all() for slope in (by_omega, by_speed, *others))


@pytest.mark.parametrize("speed", [0.0, 3.0, 8.0])
def test_thrust_is_that_of_momentum_theory_at_the_induced_velocity(slow_flyer, speed):
    solution = solve(slow_flyer, speed=speed)
    w, area = float(solution.induced_velocity), np.pi * slow_flyer.radius**2
    momentum = 2 * 1.225 * area * w * (speed + w)
    assert solution.converged
    assert float(solution.thrust) == pytest.approx(momentum, rel=5e-4)


@pytest.mark.parametrize(
    ("speed", "low", "high"),
    [
        (8.0, 1.08, 1.11),
        (3.0, 1.14, 1.18),
        (0.0, 1.13, 1.18),
    ],
)
def test_power_over_that_of_the_ideal_actuator_disk(slow_flyer, speed, low, high):
    solution = solve(slow_flyer, speed=speed)
    ideal = solution.thrust * (speed + solution.induced_velocity)
    assert low < solution.torque * OMEGA / ideal < high


def test_coefficients_depend_on_advance_ratio_alone(slow_flyer):
    # Only the wake's viscous core knows the scale.
    slow = numbers(slow_flyer, solve(slow_flyer, 300.0, 5.0), 300.0, 5.0)
    fast = numbers(slow_flyer, solve(slow_flyer, 600.0, 10.0, 0.6), 600.0, 10.0, 0.6)
    for name in ("J", "CT", "CP", "eta"):
        assert float(getattr(slow, name)) == pytest.approx(float(getattr(fast, name)), rel=1e-3)


def test_strips_and_points_add_up_to_the_whole(slow_flyer):
    solution = solve(slow_flyer)
    on_fluid = solution.point_loads
    moment = jnp.cross(on_fluid.position, on_fluid.force)[:, 2].sum()
    np.testing.assert_allclose(2 * solution.strip_thrust.sum(), solution.thrust, rtol=1e-12)
    np.testing.assert_allclose(2 * solution.strip_torque.sum(), solution.torque, rtol=1e-12)
    np.testing.assert_allclose(-2 * on_fluid.force[:, 2].sum(), solution.thrust, rtol=1e-12)
    np.testing.assert_allclose(2 * moment, solution.torque, rtol=1e-12)


def test_uncambered_untwisted_blade_in_hover_carries_nothing(slow_flyer):
    flat = slow_flyer.nodes()
    flat = flat.at[..., 2].set(0.0)
    solution = solve(slow_flyer, speed=0.0, nodes=flat)
    assert abs(solution.thrust) < 1e-9 and abs(solution.torque) < 1e-9
    assert solution.converged


def test_hover_at_negative_thrust_is_the_mirror_image(slow_flyer):
    nodes = slow_flyer.nodes()
    up, down = (solve(slow_flyer, speed=0.0, nodes=nodes.at[..., 2].multiply(s)) for s in (1, -1))
    assert up.converged and down.converged and up.thrust > 0.5
    np.testing.assert_allclose(down.thrust, -up.thrust, rtol=1e-9)
    np.testing.assert_allclose(down.torque, up.torque, rtol=1e-9)
    np.testing.assert_allclose(down.induced_velocity, -up.induced_velocity, rtol=1e-9)
    np.testing.assert_allclose(down.circulation, -up.circulation, rtol=1e-9)


def test_more_blades_give_more_thrust_but_each_gives_less(slow_flyer):
    thrust = [solve(slow_flyer, n_blades=b).thrust for b in (1, 2, 4)]
    assert thrust[0] < thrust[1] < thrust[2]
    assert thrust[0] > thrust[1] / 2 > thrust[2] / 4


def test_beyond_the_windmilling_limit_of_momentum_theory_it_says_so(slow_flyer):
    nodes = slow_flyer.nodes()
    steep = nodes.at[..., 2].multiply(-3.0)
    solution = solve(slow_flyer, omega=400.0, speed=2.0, nodes=steep)
    assert np.isfinite(solution.thrust) and solution.thrust < 0.0
    assert not solution.converged


def inputs_and_way(rotor, speed):
    """Where derivatives are taken, and a direction in all inputs at once."""
    nodes = rotor.nodes(2, 5)
    direction = np.random.default_rng(3).normal(size=nodes.shape) * 1e-4
    return (OMEGA, speed, 1.2, nodes), (1.0, 0.3, 0.01, jnp.asarray(direction))


def along(rows, way):
    """Derivatives of the outputs along a direction, from those by all inputs."""
    leaves = zip(rows, way, strict=True)
    return sum((np.asarray(row) * np.asarray(d)).reshape(3, -1).sum(axis=1) for row, d in leaves)


@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_derivatives_are_those_of_the_converged_solution(slow_flyer, with_rows, speed):
    at, way = inputs_and_way(slow_flyer, speed)
    h = 1e-3
    ends = [with_rows(tuple(q + s * h * d for q, d in zip(at, way, strict=True))) for s in (1, -1)]
    central = (ends[0][0] - ends[1][0]) / (2 * h)
    # The iteration stops at 1e-7 in w, squared by the secant step: differences see about 1e-8.
    np.testing.assert_allclose(along(with_rows(at)[1], way), central, rtol=2e-6)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_derivatives_forward_are_the_same(slow_flyer, with_rows, speed):
    at, way = inputs_and_way(slow_flyer, speed)
    at, way = jax.tree.map(jnp.asarray, (at, way))
    forward = jax.jit(lambda q: jax.jvp(partial(outputs, slow_flyer), (q,), (way,))[1])(at)
    np.testing.assert_allclose(along(with_rows(at)[1], way), forward, rtol=1e-9)


@pytest.mark.parametrize("guess", [-0.2, 0.1, 1.3, 30.0])
def test_the_guess_changes_nothing_but_the_work(slow_flyer, guess):
    case = slow_flyer.case(OMEGA)
    plain = axial.solve(case)
    guessed = axial.solve(case, thrust_guess=guess)
    assert float(guessed.thrust) == pytest.approx(float(plain.thrust), rel=1e-8)

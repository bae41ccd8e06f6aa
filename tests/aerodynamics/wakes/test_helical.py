"""Momentum theory and the shape of the wake in their limits."""

from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.helical import WakeTransport, helical_wake, outer_part
from propmdao.aerodynamics.wakes.momentum import momentum_induced_velocity
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw
from propmdao.runtime.compilation import compiled

RHO, RADIUS, OMEGA = 1.2, 0.15, 400.0
AREA = np.pi * RADIUS**2
TRAILING = jnp.array([[0.1, -0.02, 0.003]])


momentum_velocity = compiled(momentum_induced_velocity, optimisation=0)


def state_at(speed):
    return RotorState(OMEGA, speed, Air(density=RHO))


@partial(compiled, static_argnames=("n_blades", "law"), optimisation=0)
def filaments(node, ages, n_blades, speed, induced, law=WakeLaw()):  # noqa: B008 - frozen
    """Wake of blades whose lattice does not matter."""
    rotor, transport = RotorGeometry(node, RADIUS, n_blades), WakeTransport(law, ages)
    return helical_wake(node, transport, rotor, state_at(speed), induced)


def wake_of(speed, induced, turns=30.0, n_blades=2):
    ages = jnp.linspace(0.0, 2 * np.pi * turns, 721)
    return ages, filaments(TRAILING, ages, n_blades, speed, induced)


@pytest.mark.parametrize("speed", [0.0, 3.0, 12.0])
def test_induced_velocity_satisfies_momentum(speed):
    thrust = 4.0
    w = momentum_velocity(thrust, state_at(speed), RADIUS)
    # The smooth floor under the discriminant, (0.005 of tip speed)^2, is left to be seen.
    assert 2 * RHO * AREA * w * (speed + w) == pytest.approx(thrust, rel=2e-4)


def test_induced_velocity_stays_finite_and_smooth_beyond_the_windmilling_limit():
    thrust = jnp.linspace(-20.0, 0.0, 401)
    w = momentum_velocity(thrust, state_at(5.0), RADIUS)
    assert (w > -2.5).all() and (np.diff(w) > 0).all()


def test_without_induced_velocity_the_wake_is_the_rigid_helix():
    ages, wake = wake_of(8.0, 0.0)
    z = TRAILING[0, 2] - 8.0 * ages / OMEGA
    np.testing.assert_allclose(wake[0, 0, :, 2], z, rtol=1e-12, atol=1e-15)
    radius = np.hypot(wake[0, 0, :, 0], wake[0, 0, :, 1])
    np.testing.assert_allclose(radius, np.hypot(0.1, 0.02), rtol=1e-12)
    np.testing.assert_allclose(wake[0, 1, :, :2], -wake[0, 0, :, :2], atol=1e-15)


def drift_of(node, speed, induced, n_blades):
    """Ages in blade passages, and axial velocity relative to the free stream in w."""
    ages = jnp.linspace(0.0, 8 * np.pi, 4801)
    wake = filaments(node[None], ages, n_blades, speed, induced)
    velocity = -np.diff(wake[0, 0, :, 2]) / np.diff(ages) * OMEGA
    return 0.5 * (ages[1:] + ages[:-1]) * n_blades / (2 * np.pi), (velocity - speed) / induced


@pytest.mark.parametrize("speed", [0.0, 8.0])
@pytest.mark.parametrize("n_blades", [2, 3])
def test_tip_drifts_slowly_until_the_next_blade_has_passed(speed, n_blades):
    passed, drift = drift_of(jnp.array([RADIUS, 0.0, 0.0]), speed, 5.0, n_blades)
    np.testing.assert_allclose(drift[passed < 0.2], 0.7 / n_blades, atol=0.02)
    assert drift[np.argmin(np.abs(passed - 1.0))] == pytest.approx(0.5 + 0.35 / n_blades, abs=0.01)
    # The mean of both sides: inside the far stream V + 2 w, outside V.
    np.testing.assert_allclose(drift[passed > 2.0], 1.0, atol=0.01)


@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_inner_sheet_is_carried_by_the_air_of_the_far_stream(speed):
    _, drift = drift_of(TRAILING[0], speed, 5.0, 2)
    np.testing.assert_allclose(drift, 2.0, rtol=1e-9)


@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_wake_contracts_by_continuity(speed):
    induced = 5.0
    _, wake = wake_of(speed, induced)
    radius = np.hypot(wake[0, 0, :, 0], wake[0, 0, :, 1])
    continuity = np.sqrt((speed + induced) / (speed + 2 * induced))
    assert radius[-1] / radius[0] == pytest.approx(continuity, rel=1e-3)


def test_sheet_parts_between_the_inner_and_the_tip_smoothly():
    r = jnp.linspace(0.0, 1.0, 1001)
    part = outer_part(r, WakeLaw())
    assert not part[r <= 0.7].any() and part[-1] == 1.0 and (np.diff(part) >= 0).all()
    assert np.abs(np.diff(part, 2)).max() < 1e-4  # no kink: a step of slope 1 would leave 1e-3


def test_wake_trails_behind_a_blade_that_turns_counter_clockwise():
    _, wake = wake_of(8.0, 2.0, turns=0.01)
    azimuth = np.unwrap(np.arctan2(wake[0, 0, :, 1], wake[0, 0, :, 0]))
    assert azimuth[-1] - azimuth[0] == pytest.approx(-0.02 * np.pi)


def test_ages_start_at_the_blade_and_end_at_the_last_turn():
    ages = wake_azimuths(WakeGrid(6.0, 10.0, 1.1, 30.0))
    step = np.diff(ages)
    assert ages[0] == 0.0 and ages[-1] == pytest.approx(12 * np.pi)
    assert (step > 0).all() and step[0] == step.min()
    assert np.degrees(step).max() < 30.01


def test_the_law_can_be_varied():
    ages = jnp.linspace(0.0, 4 * np.pi, 101)
    deep, still = (filaments(TRAILING, ages, 2, 0.0, 5.0, WakeLaw(inside=k)) for k in (2.0, 0.0))
    depth = -(deep - TRAILING[0])[0, 0, :, 2]
    np.testing.assert_allclose(depth, 10.0 * ages / OMEGA, rtol=1e-9)
    np.testing.assert_allclose(still[0, 0, :, 2], TRAILING[0, 2], rtol=1e-12)


@pytest.mark.parametrize("wrong", [{"turns": 0.0}, {"last_step_deg": -1.0}, {"growth": 0.5}])
def test_grids_without_length_are_refused(wrong):
    (name,) = wrong
    with pytest.raises(ValueError, match=name):
        WakeGrid(**wrong)

"""Momentum theory and the wake of a rotor at an angle to the flight."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.wakes.helical import WakeTransport, helical_wake
from propmdao.aerodynamics.wakes.momentum import momentum_induced_velocity
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeLaw

RHO, RADIUS, OMEGA = 1.2, 0.15, 400.0
AREA = np.pi * RADIUS**2


def state_at(speed, incidence_deg):
    return RotorState(OMEGA, speed, Air(density=RHO), jnp.radians(incidence_deg))


def induced(thrust, speed, incidence_deg):
    return float(momentum_induced_velocity(thrust, state_at(speed, incidence_deg), RADIUS))


@pytest.mark.parametrize("incidence_deg", [10.0, 45.0, 90.0, 130.0, 150.0])
@pytest.mark.parametrize(("speed", "thrust"), [(3.0, 4.0), (12.0, 4.0), (12.0, -0.3), (40.0, 1.0)])
def test_induced_velocity_satisfies_glauert(speed, incidence_deg, thrust):
    w = induced(thrust, speed, incidence_deg)
    angle = np.radians(incidence_deg)
    resultant = np.hypot(speed * np.sin(angle), speed * np.cos(angle) + w)
    # The smooth floor of axial flight fades as the flight turns away from the shaft.
    assert 2 * RHO * AREA * w * resultant == pytest.approx(thrust, rel=3e-4)


def test_in_fast_edgewise_flight_it_is_that_of_a_wing():
    # T / (2 rho A V), as a wing whose span is the diameter.
    assert induced(1.0, 60.0, 90.0) == pytest.approx(1.0 / (2 * RHO * AREA * 60.0), rel=1e-4)


@pytest.mark.parametrize(("speed", "thrust"), [(5.0, 3.0), (5.0, -0.4), (0.0, 3.0), (0.0, -3.0)])
def test_small_incidence_changes_it_little(speed, thrust):
    assert induced(thrust, speed, 1e-3) == pytest.approx(induced(thrust, speed, 0.0), rel=1e-6)


@pytest.mark.parametrize("incidence_deg", [60.0, 90.0, 120.0])
def test_thrust_the_other_way_in_the_mirrored_flight_is_mirrored(incidence_deg):
    mirrored = induced(-3.0, 8.0, 180.0 - incidence_deg)
    assert mirrored == pytest.approx(-induced(3.0, 8.0, incidence_deg), rel=1e-12)


def test_derivatives_are_those_of_the_root():
    arguments = jnp.array([3.0, 9.0, 75.0])

    def root(x):
        return momentum_induced_velocity(x[0], state_at(x[1], x[2]), RADIUS)

    exact = jax.grad(root)(arguments)
    steps = 1e-4 * jnp.eye(3)
    central = [(root(arguments + step) - root(arguments - step)) / 2e-4 for step in steps]
    np.testing.assert_allclose(exact, central, rtol=1e-7)


def test_the_wake_drifts_straight_back_for_whoever_does_not_turn():
    ages, azimuths = jnp.linspace(0.0, 9.0, 7), jnp.array([0.0, 1.0, 4.0])
    drift = sideways_drift(ages, azimuths, state_at(10.0, 70.0))
    back = 10.0 * np.sin(np.radians(70.0)) * np.asarray(ages) / OMEGA
    for azimuth, seen in zip(azimuths, drift, strict=True):
        turn = np.array([[np.cos(azimuth), -np.sin(azimuth)], [np.sin(azimuth), np.cos(azimuth)]])
        np.testing.assert_allclose(
            np.asarray(seen)[:, :2] @ turn.T, np.outer(back, [-1, 0]), atol=1e-15
        )
        np.testing.assert_allclose(seen[:, 2], 0.0)


def test_the_stream_contracts_less_the_more_the_flight_adds_to_it():
    node = jnp.array([[0.1, -0.02, 0.003]])
    ages = jnp.linspace(0.0, 60.0, 50)

    def last_radius(speed):
        rotor, transport = RotorGeometry(node, RADIUS, 2), WakeTransport(WakeLaw(), ages)
        wake = helical_wake(node, transport, rotor, state_at(speed, 90.0), 4.0)
        return float(np.hypot(*np.asarray(wake)[0, 0, -1, :2]) / np.hypot(0.1, 0.02))

    hover, slow, fast = (last_radius(speed) for speed in (0.0, 4.0, 40.0))
    assert hover == pytest.approx(np.sqrt(0.5), abs=0.01)
    assert hover < slow < fast < 1.0
    assert fast == pytest.approx((1600.0 + 16.0) ** 0.25 / (1600.0 + 64.0) ** 0.25, abs=2e-3)

"""Coefficients by their definitions, bounded and smooth where a propeller brakes."""

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.records.air import Air
from propmdao.records.states import RotorState

OMEGA, SPEED, DIAMETER = 2 * np.pi * 70.0, 8.0, 0.28


def at(thrust, torque, speed=SPEED, omega=OMEGA):
    return coefficients(thrust, torque, RotorState(omega, speed, Air(density=1.2)), DIAMETER)


def eta_of(thrust, lost_power=3.0):
    """Efficiency at a thrust where this much of the shaft power [W] is lost."""
    return float(at(thrust, (thrust * SPEED + lost_power) / OMEGA).eta)


def test_definitions_with_n_in_revolutions_per_second():
    n, D, rho, T, Q, V = 70.0, 0.28, 1.2, 1.5, 0.03, 8.0
    c = at(T, Q)
    assert pytest.approx(V / (n * D)) == c.J
    assert pytest.approx(T / (rho * n**2 * D**4)) == c.CT
    assert pytest.approx(Q / (rho * n**2 * D**5)) == c.CQ
    assert pytest.approx(2 * np.pi * n * Q / (rho * n**3 * D**5)) == c.CP
    power = 2 * np.pi * n * Q
    assert c.eta == pytest.approx(T * V / power, rel=1e-12)
    ideal = T**1.5 / np.sqrt(2 * rho * np.pi * D**2 / 4)
    assert ideal < power
    assert c.figure_of_merit == pytest.approx(ideal / power, rel=1e-12)


def test_at_rest_all_are_zero():
    c = at(0.0, 0.0, omega=0.0)
    assert [float(value) for value in jax.tree.leaves(c)] == [0.0] * 6


def test_an_ideal_actuator_disk_has_both_at_one():
    area = np.pi * DIAMETER**2 / 4
    hover = at(1.5, 1.5**1.5 / np.sqrt(2 * 1.2 * area) / OMEGA, speed=0.0)
    assert hover.figure_of_merit == pytest.approx(1.0, abs=1e-6)
    assert hover.eta == 0.0
    assert eta_of(1.5, lost_power=0.0) == pytest.approx(1.0, abs=1e-6)


def test_efficiency_goes_smoothly_through_zero_thrust():
    """Slope V / losses from either side."""
    h = 1e-4
    assert eta_of(0.0) == 0.0
    for thrust in (h, -h):
        assert eta_of(thrust) / thrust == pytest.approx(SPEED / 3.0, rel=1e-3)
    slope = jax.grad(lambda thrust: at(thrust, 3.0 / OMEGA).eta)
    assert slope(0.0) == pytest.approx(SPEED / 3.0)


def test_efficiency_of_a_brake_is_negative_bounded_and_falls_with_its_braking():
    """Whether it takes shaft power, none, or gives it; J CT / CP of the last is above 1."""
    thrust = -np.geomspace(1e-3, 1e3, 60)
    for share in (0.0, 0.5, 0.9):  # of the braking power that is lost, beside 3 W
        eta = np.array([eta_of(t, 3.0 - share * t * SPEED) for t in thrust])
        assert np.all(np.diff(eta) < 0.0)
        assert -1.0 <= eta.min() and eta.max() < 0.0


def test_figure_of_merit_of_reversed_thrust_is_negative():
    """No optimum of hover lies there; derivatives are finite at zero thrust."""
    torque = 0.03
    merit = [float(at(t, torque, speed=0.0).figure_of_merit) for t in (-5.0, -1.0, 0.0, 1.0)]
    assert -1.0 < merit[0] < merit[1] < merit[2] == 0.0 < merit[3]
    assert jax.grad(lambda t: at(t, torque, speed=0.0).figure_of_merit)(0.0) == 0.0


@pytest.mark.parametrize("name", ["eta", "figure_of_merit"])
def test_shaft_power_through_zero_leaves_both_smooth(name):
    """A windmill in flight: difference quotients are the derivatives, nowhere a kink."""

    def value(torque):
        return getattr(at(-0.7, torque), name)

    torque, h = np.linspace(-0.03, 0.03, 41), 1e-7
    exact = jax.vmap(jax.grad(value))(torque)
    assert_allclose(exact, (value(torque + h) - value(torque - h)) / (2 * h), rtol=1e-5)

"""Efficiency and figure of merit as objectives: one optimum, from every start."""

import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import PropellerGroup

OBSERVERS = arc(1.905, [-45.0, 0.0])


@pytest.fixture(scope="module")
def propeller_at(small):
    """``propeller_at(speed)``: Problem of a propeller at an rpm that SLSQP may vary."""

    def propeller_at(speed):
        prob = om.Problem(
            driver=om.ScipyOptimizeDriver(optimizer="SLSQP", disp=False), reports=False
        )
        group = PropellerGroup(
            propeller="apce_10x7_uiuc", observers=OBSERVERS, trim="rpm", fidelity=small
        )
        prob.model.add_subsystem("propeller", group, promotes=["*"])
        prob.model.add_design_var("rpm", lower=2000.0, upper=7000.0, ref=1000.0)
        prob.model.add_objective("efficiency", scaler=-1.0)
        prob.setup(mode="rev")  # with which it shares what other tests have compiled
        prob.set_val("speed", speed)
        return prob

    return propeller_at


@pytest.mark.parametrize("start", [2500.0, 4000.0, 6000.0])
def test_the_best_efficiency_is_found_from_every_start(propeller_at, start):
    """At 2500 rpm and 12 m/s it is a windmill, where J CT / CP is 2.0."""
    prob = propeller_at(12.0)
    prob.set_val("rpm", start)
    assert prob.run_driver().success
    assert_allclose(prob.get_val("efficiency"), 0.7037, atol=5e-4)
    assert_allclose(prob.get_val("rpm"), 4555.0, atol=60.0)


def test_a_windmill_has_a_negative_efficiency_that_falls_toward_standstill(propeller_at):
    prob = propeller_at(12.0)
    efficiency = []
    for rpm in (1000.0, 2018.0, 3000.0, 3250.0):
        prob.set_val("rpm", rpm)
        prob.run_model()
        assert prob.get_val("thrust")[0] < 0.0
        efficiency.append(prob.get_val("efficiency")[0])
    assert -1.0 < efficiency[0] < efficiency[1] < efficiency[2] < efficiency[3] < 0.0


def test_figure_of_merit_in_hover(propeller_at):
    """Ideal power of the thrust over shaft power, of a good small propeller."""
    prob = propeller_at(0.0)
    prob.set_val("rpm", 5000.0)
    prob.run_model()
    thrust, power, radius = prob["thrust"][0], prob["shaft_power"][0], 0.127
    ideal = thrust**1.5 / (2.0 * 1.225 * 3.141592653589793 * radius**2) ** 0.5
    assert_allclose(prob.get_val("figure_of_merit"), ideal / power, rtol=1e-5)
    assert 0.4 < ideal / power < 0.8
    assert prob.get_val("efficiency")[0] == 0.0

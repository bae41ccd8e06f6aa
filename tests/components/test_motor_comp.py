"""MotorComp: the values of its model, exact partials, a battery, what is refused."""

from __future__ import annotations

from typing import Any

import numpy as np
import openmdao.api as om
import pytest
from openmdao.utils.assert_utils import assert_check_partials

from propmdao.components import MotorComp
from propmdao.propeller.electric_drive import driven_by, endurance
from propmdao.propeller.motors import Motor, MotorError

MOTOR = Motor("motor", 920.0, 0.12, 0.7)


def problem(**options: Any) -> om.Problem:
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("motor", MotorComp(motor=MOTOR, **options), promotes=["*"])
    prob.setup(force_alloc_complex=False)
    return prob


@pytest.mark.parametrize("battery", [False, True])
def test_values_and_partials(battery: bool) -> None:
    """At rest, at work, and but for the battery driven by the propeller."""
    rpm = np.array([0.0, 4000.0, 9000.0, 5000.0])
    torque = np.array([0.02, 0.05, 0.2, 0.03 if battery else -0.1])
    prob = problem(num_nodes=4, battery=battery)
    prob.set_val("rpm", rpm)
    prob.set_val("torque", torque)
    if battery:
        prob.set_val("battery_energy", 3.6e4, units="J")
        prob.set_val("usable_share", 0.7)
    prob.run_model()
    state = driven_by(MOTOR, rpm, torque)
    for name in ("current", "voltage", "electrical_power", "motor_efficiency"):
        np.testing.assert_allclose(prob.get_val(name), getattr(state, name), rtol=1e-12)
    if battery:
        minutes = endurance(state.electrical_power, 10.0, 0.7) / 60.0
        np.testing.assert_allclose(prob.get_val("endurance", units="min"), minutes, rtol=1e-12)
    data = prob.check_partials(method="fd", form="central", step_calc="rel_avg", out_stream=None)
    assert_check_partials(data, atol=1e-5, rtol=1e-5)


def test_nothing_moves_nothing_is_divided() -> None:
    prob = om.Problem(reports=False)
    ideal = Motor("ideal", 1000.0, 0.0, 0.0)
    prob.model.add_subsystem("motor", MotorComp(motor=ideal), promotes=["*"])
    prob.setup()
    prob.set_val("rpm", 0.0)
    prob.run_model()
    assert prob.get_val("motor_efficiency") == 0.0
    totals = prob.compute_totals(of=["motor_efficiency"], wrt=["rpm", "torque"])
    assert all(np.isfinite(value).all() for value in totals.values())


def test_a_battery_is_not_emptied_by_a_generator() -> None:
    prob = problem(battery=True)
    prob.set_val("rpm", 5000.0)
    prob.set_val("torque", -0.1)
    with pytest.raises(om.AnalysisError, match="motor: electrical_power must be above 0"):
        prob.run_model()


def test_what_is_refused() -> None:
    prob = problem()
    prob.set_val("torque", np.nan)
    with pytest.raises(om.AnalysisError, match="torque"):
        prob.run_model()
    prob = problem()
    prob.set_val("speed_constant", -1.0)
    with pytest.raises(om.AnalysisError, match="speed_constant of motor 'motor' must be"):
        prob.run_model()
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("motor", MotorComp(motor="nothing_like_it"))
    with pytest.raises(MotorError, match="unknown motor 'nothing_like_it'"):
        prob.setup()

"""The mission in OpenConcept: forces balance, energy is the integral of power, exact totals."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest
from scipy.integrate import simpson

pytest.importorskip("openconcept")


@pytest.fixture(scope="module")
def flown(import_study: Callable[[str], ModuleType], coarsest: Any) -> tuple[ModuleType, Any]:
    study = import_study("openconcept_mission")
    prob = study.mission(fidelity=coarsest)
    prob.run_model()
    return study, prob


def test_the_propeller_gives_the_thrust_that_the_flight_takes(
    flown: tuple[ModuleType, Any],
) -> None:
    study, prob = flown
    drag = prob.get_val("mission.cruise.drag", units="N")
    np.testing.assert_allclose(study.phase_values(prob, "cruise")["thrust"], drag, rtol=1e-6)
    for phase in study.PHASES:
        values = study.phase_values(prob, phase)
        trimmed = prob.get_val(f"{phase}.propeller.thrust", units="N")
        np.testing.assert_allclose(trimmed, values["thrust"], rtol=1e-6)
        assert (values["oaspl_dba"] > -100.0).all()
    # Steady climb: what is left over drag lifts the weight.
    thrust, drag = (prob.get_val(f"mission.climb.{name}", units="N") for name in ("thrust", "drag"))
    sine = study.CLIMB_RATE / prob.get_val("mission.climb.fltcond|Utrue", units="m/s")
    np.testing.assert_allclose(thrust - drag, study.MASS * 9.80665 * sine, rtol=0.02)


def test_the_battery_gives_the_integral_of_the_power(flown: tuple[ModuleType, Any]) -> None:
    study, prob = flown
    for phase in study.PHASES:
        values = study.phase_values(prob, phase)
        times = np.linspace(0.0, values["duration"], values["power"].size)
        expected = simpson(values["power"], x=times) / 3600.0
        assert values["energy"] == pytest.approx(expected, rel=1e-6)


@pytest.mark.slow
def test_totals_go_through_mission_propeller_motor_and_battery(
    flown: tuple[ModuleType, Any],
) -> None:
    _, prob = flown
    name = "ac|geom|wing|S_ref"
    exact = prob.compute_totals(of=["climb.energy"], wrt=[name])["climb.energy", name][-1, 0]
    energies = []
    for step in (1e-4, -1e-4):
        prob.set_val(name, 0.25 + step)
        prob.run_model()
        energies.append(prob.get_val("climb.energy")[-1])
    prob.set_val(name, 0.25)
    prob.run_model()
    assert exact == pytest.approx((energies[0] - energies[1]) / 2e-4, rel=1e-3)

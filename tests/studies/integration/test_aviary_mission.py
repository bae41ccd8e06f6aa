"""The mission in Aviary: forces balance, energy is the integral of power, the range is flown."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType
from typing import Any

import numpy as np
import pytest

pytest.importorskip("aviary")


@pytest.fixture(scope="module")
def flown(
    import_study: Callable[[str], ModuleType],
    coarsest: Any,
    tmp_path_factory: pytest.TempPathFactory,
) -> tuple[ModuleType, Any]:
    study = import_study("aviary_mission")
    with pytest.MonkeyPatch.context() as patch:
        patch.chdir(tmp_path_factory.mktemp("aviary"))  # it writes its reports where it runs
        prob = study.mission(fidelity=coarsest)
        prob.run_aviary_problem(suppress_solver_print=True, make_plots=False)
    return study, prob


def test_the_mission_flies_its_range_on_the_least_energy(flown: tuple[ModuleType, Any]) -> None:
    study, prob = flown
    assert prob.result.success
    last = study.phase_values(prob, "descent")
    assert last["distance"][-1] == pytest.approx(study.RANGE, rel=1e-4)
    # How long it climbs is a choice: neither as steep nor as flat as it may.
    minutes = np.ptp(study.phase_values(prob, "climb")["time"])
    assert 6.5 < minutes < 19.5
    assert 2.0 < last["energy"][-1] < 12.0


def test_thrust_is_drag_and_what_climbs_and_accelerates(flown: tuple[ModuleType, Any]) -> None:
    study, prob = flown
    cruise = study.phase_values(prob, "cruise")
    pressure = 0.5 * 1.1225 * (study.FAST * 336.8) ** 2  # standard air at 900 m
    force = pressure * study.WING_AREA
    lift = study.MASS * 9.80665 / force
    drag = force * (study.DRAG_AT_ZERO_LIFT + study.INDUCED_DRAG * lift**2)
    np.testing.assert_allclose(cruise["thrust"], drag, rtol=2e-3)
    climb = study.phase_values(prob, "climb")
    seconds = 60.0 * np.ptp(climb["time"])
    energies = study.MASS * 9.80665 * study.HEIGHT
    energies += 0.5 * study.MASS * ((study.FAST * 336.8) ** 2 - (study.SLOW * 340.3) ** 2)
    drag_of_climb = climb["thrust"].mean() - energies / 1e3 / np.ptp(climb["distance"])
    assert seconds > 300.0 and drag_of_climb == pytest.approx(drag, rel=0.15)


def test_the_battery_gives_the_integral_of_the_power(flown: tuple[ModuleType, Any]) -> None:
    study, prob = flown
    before = 0.0
    for phase in study.PHASES:
        v = study.phase_values(prob, phase)
        expected = np.trapezoid(v["power"], v["time"] / 60.0)
        assert v["energy"][0] == pytest.approx(before, abs=1e-4)
        assert v["energy"][-1] - before == pytest.approx(expected, rel=0.01)
        before = v["energy"][-1]
        assert (v["oaspl_dba"] > -100.0).all() and (v["rpm"] > 500.0).all()

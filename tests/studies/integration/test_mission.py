"""The climb: exact derivatives through the phase, and a better climb than the first guess."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import pytest
from numpy.testing import assert_allclose

pytest.importorskip("dymos")

CLIMB = "trajectory.climb"


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("mission")


def test_totals_of_the_phase_against_differences(study, coarsest, assert_phase_totals):
    prob = study.mission(segments=2, twist=True, fidelity=coarsest)
    prob.run_model()
    assert_phase_totals(prob, {"beta_cp", "thrust_required", "climb_angle", "speed"})


@pytest.mark.slow
def test_the_climb_takes_less_energy_than_the_first_guess(study, coarsest, capsys):
    prob = study.mission(segments=3, fidelity=coarsest)
    prob.run_model()
    guess = prob.get_val(f"{CLIMB}.timeseries.battery_power")[-1, 0] * 24.0 / 1e3  # kJ
    assert prob.run_driver().success
    assert prob.get_val(f"{CLIMB}.timeseries.energy")[-1, 0] < 0.98 * guess
    assert_allclose(prob.get_val(f"{CLIMB}.timeseries.height")[-1], study.HEIGHT, rtol=1e-6)
    assert prob.get_val(f"{CLIMB}.timeseries.current").max() < study.LARGEST_CURRENT * (1 + 1e-5)
    study.show(prob, ("height", "rpm", "energy"))
    assert len(capsys.readouterr().out.splitlines()) > 12

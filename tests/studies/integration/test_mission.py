"""The climb: exact derivatives through the phase, and a better climb than the first guess."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("dymos")

CLIMB = "trajectory.climb"


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("mission")


def test_totals_of_the_phase_against_differences(study, coarsest):
    """Along a random direction for each design variable, at the best of several steps."""
    prob = study.mission(segments=2, twist=True, fidelity=coarsest)
    prob.run_model()
    driver, rng = prob.driver, np.random.default_rng(2)
    totals = prob.compute_totals(driver_scaling=False)
    free = {name.split(":")[-1] for _, name in totals}
    assert {"beta_cp", "thrust_required", "climb_angle", "speed"} <= free
    for name, meta in prob.model.get_design_vars(recurse=True).items():
        start, errors = prob.get_val(name).copy(), {}
        along = np.zeros(start.size)
        chosen = slice(None) if meta["indices"] is None else meta["indices"].flat()
        along[chosen] = 1e-2 * np.abs(start).max() * rng.standard_normal(along[chosen].size)
        for step in (1.0, 0.1, 1e-2, 1e-3):
            at = {}
            for k in (-2, -1, 1, 2):
                prob.set_val(name, start + k * step * along.reshape(start.shape))
                prob.run_model()
                at[k] = {
                    of: np.array(value)
                    for of, value in (
                        *driver.get_constraint_values(driver_scaling=False).items(),
                        *driver.get_objective_values(driver_scaling=False).items(),
                    )
                }
            for of in at[1]:
                exact = totals[of, name] @ along[chosen]
                slope = 8.0 * (at[1][of] - at[-1][of]) - at[2][of] + at[-2][of]
                largest = max(np.abs(exact).max(), 1e-4 * np.abs(at[1][of]).max(), 1e-6)
                error = np.abs(slope / (12.0 * step) - exact).max() / largest
                errors.setdefault(of, []).append(error)
        prob.set_val(name, start)
        for of, found in errors.items():
            assert min(found) < 1e-6, f"{of} by {name}: {found}"


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

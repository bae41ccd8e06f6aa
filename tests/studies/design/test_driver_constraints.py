"""The comparison of drivers: propmdao's own meets every constraint, and the others are called."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest

# OpenMDAO's of its own drivers, and where a driver stays where it is.
pytestmark = pytest.mark.filterwarnings("ignore:.*deprecated", "ignore:.*cannot be impacted")


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("driver_constraints")


CASES = ["vector, first element active", "vector, last element active", "equality",
         "two-sided, upper side active", "two-sided, lower side active",
         "g06, small feasible set", "analysis fails below the optimum"]  # fmt: skip


@pytest.mark.parametrize("case", CASES)
def test_differential_evolution_holds_every_constraint(study: ModuleType, case: str) -> None:
    found, runs = study.solve(study.CASES[case], study.drivers()["propmdao DE"])
    # an equality may be missed by its tolerance, 1e-4, whose multiplier is 1
    assert -1.01e-4 <= float(found) <= 1e-5
    assert runs <= (study.GENERATIONS + 1) * study.POPULATION + 2


def test_the_cases_are_all_of_the_study(study: ModuleType) -> None:
    assert sorted(study.CASES) == sorted(CASES)


def test_a_constraint_that_is_not_enforced_is_seen(study: ModuleType) -> None:
    """A driver that stays at the middle of the bounds, and one that stops at a failure."""
    stays = study.om.ScipyOptimizeDriver(optimizer="SLSQP", maxiter=0, disp=False)
    assert study.solve(study.CASES["equality"], stays)[0] == "violated by 1"
    gradient = study.drivers()["Scipy SLSQP"]
    found, _ = study.solve(study.CASES["analysis fails below the optimum"], gradient)
    assert found == "ends by AnalysisError"


@pytest.mark.slow
def test_the_tables_are_written(
    study: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:  # fmt: skip
    for driver in ("SimpleGADriver", "DifferentialEvolutionDriver"):
        monkeypatch.setenv(f"{driver}_seed", "1")
    monkeypatch.setattr("sys.argv", ["driver_constraints.py", "--output", str(tmp_path)])
    study.main()
    table = (tmp_path / "driver_constraints.csv").read_text().splitlines()
    assert len(table) == 1 + len(study.CASES) * len(study.drivers())
    printed = capsys.readouterr().out
    assert all(case in printed for case in study.CASES)

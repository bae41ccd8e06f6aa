"""Two rungs: batches are single analyses, evolution holds its limits, the short form runs whole."""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import replace
from pathlib import Path
from types import ModuleType
from typing import Any

import numpy as np
import pytest

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

import propmdao as pm
from propmdao.acoustics.levels.decibels import oaspl_db


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType], coarsest: pm.Fidelity) -> ModuleType:
    module: Any = import_study("two_rungs")
    module.FIDELITY = coarsest
    module.SORTING = replace(coarsest, n_contour=9)
    module.AT_ONCE = 8
    return module


@pytest.fixture(scope="module")
def sorting(study: ModuleType) -> Any:
    return study.Sorting()


def test_a_blade_of_a_batch_is_that_of_an_analysis(study: ModuleType, sorting: Any) -> None:
    """More designs than fit into one call, one of them twice."""
    low, high = study.bounds().T
    designs = low + np.random.default_rng(3).random((9, 10)) * (high - low)
    rung = sorting(np.concatenate([designs, designs[:1]]))
    assert sorting.n_blades == 9 and rung.torque[9] == rung.torque[0]
    point = replace(study.POINT, thrust=None, rpm=float(rung.rpm[8]))
    analysis = pm.analyze(
        study.propeller_of(designs[8], "eighth"), point, blade_element=True,
        observers=study.MICROPHONE, fidelity=study.SORTING,
    )  # fmt: skip
    level = float(oaspl_db(analysis.tones.total)[0])
    np.testing.assert_allclose(float(analysis.loads.thrust), study.POINT.thrust, rtol=1e-7)
    expected = [analysis.rpm, float(analysis.loads.torque), level]
    np.testing.assert_allclose([of[8] for of in rung], expected, rtol=1e-7)


def test_a_blade_without_a_solution_is_nan(study: ModuleType, sorting: Any) -> None:
    feathered = np.concatenate([np.ones(5), np.full(5, -40.0)])
    assert np.isnan(sorting(feathered[None]).torque).all()


def test_evolution_keeps_within_its_limits(study: ModuleType, sorting: Any) -> None:
    evolution = study.evolve(sorting, 16, 3)
    described = sorting(np.repeat([1.0, 0.0], 5)[None])
    best = sorting(evolution.best[None])
    assert best.level_db[0] < described.level_db[0]
    assert best.torque[0] <= described.torque[0]
    assert evolution.first.shape == evolution.last.shape == (16, 10)


@pytest.mark.slow
def test_the_short_form(
    study: ModuleType,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    short = ["--population", "16", "--generations", "2", "--iterations", "2", "--compared", "4"]
    monkeypatch.setattr("sys.argv", ["two_rungs.py", *short, "--output", str(tmp_path)])
    study.main()
    printed = capsys.readouterr().out
    assert printed.count("whole range") == printed.count("last generation") == 3
    assert (tmp_path / "agreement.png").stat().st_size > 10_000

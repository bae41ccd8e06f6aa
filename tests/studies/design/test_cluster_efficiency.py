"""The simulated cluster: limits that can be told by hand, and a dispatch that is measured."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("cluster_efficiency")


def test_without_dispatch_cores_share_equal_designs(study: ModuleType) -> None:
    times = np.full(100, 0.2)
    assert study.generation(times, 10, 0.0) == pytest.approx(100 * 0.2 / 10)
    # Eleven rounds of nine are needed where a tenth core is missing, and no more than designs work.
    assert study.generation(times, 9, 0.0) == pytest.approx(12 * 0.2)
    assert study.generation(times, 1000, 0.0) == pytest.approx(0.2)


def test_the_sender_sets_the_pace_of_many_cores(study: ModuleType) -> None:
    times = np.full(5000, 0.1)
    assert study.generation(times, 5000, 0.01) == pytest.approx(5000 * 0.01, rel=0.01)
    # On one core it hardly counts: while that works, the sender does.
    assert study.generation(times, 1, 0.01) == pytest.approx(500.0, rel=1e-3)


def test_one_long_design_keeps_the_generation_waiting(study: ModuleType) -> None:
    times = np.array([0.1] * 99 + [5.0])
    assert study.generation(times, 100, 0.0) == pytest.approx(5.0)
    assert study.efficiency(np.array([0.1, 0.1]), 100, 10, 0.0) == pytest.approx(1.0)
    assert study.efficiency(np.array([0.1]), 5000, 1000, 1e-3) == pytest.approx(0.1, rel=0.02)


def test_the_table_has_a_row_for_each_way_and_population(study: ModuleType) -> None:
    costs = [study.Dispatch("processes", 2, 1e-3), study.Dispatch("dask", 2, 4e-3)]
    rows = study.table(np.array([0.1, 0.2]), costs)
    assert len(rows) == 1 + 2 * len(study.POPULATIONS)
    assert {len(row) for row in rows} == {2 + len(study.CORES)}
    assert rows[1][:3] == ("processes", "100", "100 %")


def test_the_figure_is_drawn(study: ModuleType, tmp_path: Path) -> None:
    pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")
    study.draw(tmp_path / "e.png", np.array([0.1]), [study.Dispatch("processes", 2, 1e-3)])
    assert (tmp_path / "e.png").stat().st_size > 10_000


@pytest.mark.slow
def test_a_dispatch_is_measured(study: ModuleType) -> None:
    prob = study.build_problem(study.COARSE)
    prob.run_model()
    whole, few = study.dispatch("processes", prob, 8)
    assert whole.n_bytes > 100_000 > few.n_bytes and 0.0 < few.seconds < whole.seconds
    outputs = prob.model.get_nonlinear_vectors()[1].asarray()
    assert np.isfinite(outputs).all()
    times = study.design_times(prob, 3)
    assert times.shape == (3,) and (times > 0.0).all()

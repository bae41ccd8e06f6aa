"""The free-form blade: constraints say what they mean, the written blade is the problem's."""

from __future__ import annotations

import csv
import io
from collections.abc import Callable
from contextlib import redirect_stdout
from pathlib import Path
from types import ModuleType

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

from propmdao.components.drivers.gradient_search import Search
from propmdao.components.drivers.search_history import SearchHistory
from propmdao.records.fidelity import Fidelity


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType], coarse: Fidelity) -> ModuleType:
    module = import_study("gradient_design")
    module.thesis.FIDELITY = coarse
    return module


@pytest.fixture(scope="module")
def problem(study: ModuleType) -> om.Problem:
    """A design half way from the start to a random one."""
    prob = study.free_form.build_problem("tones", 0.036, 60.0)
    rng = np.random.default_rng(4)
    for name, (lower, upper) in study.free_form.BOUNDS.items():
        unit = study.free_form.units(name)
        start = prob.get_val(f"{name}_cp", units=unit)
        chosen = 0.5 * start + 0.5 * (lower + rng.random(6) * (upper - lower))
        prob.set_val(f"{name}_cp", chosen, units=unit)
    prob.run_model()
    return prob


def test_the_start_is_within_the_bounds_and_slopes(study: ModuleType) -> None:
    prob = study.free_form.build_problem("total", 0.036, 60.0)
    for name, (lower, upper) in study.free_form.BOUNDS.items():
        start = prob.get_val(f"{name}_cp", units=study.free_form.units(name))
        assert (lower - 1e-12 <= start).all() and (start <= upper + 1e-12).all(), name
        low, high = study.free_form.SLOPES[name]
        slope = np.diff(start) / np.diff(study.free_form.AT)
        assert (low <= slope).all() and (slope <= high).all(), name


def test_all_but_the_sweep_of_the_root_is_free(study: ModuleType, problem: om.Problem) -> None:
    sizes = [meta["size"] for meta in problem.model.get_design_vars().values()]
    assert sum(sizes) == 29


def test_thickness_is_in_metres(study: ModuleType, problem: om.Problem) -> None:
    chord, ratio = (
        problem.get_val(name).ravel() for name in ("chord_over_R", "thickness_over_chord")
    )
    assert_allclose(problem.get_val("section_thickness", units="mm"), 139.7 * chord * ratio)
    # the least thickness of the strength of a moulded blade, not that of the aerodynamics
    assert_allclose(study.free_form.min_thickness()[[0, -1]], [1.5e-3, 0.5e-3])


@pytest.mark.parametrize("name", ["beta", "sweep_over_R"])
def test_slopes_are_per_tip_radius(study: ModuleType, problem: om.Problem, name: str) -> None:
    unit = study.free_form.units(name)
    points = problem.get_val(f"{name}_cp", units=unit)
    slope = problem.get_val(f"{name}_slope.slope", units=unit)
    assert_allclose(slope, np.diff(points) / np.diff(study.free_form.AT))


def test_the_written_blade_has_the_distributions_of_the_problem(
    study: ModuleType, problem: om.Problem, tmp_path: Path
) -> None:
    blade = study.free_form.write_blade(problem, "new", tmp_path)
    for name, written in (("chord_over_R", blade.c_over_R), ("sweep_over_R", blade.sweep_over_R)):
        assert_allclose(written, problem.get_val(name).ravel(), rtol=1e-9, atol=1e-12)
    assert_allclose(blade.beta_deg, problem.get_val("beta", units="deg").ravel(), rtol=1e-9)


@pytest.mark.slow
def test_the_written_blade_is_that_of_the_problem(
    study: ModuleType, problem: om.Problem, tmp_path: Path
) -> None:
    blade = study.free_form.write_blade(problem, "new", tmp_path)
    shown = study.column(blade, study.evaluate(blade))
    for key, of, scale in (
        ("rpm", "rpm", 1.0),
        ("torque", "torque", 1e3),
        ("tones", "tones.soft_maximum_db", 1.0),
        ("total", "total.soft_maximum_db", 1.0),
    ):
        # camber lines through coordinate files keep four to five digits
        assert_allclose(shown[key], scale * problem.get_val(of)[0], rtol=1e-4, err_msg=key)
    assert_allclose(shown["thrust"], study.thesis.THRUST, rtol=1e-7)


def test_a_search_that_goes_on_starts_within_its_bounds(study: ModuleType) -> None:
    prob = study.free_form.build_problem("tones", 0.036, 60.0)
    bounds = study.free_form.BOUNDS
    for side in (0, 1):
        study.start_from(prob, {name: of[side] for name, of in bounds.items()})
        for name, value in study.control_points(prob).items():
            lower, upper = bounds[name]
            assert (lower <= value).all() and (value <= upper).all(), name
            assert_allclose(value, bounds[name][side], atol=1e-9)


@pytest.mark.slow
def test_contributions_lead_from_the_start_to_the_optimum(
    study: ModuleType, problem: om.Problem
) -> None:
    best = study.control_points(problem)
    rpm, torque, tones, total = (
        problem.get_val(of)[0]
        for of in ("rpm", "torque", "tones.soft_maximum_db", "total.soft_maximum_db")
    )
    start = {name: 0.9 * value for name, value in best.items()}
    head, first, *_, last = table = study.contributions(problem, start, best)
    assert len(table) == 2 + len(best)
    shown = dict(zip(head, last, strict=True))
    assert shown["rotation speed, rpm"] == f"{rpm:.0f}"
    assert float(shown["torque, mN m"]) == pytest.approx(1e3 * torque, rel=1e-4)
    assert float(shown["tones, soft maximum, dB"]) == pytest.approx(tones, abs=0.01)
    assert float(shown["total, soft maximum, dBA"]) == pytest.approx(total, abs=0.01)
    assert first[1] != last[1]


@pytest.mark.slow
def test_tables_and_figures_without_a_search(
    study: ModuleType, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def one_analysis(prob: om.Problem, file: Path) -> Search:
        prob.run_model()
        (name,) = prob.model.get_objectives()
        history = SearchHistory(prob.get_val(name)[:1], np.array([0.2]), ["torque"])
        return Search(history, 1.0, 2.0)

    monkeypatch.setattr(study, "run_slsqp", one_analysis)
    monkeypatch.setattr("sys.argv", ["gradient_design.py", "--output", str(tmp_path)])
    monkeypatch.setenv("COLUMNS", "80")
    with redirect_stdout(io.StringIO()) as printed:
        study.main()
    names = ["APC-SF", "six variables", "quiet tones", "quiet total"]
    with (tmp_path / "gradient_design.csv").open(newline="", encoding="utf-8") as stream:
        table = {row.pop(""): row for row in csv.DictReader(stream)}
    assert list(table) == [label for label, _, _ in study.ROWS]
    assert [float(table["thrust, N"][name]) for name in names] == pytest.approx([1.2] * 4)
    assert "| quiet total | 1 |" in printed.getvalue()
    assert max(map(len, printed.getvalue().split("| search")[0].splitlines())) <= 80
    for name in ("history", "blades", "tones", "total", "broadband"):
        assert (tmp_path / f"{name}.png").read_bytes().startswith(b"\x89PNG")
    for name in ("six_variables", "quiet_tones", "quiet_total"):
        assert (tmp_path / f"{name}.toml").exists()


@pytest.mark.slow
@pytest.mark.parametrize(("objective", "gain"), [("tones", 4.0), ("total", 8.0)])
def test_derivatives_find_a_quieter_blade_that_meets_every_constraint(
    study: ModuleType, tmp_path: Path, objective: str, gain: float
) -> None:
    baseline = study.evaluate(study.thesis.BASELINE)
    before = study.column(study.thesis.BASELINE, baseline)
    other = {"tones": "total", "total": "tones"}[objective]
    prob = study.free_form.build_problem(
        objective, float(baseline.loads.torque), float(before[other])
    )
    history, *_ = study.run_slsqp(prob, tmp_path / "cases.sql")
    assert before[objective] - history.objective[-1] > gain
    assert history.violation[-1] <= study.TOLERANCE
    assert history.objective.size <= 100

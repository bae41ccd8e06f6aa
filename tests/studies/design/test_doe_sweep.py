"""The design of experiments: sensitivities of known functions; the study, coarse and short."""

from __future__ import annotations

import importlib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")
pytest.importorskip("pydoe", reason="pydoe, an extra, is not installed")

from propmdao.records.fidelity import Fidelity


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("doe_sweep")


def points(n: int, seed: int = 0) -> np.ndarray:
    return np.random.default_rng(seed).uniform(-1.0, 1.0, (n, 6))


def quadratic(x: np.ndarray) -> np.ndarray:
    return 1.0 + 2.0 * x[:, 0] + x[:, 1] * x[:, 2] - 0.5 * x[:, 3] ** 2


def test_a_quadratic_function_is_its_own_surrogate(study: ModuleType) -> None:
    x = points(40)
    surrogate = study.Surrogate.fit(x, quadratic(x))
    assert_allclose(surrogate(points(5, 1)), quadratic(points(5, 1)), atol=1e-12)
    assert surrogate.q2 == pytest.approx(1.0, abs=1e-12)


def test_q2_is_that_of_fits_without_each_sample(study: ModuleType) -> None:
    x = points(45)
    y = quadratic(x) + np.sin(7.0 * x[:, 5])
    errors = []
    for i in range(len(y)):
        rest = np.arange(len(y)) != i
        coefficients, *_ = np.linalg.lstsq(study.terms(x[rest]), y[rest])
        errors.append(y[i] - (study.terms(x[i : i + 1]) @ coefficients)[0])
    expected = 1.0 - np.mean(np.square(errors)) / np.var(y)
    assert study.Surrogate.fit(x, y).q2 == pytest.approx(expected, rel=1e-9)


def test_too_few_samples_are_refused(study: ModuleType) -> None:
    with pytest.raises(ValueError, match="28 coefficients and 28 samples are too few"):
        study.Surrogate.fit(points(28), np.ones(28))


def test_sensitivities_of_a_function_that_is_known(study: ModuleType) -> None:
    """Variances on [-1, 1]: 4/3 of 2 x0, 1/9 of x1 x2, 1/45 of x3^2 / 2."""
    x = points(4000)
    y = quadratic(x)
    found = study.sensitivities(x, y, study.Surrogate.fit(x, y), seed=1)
    total = 4.0 / 3.0 + 1.0 / 9.0 + 1.0 / 45.0
    alone = np.array([4.0 / 3.0, 0.0, 0.0, 1.0 / 45.0, 0.0, 0.0]) / total
    together = alone + np.array([0.0, 1.0, 1.0, 0.0, 0.0, 0.0]) / 9.0 / total
    # Monte Carlo with 8192 points: 0.01; the samples of the regression: 1 / sqrt(4000)
    assert_allclose(found["alone"], alone, atol=0.015)
    assert_allclose(found["in all"], together, atol=0.015)
    assert_allclose(found["regression"], np.sqrt([alone[0], 0, 0, 0, 0, 0]), atol=0.03)
    assert found["R2"] == pytest.approx(alone[0], abs=0.03)


@pytest.mark.slow
@pytest.mark.filterwarnings("ignore:Passing a seed")  # OpenMDAO, of pydoe
def test_the_study_runs_goes_on_and_writes_what_it_says(
    study: ModuleType,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    capsys: pytest.CaptureFixture[str],
) -> None:
    coarse = Fidelity(n_chordwise=3, n_spanwise=6, n_contour=9, n_surface_span=8, n_harmonics=2)
    monkeypatch.setattr(importlib.import_module("low_noise_design"), "FIDELITY", coarse)
    monkeypatch.setattr(
        "sys.argv", ["doe_sweep.py", "--samples", "32", "--output", str(tmp_path / "results")]
    )
    study.main()
    printed = capsys.readouterr().out
    assert "32 samples" in printed and "R2 linear | Q2 quadratic" in printed
    (table,) = (tmp_path / "results").glob("*.csv")
    rows = table.read_text().splitlines()
    assert len(rows) == 33
    x, y = study.read_table(table)
    # each of the 32 slices of each variable has one sample
    assert (np.sort(np.floor((x + 1.0) * 16.0), axis=0) == np.arange(32)[:, None]).all()
    assert set(y) == set(study.RESPONSES)
    for name in ("doe_responses.png", "doe_sensitivities.png"):
        image = (tmp_path / "results" / name).read_bytes()
        assert int.from_bytes(image[16:20], "big") == 1200
    table.write_text("\n".join(rows[:20]) + "\n")
    study.main()
    assert table.read_text().splitlines() == rows

"""Scans for kinks: jumps and kinks of known functions are found, and the model has none."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

from propmdao.records.fidelity import Fidelity

AT = 0.37


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType], coarse: Fidelity) -> ModuleType:
    module = import_study("smooth_objectives")
    module.thesis.FIDELITY = coarse
    return module


def known(x: float) -> np.ndarray:
    """Smooth, of a jump in curvature, with a kink, with a jump."""
    beyond = max(x - AT, 0.0)
    return np.array([np.exp(x), x + beyond**2, x + beyond, x + (x > AT)])


def test_the_power_tells_jumps_and_kinks_from_smooth_functions(study: ModuleType) -> None:
    assert_allclose(study.power(known, AT - 0.001, 0.01), [2.0, 2.0, 1.0, 0.0], atol=0.2)


@pytest.mark.parametrize("function", [2, 3])
def test_kinks_and_jumps_stand_out_from_their_neighbours(study: ModuleType, function: int) -> None:
    x = np.linspace(0.0, 1.0, 101)
    values = 3.0 * np.sin(5.0 * x) + 0.05 * np.array([known(at)[function] for at in x])
    assert abs(x[study.suspects(values)[0]] - AT) < 0.025


@pytest.fixture(scope="module")
def line(study: ModuleType):
    return study.random_line(study.free_form.build_problem("total", np.inf, np.inf), 3)


def test_the_model_has_no_kink_along_a_line(study: ModuleType, line) -> None:
    values, found = study.scan([line], 41)
    assert np.isfinite(values).all()
    assert {one.response for one in found} == set(study.RESPONSES)
    assert min(one.power for one in found) > study.KINK
    table = study.rows(values, found, np.zeros(len(study.RESPONSES)))
    assert [row[-1] for row in table[1:-1]] == ["0"] * len(study.RESPONSES)
    assert table[-1][1] == "0 of 41"


@pytest.mark.slow
def test_derivatives_along_a_line_are_its_slopes(study: ModuleType, line) -> None:
    assert study.derivative_errors([line]).max() < 1e-4

"""The study of two operating points: thrust in both, less noise on average, no more torque."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import pytest
from numpy.testing import assert_allclose

from propmdao.formats.propellers import load_propeller


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("multi_point")


@pytest.mark.slow  # designs for two points in words are searched for in the components' tests
def test_the_blade_is_quieter_on_average_at_no_more_torque(study, coarsest, capsys):
    prob = study.multi_point(load_propeller("apcsf_11x4.7_uiuc"), coarsest)
    start, limit = prob.get_val("level")[0], prob.get_val("torque").copy()
    levels = prob.get_val("oaspl_total_dba")
    assert levels.min() < start < levels.max()
    assert prob.run_driver().success
    assert prob.get_val("level")[0] < start - 0.5
    assert (prob.get_val("torque") < limit * (1.0 + 1e-3)).all()
    assert_allclose(prob.get_val("thrust"), study.THRUST, rtol=1e-6)
    study.show(prob, "end")
    assert f"mean level {prob.get_val('level')[0]:.2f} dBA" in capsys.readouterr().out

"""The study of two operating points: thrust in both, less noise on average, no more torque."""

from __future__ import annotations

import importlib.util
from pathlib import Path
from types import ModuleType

import pytest
from numpy.testing import assert_allclose

from propmdao.fidelity import Fidelity
from propmdao.propeller import load_propeller

QUICK = Fidelity(n_chordwise=2, n_spanwise=4, n_contour=5, n_surface_span=4, n_harmonics=2)


@pytest.fixture(scope="module")
def study(checkout: Path) -> ModuleType:
    path = checkout / "studies" / "multi_point.py"
    spec = importlib.util.spec_from_file_location("multi_point_study", path)
    assert spec is not None and spec.loader is not None
    module = importlib.util.module_from_spec(spec)
    spec.loader.exec_module(module)
    return module


def test_the_blade_is_quieter_on_average_at_no_more_torque(study, capsys):
    prob = study.multi_point(load_propeller("apcsf_11x4.7"), QUICK)
    start, limit = prob.get_val("level")[0], prob.get_val("torque").copy()
    levels = prob.get_val("oaspl_total_dba")
    assert levels.min() < start < levels.max()
    assert prob.run_driver().success
    assert prob.get_val("level")[0] < start - 0.5
    assert (prob.get_val("torque") < limit * (1.0 + 1e-3)).all()
    assert_allclose(prob.get_val("thrust"), study.THRUST, rtol=1e-6)
    study.show(prob, "end")
    assert f"mean level {prob.get_val('level')[0]:.2f} dBA" in capsys.readouterr().out

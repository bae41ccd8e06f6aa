"""The study of hover and forward flight: quieter tones on average, at no more power."""

from __future__ import annotations

from collections.abc import Callable
from types import ModuleType

import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

from propmdao.formats.propellers import load_propeller

pytestmark = pytest.mark.slow  # the periodic lattice in two wakes, with its derivatives


@pytest.fixture(scope="module")
def study(import_study: Callable[[str], ModuleType]) -> ModuleType:
    return import_study("forward_flight")


def test_the_blade_is_quieter_on_average_at_no_more_power(study, around, tmp_path):
    start = load_propeller("apcsf_11x4.7_uiuc")
    prob, search = study.design(start, tmp_path, around)
    first = search.history.objective[0]
    assert prob.get_val("level")[0] < first - 0.5
    assert search.history.violation[-1] < 1e-3
    assert_allclose(prob.get_val("thrust"), study.THRUST, rtol=1e-6)
    blades = {"start": start, "optimum": study.designed_blade(prob, "optimum")}
    analyses = {name: study.evaluate(blade, around) for name, blade in blades.items()}
    for k, analysis in enumerate(analyses["optimum"]):
        found = study.column(analysis)
        assert found["rpm"] == pytest.approx(prob.get_val("rpm")[k], rel=1e-6)
        assert found["power"] == pytest.approx(prob.get_val("shaft_power")[k], rel=1e-6)
        assert_allclose(
            [found["below"], found["ahead"]],
            prob.get_val("oaspl_total_dba")[k],
            rtol=0.0,
            atol=1e-4,
        )
    study.tabulate(analyses, tmp_path)
    assert {file.stem for file in tmp_path.glob("*.csv")} == set(study.POINTS)
    study.draw(blades, analyses, tmp_path)
    assert len(list(tmp_path.glob("*.png"))) == 3

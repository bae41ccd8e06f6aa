"""Blade, loads over span and polars show the numbers of the analysis."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from shared_mesh import COARSE

import propmdao as pm
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.figures.rotor.of_rotor import rotor_figures


@pytest.fixture(scope="module")
def found():
    propeller = pm.load_propeller("apcsf_11x4.7_uiuc")
    return pm.analyze(propeller, rpm=4200.0, speed=4.0, fidelity=COARSE)


@pytest.fixture(scope="module")
def drawn(found):
    return rotor_figures(found, polars_for(found.propeller))


def test_loads_over_span_are_those_of_the_strips(found, drawn):
    loads = found.loads
    by_label = {axes.get_ylabel(): axes.lines[0].get_ydata() for axes in drawn["span_loads"].axes}
    assert_allclose(by_label["lift coefficient"], loads.sections.lift_coefficient)
    # The lift of a section is that of its circulation, cl = 2 Gamma / (W c).
    speed, chord = np.asarray(loads.sections.relative_speed), np.asarray(loads.strips.chord)
    lift = 2.0 * by_label["circulation, m²/s"] / (speed * chord)
    assert_allclose(lift, loads.sections.lift_coefficient, rtol=1e-4)
    thrust = by_label["thrust over span, N/m"] @ np.asarray(loads.strips.width)
    assert_allclose(2.0 * thrust, float(loads.thrust), rtol=1e-9)  # of two blades
    assert drawn["span_loads"]._suptitle.get_text() == "apcsf_11x4.7_uiuc, 4200 rpm, 4 m/s"


def test_sections_work_on_their_polars(drawn):
    lift, drag = drawn["polars"].axes
    for axes, close in ((lift, 0.03), (drag, 0.004)):
        curves, dots = axes.lines[0::2], axes.lines[1::2]
        assert len(curves) == len(dots) == 4
        for curve, dot in zip(curves[1:3], dots[1:3], strict=True):  # in attached flow, mid span
            (x,), (y,) = dot.get_data()
            if axes is lift:
                assert np.interp(x, *curve.get_data()) == pytest.approx(y, abs=close)
            else:
                nearest = np.min(np.abs(curve.get_xdata() - x))
                assert nearest < close
    assert "Re" in drawn["polars"].legends[0].get_texts()[0].get_text()


def test_a_rotor_at_rest_and_inviscid_flow_have_what_they_have(found):
    assert set(rotor_figures(found)) == {"blade", "span_loads"}
    still = pm.analyze(found.propeller, rpm=0.0, fidelity=COARSE)
    assert set(rotor_figures(still)) == {"blade"}


def test_all_of_the_blades_lie_on_the_page(drawn, tmp_path):
    from matplotlib.image import imread

    drawn["blade"].savefig(tmp_path / "blade.png")
    page = imread(tmp_path / "blade.png")[..., :3]
    is_drawn = np.any(page < 0.99, axis=-1)
    assert page.shape[1] == 1200
    assert not is_drawn[:, [0, -1]].any() and not is_drawn[[0, -1]].any()
    assert is_drawn.any(axis=0).mean() > 0.6

"""Control points: increments leave the described blade as it is, values say how they change it."""

import warnings

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import PropellerGroup

POINTS = [0.15, 0.43, 0.72, 1.0]
NAMES = ("chord_over_R", "beta", "thickness_over_chord", "camber_over_chord", "sweep_over_R")


@pytest.fixture(scope="module")
def blade_of(propeller, small):
    """``blade_of(**options)``: Problem of the small group at 4200 rpm and 8 m/s."""

    def blade_of(**options):
        prob = om.Problem(reports=False)
        group = PropellerGroup(
            propeller=propeller,
            observers=arc(1.905, [-45.0]),
            fidelity=small,
            trim="rpm",
            broadband=True,
            **options,
        )
        prob.model.add_subsystem("propeller", group, promotes=["*"])
        prob.setup(mode="rev")
        prob.set_val("rpm", 4200.0)
        prob.set_val("speed", 8.0)
        return prob

    return blade_of


@pytest.fixture(scope="module")
def described(blade_of):
    prob = blade_of()
    prob.run_model()
    return prob


@pytest.mark.parametrize("method", ["slinear", "akima", "cubic"])
def test_increments_start_from_the_described_blade_whatever_the_curve(blade_of, described, method):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        prob = blade_of(design_distributions=dict.fromkeys(NAMES, POINTS), spline_method=method)
    prob.run_model()
    for name in NAMES:
        start = np.ones(4) if name == "chord_over_R" else np.zeros(4)
        assert_allclose(prob.get_val(f"{name}_cp"), start)
        assert_allclose(prob.get_val(name), described.get_val(name), rtol=1e-14, atol=1e-16)
    for name in ("thrust", "oaspl_dba", "oaspl_total_dba"):
        assert_allclose(prob.get_val(name), described.get_val(name), rtol=1e-11)


def test_increments_are_added_and_the_chord_is_multiplied(blade_of, propeller):
    prob = blade_of(design_distributions={"beta": POINTS, "chord_over_R": POINTS})
    prob.set_val("beta_cp", [1.0, 2.0, 0.0, -1.0], units="deg")
    prob.set_val("chord_over_R_cp", [1.0, 1.2, 0.9, 1.0])
    prob.run_model()
    r = propeller.r_over_R
    added = np.interp(r, POINTS, [1.0, 2.0, 0.0, -1.0])
    assert_allclose(prob.get_val("beta", units="deg"), propeller.beta_deg + added)
    factor = np.interp(r, POINTS, [1.0, 1.2, 0.9, 1.0])
    assert_allclose(prob.get_val("chord_over_R"), propeller.c_over_R * factor)


def test_values_change_the_blade_and_say_by_how_much(blade_of, described, propeller):
    """Four straight pieces instead of the chord: what an optimiser gains from there is no gain."""
    with pytest.warns(UserWarning, match="change the described blade: chord_over_R by") as said:
        prob = blade_of(design_distributions={"chord_over_R": POINTS}, control="values")
    assert len([w for w in said if "control points" in str(w.message)]) == 1
    prob.run_model()
    r = propeller.r_over_R
    change = np.interp(r, POINTS, np.interp(POINTS, r, propeller.c_over_R)) - propeller.c_over_R
    worst = np.argmax(np.abs(change))
    assert f"by {change[worst]:+.3g} at r/R {r[worst]:.2f}" in str(said[0].message)
    assert_allclose(prob.get_val("chord_over_R")[0], propeller.c_over_R + change)
    change_dba = prob.get_val("oaspl_total_dba") - described.get_val("oaspl_total_dba")
    assert_allclose(change_dba, -0.34, atol=0.1)


def test_values_that_represent_the_blade_say_nothing(blade_of, propeller):
    with warnings.catch_warnings():
        warnings.simplefilter("error", UserWarning)
        blade_of(design_distributions={"beta": propeller.r_over_R}, control="values")


@pytest.mark.parametrize("method", ["slinear", "akima", "cubic"])
def test_derivatives_of_distributions_by_increments(blade_of, assert_totals, method):
    """From there on derivatives are those of the group, whatever the control."""
    points = {"beta": POINTS, "chord_over_R": POINTS}
    prob = blade_of(design_distributions=points, spline_method=method)
    prob.set_val("beta_cp", [1.0, 2.0, 0.5, -1.0], units="deg")
    prob.set_val("chord_over_R_cp", [1.0, 1.2, 0.9, 1.0])
    prob.run_model()
    assert_totals(prob, ["beta", "chord_over_R"], ["beta_cp", "chord_over_R_cp"])


@pytest.mark.slow
def test_derivatives_by_increments(blade_of, assert_totals):
    prob = blade_of(design_distributions={"beta": POINTS, "chord_over_R": POINTS})
    prob.run_model()
    assert_totals(prob, ["thrust", "oaspl_dba"], ["beta_cp", "chord_over_R_cp"])

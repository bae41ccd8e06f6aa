"""Loads marched in time in a group: results, derivatives forward, what is refused."""

from __future__ import annotations

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.aerodynamics.solutions.marching.limits import MarchError
from propmdao.analysis.single_point import analyze
from propmdao.components import PropellerGroup
from propmdao.components.loads import marched_aerodynamics_comp
from propmdao.components.loads.marched_aerodynamics_comp import UnsettledMarchWarning

POINT = {"rpm": 4000.0, "speed": 8.0, "incidence": 70.0}
MARCH = {"unsteady": True, "revolutions": 2, "average": 1, "timestep_deg": 30.0}
OBSERVERS = arc(1.905, [-60.0])
pytestmark = pytest.mark.filterwarnings("ignore:thrust of the march changes")


@pytest.fixture(scope="module")
def group(propeller, around):
    """Group of one march at the given options."""

    def group(**options):
        asked = {"trim": "rpm", "viscous": False, **MARCH, **options}
        return PropellerGroup(propeller=propeller, fidelity=around, **asked)

    return group


@pytest.fixture(scope="module")
def marched(group):
    """Problem that has run, set up for products forward."""
    prob = om.Problem(reports=False)
    twist = {"beta": [0.15, 0.5, 1.0]}
    propeller = group(observers=OBSERVERS, design_distributions=twist)
    prob.model.add_subsystem("propeller", propeller, promotes=["*"])
    prob.setup(mode="fwd")
    for name, value in POINT.items():
        prob.set_val(name, value)
    with pytest.warns(UnsettledMarchWarning, match="changes by .* from one revolution to the next"):
        prob.run_model()
    return prob


def test_it_is_the_march_of_the_analysis(marched, propeller, around):
    point = {"rpm": 4000.0, "speed": 8.0, "incidence_deg": 70.0}
    one = analyze(propeller, **point, **MARCH, viscous=False, observers=OBSERVERS, fidelity=around)
    result = one.to_dict()
    for name in ("thrust", "torque", "hub_force", "hub_moment"):
        assert_allclose(marched.get_val(name).ravel(), result[name], rtol=1e-9, atol=1e-12)
    level = result["observers"][0]["oaspl_db"]
    assert_allclose(marched.get_val("oaspl_db"), level, atol=1e-9)
    assert marched.get_val("load_force").shape[0] == 12  # steps of a revolution


def test_forward_derivatives_are_those_of_differences(marched):
    of = ["thrust", "torque", "oaspl_db"]
    wrt = {"beta_cp": [0.003, -0.002, 0.004], "incidence": 0.5}
    totals = marched.compute_totals(of=of, wrt=list(wrt))
    for name, along in wrt.items():
        start, ends = marched.get_val(name).copy(), {}
        for k in (-2, -1, 1, 2):
            marched.set_val(name, start + 0.5 * k * np.array(along))
            marched.run_model()
            ends[k] = {output: marched.get_val(output).copy() for output in of}
        marched.set_val(name, start)
        for output in of:
            left2, left, right, right2 = (ends[k][output] for k in (-2, -1, 1, 2))
            slope = (8.0 * (right - left) - right2 + left2) / 6.0
            exact = totals[output, name] @ np.ravel(along)
            size = np.abs(totals[output, name]) @ np.abs(np.ravel(along))  # of what adds up
            assert_allclose(exact, slope, rtol=0.0, atol=1e-4 * size.max(), err_msg=(output, name))
    marched.run_model()


@pytest.mark.slow  # a march of one blade is compiled, too
def test_from_hover_flight_is_forward(group):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("propeller", group(), promotes=["*"])
    prob.setup(mode="fwd")
    prob.set_val("rpm", POINT["rpm"])
    prob.set_val("speed", 0.0)
    prob.set_val("incidence", 30.0)
    prob.run_model()
    slope = prob.compute_totals(of=["thrust"], wrt=["speed"])["thrust", "speed"].item()
    thrust = []
    for speed in (0.0, 0.02, 0.04, 0.06):
        prob.set_val("speed", speed)
        prob.run_model()
        thrust.append(prob.get_val("thrust")[0])
    expected = np.dot([-11.0, 18.0, -9.0, 2.0], thrust) / 0.12
    assert slope == pytest.approx(expected, rel=1e-3)
    assert slope < 0.0


def test_there_are_none_backward(group):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("propeller", group(), promotes=["*"])
    prob.setup(mode="rev")
    for name, value in POINT.items():
        prob.set_val(name, value)
    prob.run_model()
    with pytest.raises(RuntimeError, match=r'forward alone.*set the problem up with.*"fwd"'):
        prob.compute_totals(of=["torque"], wrt=["rpm"])


def test_at_rest_there_is_nothing(marched):
    try:
        marched.set_val("rpm", 0.0)
        marched.run_model()
        for name in ("thrust", "torque", "hub_force", "load_force"):
            assert_allclose(marched.get_val(name), 0.0)
        assert_allclose(marched.get_val("oaspl_db"), -200.0)
    finally:
        marched.set_val("rpm", POINT["rpm"])


def test_a_march_that_diverges_or_is_too_fast_has_no_result(marched, monkeypatch):
    def diverges(*_):
        raise MarchError("the march diverges at step 7")

    try:
        with monkeypatch.context() as patched:
            patched.setattr(marched_aerodynamics_comp, "march", diverges)
            marched.set_val("speed", 9.0)
            with pytest.raises(om.AnalysisError, match="diverges at step 7"):
                marched.run_model()
        marched.set_val("rpm", 30000.0)
        with pytest.raises(om.AnalysisError, match="tip Mach number must be below 1"):
            marched.run_model()
    finally:
        for name, value in POINT.items():
            marched.set_val(name, value)
        marched.run_model()


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"trim": "thrust"}, 'a march in time needs rpm, not thrust: trim must be "rpm"'),
        ({"unsteady": False}, "revolutions is about a march in time: ask for unsteady, too"),
        ({"timestep_deg": 7.0}, "timestep_deg must divide a revolution"),
        ({"average": 3}, "average must be at most the revolutions, 2; it is 3"),
    ],
)
def test_what_cannot_be_marched_is_refused(group, options, message):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("propeller", group(**options), promotes=["*"])
    with pytest.raises(ValueError, match=message):
        prob.setup()

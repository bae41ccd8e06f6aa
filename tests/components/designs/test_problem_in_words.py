"""Design problems in words: start, limits, ranges, what is refused, and a search on one."""

from __future__ import annotations

import dataclasses
import warnings

import numpy as np
import pytest
from numpy.testing import assert_allclose

import propmdao as pm
from propmdao.components import design_problem, designed_blade, run_slsqp
from propmdao.components.designs.problem_in_words import require_words
from propmdao.propeller.design_choices import FREE, RESPONSES

POINT = pm.OperatingPoint(thrust=2.0)
POINTS = (POINT, pm.OperatingPoint(thrust=1.0, speed=8.0))
OBSERVERS = pm.arc(1.9, [-60.0, -30.0])


@pytest.fixture(scope="module")
def heard(propeller, small):
    """Problem of everything at one point, which has run at the described blade."""
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        limits = {"torque": "baseline", "tones": "baseline", "tip-mach": 0.3, "thickness": 5e-4}
        prob = design_problem(
            propeller, POINT, OBSERVERS, free=tuple(FREE), limits=limits, fidelity=small
        )
        prob.run_model()
    return prob


def test_it_starts_at_the_described_blade(heard, propeller):
    blade = designed_blade(heard, "new")
    assert blade.name == "new" and propeller.name in blade.source
    for name in ("c_over_R", "beta_deg", "sweep_over_R"):
        assert_allclose(getattr(blade, name), getattr(propeller, name), atol=1e-12)
    rpm, fidelity = heard.get_val("rpm").item(), heard.model.propeller.options["fidelity"]
    described, changed = (pm.analyze(of, rpm=rpm, fidelity=fidelity) for of in (propeller, blade))
    assert_allclose(float(described.loads.thrust), POINT.thrust, rtol=1e-6)
    assert_allclose(float(changed.loads.torque), float(described.loads.torque), rtol=1e-9)
    assert_allclose(heard.get_val("torque"), float(described.loads.torque), rtol=1e-6)


def test_levels_are_of_the_mean_square_over_observers(heard):
    for word, output in (("dba", "oaspl_total_dba"), ("tones", "oaspl_db")):
        levels = heard.get_val(output)
        mean = 10.0 * np.log10(np.mean(10.0 ** (levels / 10.0)))
        assert_allclose(heard.get_val(f"mean_{word}"), mean)
        assert RESPONSES[word].output == output


def test_limits_in_words_are_constraints_with_numbers(heard, propeller):
    constraints = heard.model.get_constraints()
    by_name = {meta["name"]: meta for meta in constraints.values()}
    assert_allclose(by_name["torque"]["upper"], heard.get_val("torque"))
    assert_allclose(by_name["mean_tones"]["upper"], heard.get_val("mean_tones"))
    assert_allclose(by_name["tip_mach"]["upper"], 0.3)
    turns = heard.get_val("rpm")[0] / 60.0
    assert_allclose(heard.get_val("tip_mach"), np.pi * propeller.diameter * turns / 340.294)
    # Nowhere thinner than asked for, or than it is where it is thinner already.
    now = heard.get_val("section_thickness", units="m")
    assert_allclose(by_name["section_thickness"]["lower"], np.minimum(now, 5e-4))
    assert now.min() < 5e-4 < now.max()
    assert_allclose(heard.get_val("chord_factor"), 1.0)
    (objective,) = heard.model.get_objectives().values()
    assert objective["name"] == "mean_dba"


def test_ranges_keep_to_what_the_polars_know(heard, propeller):
    variables = {meta["name"]: meta for meta in heard.model.get_design_vars().values()}
    assert set(variables) == {f"{free.distribution}_cp" for free in FREE.values()}
    assert_allclose(variables["chord_over_R_cp"]["lower"], 0.7)
    assert_allclose(variables["beta_cp"]["upper"], 8.0)
    assert variables["sweep_over_R_cp"]["size"] == 4  # the root is not swept
    camber = heard.get_val("camber_over_chord")
    lower, upper = (variables["camber_over_chord_cp"][end] for end in ("lower", "upper"))
    assert np.all(lower <= 0.0) and np.all(upper >= 0.0)
    highest = max(0.09, camber.max())
    assert np.all(np.interp([0.2, 1.0], propeller.r_over_R, camber) + upper[[0, -1]] <= highest)


@pytest.mark.slow
def test_derivatives_of_the_objective_are_those_of_differences(heard):
    name, step = "beta_cp", 1e-4
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        exact = heard.compute_totals(["mean_dba"], [name], driver_scaling=False)
    (slope,) = exact.values()
    start, ends = heard.get_val(name).copy(), []
    for side in (1.0, -1.0):
        moved = start.copy()
        moved[2] += side * step
        heard.set_val(name, moved)
        heard.run_model()
        ends.append(heard.get_val("mean_dba")[0])
    heard.set_val(name, start)
    heard.run_model()
    differences = (ends[0] - ends[1]) / (2.0 * step)
    assert_allclose(slope.ravel()[2], differences, rtol=1e-4)


def test_two_points_share_a_blade_that_needs_less_power_in_the_mean(propeller, small, tmp_path):
    prob = design_problem(
        propeller, POINTS, free={"twist": (-5.0, 5.0)}, minimise="power",
        limits={"torque": "baseline"}, fidelity=small,
    )  # fmt: skip
    told: list[float] = []
    history = run_slsqp(
        prob, tmp_path / "cases.sql", iterations=4, watch=lambda n, trial, _: told.append(n)
    ).history
    assert told == list(range(1, history.objective.size + 1))
    assert history.objective[-1] < 0.995 * history.objective[0]
    assert history.violation[-1] < 1e-4
    assert_allclose(prob.get_val("thrust"), [2.0, 1.0], rtol=1e-6)
    assert_allclose(prob.get_val("mean_power"), prob.get_val("shaft_power").mean())
    blade = designed_blade(prob, "better")
    assert_allclose(blade.c_over_R, propeller.c_over_R)
    found = zip(POINTS, prob.get_val("rpm"), prob.get_val("torque"), strict=True)
    for point, rpm, torque in found:
        again = pm.analyze(blade, rpm=rpm, speed=point.speed, fidelity=small)
        assert_allclose(float(again.loads.thrust), point.thrust, rtol=1e-6)
        assert_allclose(float(again.loads.torque), torque, rtol=1e-6)


FLIGHT = pm.OperatingPoint(thrust=1.5, speed=12.0, incidence_deg=70.0)


def fastest_tip(propeller, omega):
    """Mach number of the tip where the blade advances in that flight."""
    lean = np.radians(70.0)
    across, along = 12.0 * np.sin(lean), 12.0 * np.cos(lean)
    return np.hypot(0.5 * propeller.diameter * omega + across, along) / 340.294


def test_a_point_at_an_incidence_has_a_tilted_group(propeller, around):
    """The tip is fastest where the blade advances."""
    prob = design_problem(
        propeller, FLIGHT, OBSERVERS, free=("twist",), minimise="power",
        limits={"tip-mach": 0.5}, fidelity=around, viscous=False,
    )  # fmt: skip
    prob.run_model()
    assert prob.model.propeller.options["tilted"]
    assert_allclose(prob.get_val("incidence", units="deg"), 70.0)
    assert_allclose(prob.get_val("thrust"), 1.5, rtol=1e-8)
    omega = prob.get_val("rpm", units="rad/s")
    assert_allclose(prob.get_val("tip_mach"), fastest_tip(propeller, omega), rtol=1e-9)


@pytest.fixture(scope="module")
def leaning(propeller, around):
    """Problem of hover and of a drone that leans forward by 20 deg, which has run."""
    points = (POINT, FLIGHT)
    prob = design_problem(
        propeller, points, free=("twist",), minimise="power",
        limits={"torque": "baseline", "tip-mach": 0.5}, fidelity=around, viscous=False,
    )  # fmt: skip
    prob.run_model()
    return prob, points


@pytest.mark.slow
def test_points_at_an_incidence_are_those_of_the_analysis(leaning, propeller, around):
    prob, points = leaning
    assert prob.model.propeller.options["tilted"]
    flight = pm.analyze(propeller, points[1], fidelity=around, viscous=False)
    assert_allclose(prob.get_val("incidence", units="deg"), [0.0, 70.0])
    assert_allclose(prob.get_val("rpm")[1], flight.rpm, rtol=1e-8)
    assert_allclose(prob.get_val("shaft_power")[1], flight.to_dict()["shaft_power"], rtol=1e-8)
    assert_allclose(prob.get_val("mean_power"), prob.get_val("shaft_power").mean())
    omega = prob.get_val("rpm", units="rad/s")
    tip = [0.5 * propeller.diameter * omega[0] / 340.294, fastest_tip(propeller, omega[1])]
    assert_allclose(prob.get_val("tip_mach"), tip, rtol=1e-9)


@pytest.mark.slow
def test_a_search_at_an_incidence_finds_a_blade_that_keeps_its_limits(leaning, around, tmp_path):
    prob, points = leaning
    history = run_slsqp(prob, tmp_path / "cases.sql", iterations=4).history
    assert history.objective[-1] < 0.99 * history.objective[0]
    assert history.violation[-1] < 1e-4
    blade = designed_blade(prob, "leaning")
    again = pm.analyze(blade, points[1], fidelity=around, viscous=False)
    assert_allclose(again.to_dict()["shaft_power"], prob.get_val("shaft_power")[1], rtol=1e-6)


def test_the_mach_number_of_the_tip_is_known_where_nothing_else_takes_the_speed_of_sound(
    propeller, small
):
    cold = dataclasses.replace(POINT, air=pm.Air(sound_speed=320.0))
    prob = design_problem(
        propeller, cold, minimise="torque", limits={"tip-mach": 0.3}, viscous=False, fidelity=small
    )
    prob.run_model()
    turns = prob.get_val("rpm")[0] / 60.0
    assert_allclose(prob.get_val("tip_mach"), np.pi * propeller.diameter * turns / 320.0)


@pytest.mark.parametrize(
    ("given", "message"),
    [
        ({"points": ()}, "needs an operating point"),
        ({"points": (pm.OperatingPoint(rpm=4000.0),)}, "at a thrust, not at an rpm"),
        ({"free": ()}, "nothing is free"),
        ({"free": ("chords",)}, "free: there is no 'chords'; there are chord, twist"),
        ({"free": {"chord": (1.1, 1.5)}}, "must include the described blade, 1"),
        ({"free": {"chord": (0.0, 1.5)}}, "end of the range of chord must be within 0.1 ..."),
        ({"free": {"twist": (-99.0, 1.5)}}, "end of the range of twist must be within -60"),
        ({"minimise": "noise"}, "minimise: there is no 'noise'; there are dba"),
        ({"limits": {"weight": 1.0}}, "limit: there is no 'weight'"),
        ({"limits": {"dba": 50.0}}, "dba is minimised"),
        ({"limits": {"torque": -1.0}}, "limit of torque must be within"),
        ({"limits": {"thickness": 2.0}}, "least thickness must be within"),
        ({"limits": {"thickness": "baseline"}}, "least thickness must be a number"),
        ({"free": ("twist",), "limits": {"thickness": 1e-3}}, "limit on a free chord or thickness"),
        ({"n_observers": 0}, "dba is heard by observers: there are none"),
        ({"n_control": 4}, "number of control points must be within 5 ... 20"),
    ],
)
def test_what_is_no_design_problem_is_refused_in_one_line(given, message):
    asked = {"points": (POINT,), "free": ("chord", "twist"), "minimise": "dba", "limits": {}}
    with pytest.raises(ValueError, match=message.replace("(", r"\(")) as raised:
        require_words(**{**asked, "n_control": 5, "n_observers": 2, **given})
    assert "\n" not in str(raised.value)


def test_nobody_hears_and_a_blade_out_of_reach(propeller, small):
    with pytest.raises(ValueError, match="dba is heard by observers: there are none"):
        design_problem(propeller, POINT)
    far = dataclasses.replace(POINT, thrust=500.0)
    with pytest.raises(ValueError, match="described blade cannot be analysed.*out of reach"):
        design_problem(propeller, far, minimise="power", fidelity=small)

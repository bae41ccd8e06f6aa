"""The diameter as a variable: similarity, another description, bounds that follow, failures."""

import dataclasses

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import (
    AerodynamicsComp,
    PropellerGroup,
    RotationSpeedComp,
    TrimmedAerodynamicsComp,
)

OBSERVERS = arc(1.905, [-45.0, 0.0])
PERFORMANCE = ["thrust", "torque", "shaft_power", "efficiency", "J", "CT", "CQ", "CP"]


@pytest.fixture(scope="module")
def problem(propeller, small):
    """Problem with a `PropellerGroup` at 8 m/s, at the values given; run it."""

    def problem(values, **options):
        options = {"propeller": propeller, "fidelity": small, **options}
        prob = om.Problem(PropellerGroup(**options), reports=False)
        prob.setup()
        for name, value in {"speed": 8.0, **values}.items():
            prob.set_val(name, value)
        return prob

    return problem


def performance(prob):
    prob.run_model()
    return {name: prob.get_val(name)[0] for name in PERFORMANCE}


def test_it_is_that_of_a_propeller_described_so(problem, propeller):
    """Meshes, polars at other Reynolds numbers, bounds of the trim, tones and noise alike."""
    options = {"observers": OBSERVERS, "broadband": True}
    twice = dataclasses.replace(propeller, diameter=2.0 * propeller.diameter)
    described = problem({"thrust_required": 5.0}, propeller=twice, **options)
    scaled = problem({"thrust_required": 5.0, "diameter": twice.diameter}, **options)
    for prob in (described, scaled):
        prob.run_model()
    outputs = {m["prom_name"] for m in scaled.model.get_io_metadata(iotypes="output").values()}
    assert {"section_polars", "rpm", "torque", "oaspl_total_dba"} <= outputs
    for name in outputs:
        expected = described.get_val(name)
        # to rounding, which the searches pass on
        atol = 1e-11 * np.abs(expected).max()
        assert_allclose(scaled.get_val(name), expected, rtol=0.0, atol=atol, err_msg=name)


@pytest.fixture(scope="module")
def at_scale(problem):
    """Performance in inviscid flow at so many times the diameter, rotation and flight speed."""

    def at_scale(diameter, rpm, speed):
        values = {"diameter": 0.2794 * diameter, "rpm": 4200.0 * rpm, "speed": 8.0 * speed}
        return performance(problem(values, trim="rpm", viscous=False))

    return at_scale


def test_similar_flows_have_equal_coefficients(at_scale):
    """Where V D and n D^2 are kept, the wake's cores grow alike, too, and all is similar."""
    one, twice = at_scale(1.0, 1.0, 1.0), at_scale(2.0, 0.25, 0.5)
    for name in ("J", "CT", "CQ", "CP", "efficiency", "thrust"):
        assert_allclose(twice[name], one[name], rtol=1e-9, err_msg=name)
    assert_allclose(twice["torque"], 2.0 * one["torque"], rtol=1e-9)


def test_thrust_is_as_the_square_of_the_diameter_at_one_tip_speed(at_scale):
    one, twice = at_scale(1.0, 1.0, 1.0), at_scale(2.0, 0.5, 1.0)
    assert_allclose(twice["J"], one["J"], rtol=1e-12)
    # the viscous growth of the wake's cores is the one thing that has a scale of its own
    for name in ("CT", "CP"):
        assert_allclose(twice[name], one[name], rtol=1e-5, err_msg=name)
        assert twice[name] != one[name]
    assert_allclose(twice["thrust"], 4.0 * one["thrust"], rtol=1e-5)


def test_bounds_of_the_tip_speed_follow_the_diameter(problem, propeller):
    values = {"diameter": 10.0 * propeller.diameter, "thrust_required": 5.0, "speed": 0.5}
    large = problem(values, observers=OBSERVERS)
    large.run_model()
    # the least rotation speed of the propeller as described is 232 rpm
    assert large.get_val("rpm")[0] < 60.0
    assert_allclose(large.get_val("thrust"), 5.0, rtol=1e-6)
    for diameter in (0.2794, 2.794):
        large.set_val("diameter", diameter)
        large.set_val("thrust_required", 5e4)
        low, high = (tip_speed * 60.0 / (np.pi * diameter) for tip_speed in (3.40294, 306.2646))
        with pytest.raises(om.AnalysisError, match=f"at {low:g} rpm, .* N at {high:g} rpm"):
            large.run_model()


def test_a_propeller_that_grows_into_an_observer_is_a_failed_analysis(problem):
    for broadband in (False, True):
        options = {"observers": arc(0.2, [-45.0, 0.0]), "broadband": broadband}
        with pytest.raises(om.AnalysisError, match="observer 1 is inside the source region"):
            problem({"diameter": 0.5}, **options).run_model()


def test_bounds_that_are_given_stay(problem, propeller):
    values = {"diameter": 2.0 * propeller.diameter, "thrust_required": 500.0}
    prob = problem(values, rpm_bounds=(1000.0, 5000.0), observers=OBSERVERS)
    with pytest.raises(om.AnalysisError, match=r"at 1000 rpm, .* N at 5000 rpm"):
        prob.run_model()


@pytest.mark.parametrize("diameter", [0.0, -0.2])
def test_no_diameter_is_a_failed_analysis(problem, diameter):
    reason = f"diameter must be positive; it is {diameter:g} m"
    with pytest.raises(om.AnalysisError, match=reason):
        problem({"diameter": diameter}).run_model()


@pytest.mark.parametrize("kind", [AerodynamicsComp, TrimmedAerodynamicsComp, RotationSpeedComp])
def test_no_diameter_is_a_failed_analysis_of_a_component(kind, small, meshes, problem_of):
    nodes = meshes.get_val("lattice_nodes")
    prob = problem_of(kind(n_blades=2, fidelity=small), lattice_nodes=nodes, diameter=-0.2)
    with pytest.raises(om.AnalysisError, match="diameter must be positive; it is -0.2 m"):
        prob.run_model()


def test_a_model_can_have_a_default_of_its_own(propeller, small):
    prob = om.Problem(reports=False)
    group = PropellerGroup(propeller=propeller, fidelity=small)
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    prob.model.set_input_defaults("diameter", val=12.0, units="inch")
    prob.setup()
    prob.final_setup()
    assert_allclose(prob.get_val("diameter", units="m"), 0.3048)


def test_it_is_shared_by_all_operating_points(problem, propeller):
    prob = problem({"thrust_required": [1.2, 1.2]}, num_nodes=2)
    prob.final_setup()
    assert_allclose(prob.get_val("diameter"), [propeller.diameter])
    tags = [
        meta["tags"]
        for meta in prob.model.get_io_metadata(iotypes="input", metadata_keys=["tags"]).values()
        if meta["prom_name"] == "diameter"
    ]
    assert tags
    assert all("dymos.static_target" in of_input for of_input in tags)

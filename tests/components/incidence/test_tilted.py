"""Components in flight at an incidence: loads of the hub, tones, nodes, refusals, derivatives."""

import dataclasses

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.aerodynamics.wakes.edgewise import FastEdgewiseWarning, longer
from propmdao.analysis.single_point import analyze
from propmdao.components import PropellerGroup, TrimmedAerodynamicsComp

OBSERVERS = arc(1.905, [-90.0, -60.0])
POINT = {"speed": 8.0, "incidence": 80.0, "thrust_required": 2.0}
#: Hover and a drone that leans forward by 20 deg: nodes of one design.
MIXED = {
    "speed": np.array([0.0, 10.0]),
    "incidence": np.array([70.0, 70.0]),
    "thrust_required": np.array([2.5, 2.5]),
}


@pytest.fixture(scope="module")
def problem(propeller, around):
    """Problem with a tilted `PropellerGroup` of so many nodes at the given values."""

    def problem(num_nodes, values, **options):
        options = {"propeller": propeller, "fidelity": around, "tilted": True, **options}
        prob = om.Problem(reports=False)
        group = PropellerGroup(num_nodes=num_nodes, **options)
        prob.model.add_subsystem("propeller", group, promotes=["*"])
        prob.setup(mode="rev")
        for name, value in values.items():
            prob.set_val(name, value)
        prob.run_model()
        return prob

    return problem


@pytest.fixture(scope="module")
def edgewise(problem):
    return problem(None, POINT, observers=OBSERVERS, viscous=False)


def test_hub_loads_are_outputs_in_axes_that_do_not_turn(edgewise):
    assert edgewise.get_val("thrust")[0] == pytest.approx(2.0, rel=1e-8)
    force, moment = edgewise.get_val("hub_force"), edgewise.get_val("hub_moment")
    assert force[2] == pytest.approx(edgewise.get_val("thrust")[0], rel=1e-12)
    assert moment[2] == pytest.approx(-edgewise.get_val("torque")[0], rel=1e-12)
    # The side that advances carries more: the rotor is rolled to the one that retreats, +y.
    assert moment[0] < 0.0
    on_fluid = edgewise.get_val("load_force")
    assert_allclose(-2.0 * on_fluid[..., 2].sum(axis=1).mean(), force[2], rtol=1e-12)
    assert edgewise.get_val("hub_force", units="lbf")[2] == pytest.approx(2.0 / 4.4482216, rel=1e-6)


def test_unsteady_loading_is_heard_on_the_axis(edgewise):
    # Steady loads have no tone there at all.
    assert edgewise.get_val("spl_bpf_db")[0] > 40.0
    assert edgewise.get_val("oaspl_loading_db")[0] > edgewise.get_val("oaspl_thickness_db")[0] + 40


def test_a_propeller_at_rest_is_zeros_and_silence(edgewise):
    try:
        edgewise.set_val("thrust_required", 0.0)
        edgewise.run_model()
        for name in ("rpm", "torque", "hub_force", "hub_moment", "load_force"):
            assert_allclose(edgewise.get_val(name), 0.0)
        assert_allclose(edgewise.get_val("oaspl_db"), -200.0)
    finally:
        edgewise.set_val("thrust_required", POINT["thrust_required"])
        edgewise.run_model()


def test_fast_edgewise_flight_is_warned_of(edgewise):
    try:
        edgewise.set_val("speed", 25.0)
        with pytest.warns(FastEdgewiseWarning, match="is above 0.3: the retreating side stalls"):
            edgewise.run_model()
        edgewise.set_val("incidence", 151.0)
        with pytest.raises(om.AnalysisError, match="must be within 0 ... 150 deg; it is 151"):
            edgewise.run_model()
    finally:
        for name, value in POINT.items():
            edgewise.set_val(name, value)
        edgewise.run_model()


def test_the_rule_of_the_thesis_is_of_axial_flight(problem):
    with pytest.raises(ValueError, match='"two_point" is of axial flight: tilted must be False'):
        problem(None, {}, trim_method="two_point")


@pytest.mark.slow
def test_each_node_is_the_analysis_of_its_point(problem, propeller, around):
    """Hover, in its longer wake, beside flight at an incidence."""
    prob = problem(2, MIXED, observers=OBSERVERS, broadband=True)
    for node in range(2):
        speed, incidence, thrust = (float(values[node]) for values in MIXED.values())
        one = analyze(
            propeller,
            thrust=thrust,
            speed=speed,
            incidence_deg=incidence,
            fidelity=around,
            observers=OBSERVERS,
            broadband=True,
        )
        assert prob.get_val("rpm")[node] == pytest.approx(one.rpm, rel=1e-9)
        for name in ("hub_force", "hub_moment"):
            expected = getattr(one.loads, name)
            assert_allclose(prob.get_val(name)[node], expected, rtol=1e-8, atol=1e-10)
        for name in ("oaspl_db", "oaspl_total_dba"):
            levels = [observer[name] for observer in one.to_dict()["observers"]]
            assert_allclose(prob.get_val(name)[node, 1:], levels[1:], rtol=0.0, atol=1e-6)


@pytest.mark.slow
def test_without_incidence_it_is_the_steady_lattice(problem, around):
    values = {"speed": 8.0, "thrust_required": 1.2}
    alike = dataclasses.replace(around, wake=longer(around.period_wake))
    ours, steady = (
        problem(None, values, fidelity=alike, tilted=tilted) for tilted in (True, False)
    )
    for name in ("rpm", "torque", "efficiency", "CT"):
        assert_allclose(ours.get_val(name), steady.get_val(name), rtol=1e-8, err_msg=name)
    assert_allclose(ours.get_val("hub_force")[:2], 0.0, atol=1e-9)
    with pytest.raises(KeyError):
        steady.get_val("hub_force")


@pytest.mark.slow
def test_totals_against_differences(problem, assert_totals, point_inputs):
    # Close to hover, but differences go to either side.
    values = {**MIXED, "speed": np.array([0.5, 10.0])}
    prob = problem(2, values, observers=OBSERVERS[1:], broadband=True)
    wrt = ["diameter", "beta", "chord_over_R", "observer_position"]
    wrt += point_inputs(prob.model.propeller)
    assert "incidence" in wrt
    of = ["rpm", "torque", "hub_force", "hub_moment", "oaspl_db", "oaspl_total_dba"]
    assert_totals(prob, of, wrt)


@pytest.mark.slow
@pytest.mark.parametrize("loads", [False, True])
def test_forward_and_reverse_products_of_the_lattice(
    meshes, around, polars, problem_of, assert_directional, loads
):
    """Without loads the products are sums over kept gradients."""
    prob = problem_of(
        TrimmedAerodynamicsComp(
            n_blades=2, fidelity=around, polars=polars, tilted=True, loads=loads
        ),
        speed=10.0,
        incidence=70.0,
        thrust_required=2.5,
    )
    for name in ("lattice_nodes", "diameter", "section_polars", "section_thickness_over_chord"):
        prob.set_val(name, meshes.get_val(name))
    prob.run_model()
    assert_directional(prob, 1e-5, forward=True)

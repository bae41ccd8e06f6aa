"""Blade elements in the components: values of the analysis, exact derivatives, refusals."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

import propmdao as pm
from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import (
    AerodynamicsComp,
    PropellerGroup,
    TrimmedAerodynamicsComp,
    design_problem,
)
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS, RESULTS

OBSERVERS = arc(1.905, [-45.0, 0.0])
ROTOR = {"n_blades": 2, "blade_element": True}


@pytest.fixture
def group(propeller, small):
    """Problem with a `PropellerGroup` of blade elements, set up."""

    def group(**options):
        options = {"propeller": propeller, "fidelity": small, "blade_element": True, **options}
        prob = om.Problem(reports=False)
        prob.model.add_subsystem("propeller", PropellerGroup(**options), promotes=["*"])
        prob.setup(mode="rev")
        return prob

    return group


@pytest.mark.parametrize("broadband", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_the_group_has_what_an_analysis_has(group, propeller, small, broadband):
    """Loads, tones and broadband noise, of the rotation speed that the thrust needs."""
    prob = group(observers=OBSERVERS, broadband=broadband)
    prob.set_val("speed", 8.0)
    prob.set_val("thrust_required", 1.2)
    prob.run_model()
    expected = pm.analyze(
        propeller, rpm=prob.get_val("rpm").item(), speed=8.0, blade_element=True,
        broadband=broadband, observers=OBSERVERS, fidelity=small,
    ).to_dict()  # fmt: skip
    assert_allclose(expected["thrust"], 1.2, rtol=1e-8)
    for name in ("thrust", "torque", "shaft_power", "eta", "J", "CT", "CQ"):
        quantity = RESULTS[name]
        value = prob.get_val(quantity.variable)
        assert_allclose(value, expected[quantity.json], rtol=1e-7, err_msg=name)
    for quantity in {**LEVELS, **(BROADBAND_LEVELS if broadband else {})}.values():
        levels = [observer[quantity.json] for observer in expected["observers"]]
        assert_allclose(prob.get_val(quantity.variable), levels, atol=1e-6, err_msg=quantity.name)
    assert prob.get_val("circulation").shape == (1, small.n_spanwise)
    on_fluid = prob.get_val("load_force")
    assert on_fluid.shape == (small.n_spanwise, 3)
    assert_allclose(-2.0 * on_fluid[:, 2].sum(), 1.2, rtol=1e-8)


AT_RPM = (AerodynamicsComp, {"rpm": 4200.0})
TRIMMED = (TrimmedAerodynamicsComp, {"thrust_required": 1.2})


@pytest.mark.parametrize(
    ("component", "drive", "forward"),
    [
        (*AT_RPM, False),
        pytest.param(*AT_RPM, True, marks=pytest.mark.slow),  # which compiles as long again
        pytest.param(*TRIMMED, True, marks=pytest.mark.slow),
    ],
)
def test_derivatives_forward_and_back(
    meshes, problem_of, small, polars, assert_directional, component, drive, forward
):
    prob = problem_of(
        component(**ROTOR, fidelity=small, polars=polars),
        lattice_nodes=meshes.get_val("lattice_nodes"),
        section_polars=meshes.get_val("section_polars"),
        diameter=0.2794,
        speed=8.0,
        **drive,
    )
    prob.run_model()
    assert_directional(prob, 1e-6, forward)


@pytest.mark.slow  # nodes of the lattice stand still in the tests of its group
def test_nodes_and_rest(group):
    """A node that stands still is zeros; the others are what they are alone."""
    prob = group(num_nodes=3)
    prob.set_val("speed", [0.0, 5.0, 8.0])
    prob.set_val("thrust_required", [1.2, 0.0, 0.8])
    prob.run_model()
    rpm, torque = prob.get_val("rpm"), prob.get_val("torque")
    assert rpm[1] == torque[1] == 0.0
    alone = group()
    alone.set_val("speed", 8.0)
    alone.set_val("thrust_required", 0.8)
    alone.run_model()
    assert_allclose([rpm[2], torque[2]], np.ravel([alone["rpm"], alone["torque"]]), rtol=1e-12)


@pytest.mark.slow
def test_at_an_incidence(group, propeller, around):
    """The tilted group has the analysis' numbers, and derivatives of its own kind."""
    prob = group(tilted=True, fidelity=around, observers=OBSERVERS)
    for name, value in {"speed": 8.0, "incidence": 70.0, "thrust_required": 1.5}.items():
        prob.set_val(name, value)
    prob.run_model()
    expected = pm.analyze(
        propeller, thrust=1.5, speed=8.0, incidence_deg=70.0, blade_element=True,
        observers=OBSERVERS, fidelity=around,
    )  # fmt: skip
    assert_allclose(prob.get_val("torque"), float(expected.loads.torque), rtol=1e-7)
    assert_allclose(prob.get_val("spl_bpf_db"), expected.spl_bpf_db(), atol=1e-6)
    totals = prob.compute_totals(of=["torque", "hub_moment"], wrt=["incidence", "speed"])
    for name, step in (("incidence", 1e-3), ("speed", 1e-3)):
        start, ends = prob.get_val(name).copy(), []
        for sign in (1.0, -1.0):
            prob.set_val(name, start + sign * step)
            prob.run_model()
            ends.append([prob.get_val("torque")[0], *prob.get_val("hub_moment")])
        prob.set_val(name, start)
        slope = (np.array(ends[0]) - ends[1]) / (2.0 * step)
        exact = np.concatenate([totals[of, name].ravel() for of in ("torque", "hub_moment")])
        assert_allclose(exact, slope, rtol=1e-5, atol=1e-9)


@pytest.mark.parametrize(
    ("options", "words"),
    [
        ({"unsteady": True, "trim": "rpm"}, "blade elements have no wake to march"),
        ({"trim_method": "two_point"}, 'trim_method "two_point" is of the lattice: blade_element'),
    ],
)
def test_what_blade_elements_cannot_do_is_refused(group, options, words):
    with pytest.raises(ValueError, match=words):
        group(**options)


def test_a_design_problem_by_blade_elements(propeller, small):
    """One word makes the problem one of the lower rung."""
    point = pm.OperatingPoint(thrust=2.0, speed=4.0)
    words = {"free": ("twist",), "minimise": "power", "n_control": 5, "fidelity": small}
    prob = design_problem(propeller, point, **words, blade_element=True)
    prob.run_model()
    rpm = prob.get_val("rpm").item()
    loads = pm.analyze(propeller, rpm=rpm, speed=4.0, blade_element=True, fidelity=small).loads
    assert_allclose(float(loads.thrust), 2.0, rtol=1e-6)
    assert_allclose(prob.get_val("torque"), float(loads.torque), rtol=1e-6)

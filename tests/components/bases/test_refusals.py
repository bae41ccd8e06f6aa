"""What components refuse in one line: points nobody flies, numbers that are none, complex steps."""

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import (
    AcousticsComp,
    AerodynamicsComp,
    BroadbandComp,
    NoiseObjectiveComp,
    PropellerGroup,
    RotationSpeedComp,
    TrimmedAerodynamicsComp,
)
from propmdao.components.bases.jax_component import JaxComponent
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.records.air import Air
from propmdao.records.states import OperatingPoint

OBSERVERS = arc(1.905, [-45.0, 0.0])


@pytest.fixture
def pair(problem_of, propeller, small, meshes):
    """``pair(component)``: Problem of one at two operating points, the first at rest."""

    def pair(component):
        options = {"num_nodes": 2, "fidelity": small}
        if component in (AcousticsComp, BroadbandComp):
            options["observers"] = OBSERVERS
        if component is AcousticsComp:
            options["n_loads"] = 3
        if component is BroadbandComp:
            options["propeller"] = propeller
        else:
            options["n_blades"] = 2
        prob = problem_of(component(**options))
        inputs = prob.model.comp.get_io_metadata(iotypes="input")
        for name in ("lattice_nodes", "surface_nodes"):
            if name in inputs:
                prob.set_val(name, meshes.get_val(name))
        prob.set_val("speed", [8.0, 8.0])
        drive = "rpm" if "rpm" in inputs else "thrust_required"
        prob.set_val(drive, [0.0, 1.2 if drive == "thrust_required" else 4000.0])
        return prob

    return pair


POINTS = [
    (component, name, value)
    for component in (
        AerodynamicsComp,
        TrimmedAerodynamicsComp,
        RotationSpeedComp,
        AcousticsComp,
        BroadbandComp,
    )
    for name, value in (("speed", -2.0), ("rpm", -5000.0), ("density", 0.0))
    if name != "rpm" or component not in (TrimmedAerodynamicsComp, RotationSpeedComp)
]


@pytest.mark.parametrize(("component", "name", "value"), POINTS)
def test_points_that_the_command_line_refuses_are_refused_in_its_words(
    pair, component, name, value
):
    """With the node, and at rest, too, where nothing is computed."""
    asked = {"air": Air(density=value)} if name == "density" else {name: value}
    with pytest.raises(ValueError, match="must be") as refused:
        OperatingPoint(**{"rpm": 4000.0, **asked})
    for node in (0, 1):
        prob = pair(component)
        values = prob.get_val(name).copy()
        values[node] = value
        prob.set_val(name, values)
        with pytest.raises(om.AnalysisError, match=f"node {node}: {refused.value}$"):
            prob.run_model()


@pytest.mark.parametrize("options", [{"trim": "rpm"}, {"observers": OBSERVERS}])
def test_descent_is_refused_by_the_group(propeller, small, options):
    prob = om.Problem(reports=False)
    group = PropellerGroup(propeller=propeller, fidelity=small, **options)
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    prob.setup()
    prob.set_val("speed", -2.0)
    with pytest.raises(om.AnalysisError, match="speed must be within 0 ... 1000 m/s; it is -2$"):
        prob.run_model()


@pytest.mark.parametrize("component", [AerodynamicsComp, AcousticsComp, TrimmedAerodynamicsComp])
def test_a_nan_among_the_inputs_is_named(pair, component):
    for name in ("density", "speed"):
        prob = pair(component)
        prob.set_val(name, [1.0, np.nan])
        with pytest.raises(om.AnalysisError, match=f"node 1: input {name} is nan$"):
            prob.run_model()


class Roots(NodesComp):
    """y = sqrt(x - 1) at each of two observers; no number below 1, no derivative at 1."""

    def setup(self):
        self.add_point_input("rpm", 4000.0)
        self.add_point_input("x", shape=(2,))
        self.add_point_output("y", shape=(2,))
        self.axes = {"y": ("observer",)}
        self.function = _roots


def _roots(inputs, constants, static):
    return {"y": jnp.sqrt(inputs["x"] - 1.0)}


class Root(JaxComponent):
    """The same without operating points."""

    def setup(self):
        self.add_input("x", shape=(2,))
        self.add_output("y", shape=(2,))
        self.function = _roots


def test_a_result_that_is_no_number_is_named_with_its_place(problem_of):
    prob = problem_of(Roots(num_nodes=2), x=[[2.0, 2.0], [2.0, 0.0]])
    with pytest.raises(om.AnalysisError, match="node 1: y of observer 2 is nan, at 4000 rpm$"):
        prob.run_model()
    prob = problem_of(Root(), x=[np.inf, 2.0])
    with pytest.raises(om.AnalysisError, match="input x of entry 1 is inf$"):
        prob.run_model()


def test_designs_of_a_batch_are_refused_one_by_one(problem_of):
    prob = problem_of(Root(), x=[2.0, 2.0])
    prob.run_model()
    designs = [{"x": np.array(x)} for x in ([2.0, np.nan], [5.0, 10.0], [0.0, 2.0])]
    refused, good, failed = prob.model.comp.evaluate_designs(designs, 4)
    assert str(refused) == "input x of entry 2 is nan"
    assert np.array_equal(good["y"], [2.0, 3.0])
    assert str(failed) == "y of entry 1 is nan"


@pytest.mark.parametrize("mode", ["fwd", "rev"])
@pytest.mark.parametrize("component", [Roots, Root])
def test_a_derivative_that_is_no_number_is_a_failure(component, mode):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", component(), promotes=["*"])
    prob.setup(mode=mode)
    prob.set_val("x", [1.0, 2.0])
    prob.run_model()
    with pytest.raises(om.AnalysisError, match="derivative at [xy] of entry 1 is (inf|nan)"):
        prob.compute_totals(of=["y"], wrt=["x"])


def test_levels_that_are_no_numbers_have_no_soft_maximum(problem_of):
    prob = problem_of(NoiseObjectiveComp(shape=3), level_db=[40.0, np.nan, 41.0])
    with pytest.raises(om.AnalysisError, match="input level_db of entry 2 is nan"):
        prob.run_model()


@pytest.mark.parametrize("component", [Roots, Root])
def test_complex_step_is_refused_in_one_line(component):
    """By the bases of all components."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", component(), promotes=["*"])
    prob.setup(force_alloc_complex=True)
    prob.set_val("x", [3.0, 2.0])
    prob.run_model()
    message = 'has exact derivatives and no complex step: check them with method="fd"'
    with pytest.raises(RuntimeError, match=message):
        prob.check_totals(of=["y"], wrt=["x"], method="cs", out_stream=None)
    prob.set_complex_step_mode(False)
    prob.set_complex_step_mode(True)
    with pytest.raises(RuntimeError, match=message):
        prob.compute_totals(of=["y"], wrt=["x"])
    prob.set_complex_step_mode(False)
    with pytest.raises(RuntimeError, match=message):
        prob.check_partials(method="cs", out_stream=None)

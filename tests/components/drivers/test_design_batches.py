"""Several designs in one call: each run is what it would be alone, failures included."""

import csv
import itertools

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import DifferentialEvolutionDriver, PropellerGroup, SweepDriver
from propmdao.components.bases.jax_component import JaxComponent
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.drivers.evaluation import design_batches
from propmdao.components.drivers.evaluation.design_batches import DesignBatches

ROUNDING = 1e-9  # of sums in another order, and searches that end a step earlier or later


class Valley(JaxComponent):
    """Rosenbrock's valley; it fails where x_0 < -1."""

    def setup(self):
        self.add_input("x", np.array([0.5, 0.5]), units="m")
        self.add_output("f")
        self.add_output("g", shape=2, units="m")
        self.function = _valley

    def check(self, inputs, values):
        if inputs["x"][0] < -1.0:
            raise om.AnalysisError("left of -1")


def _valley(inputs, constants, static):
    x, y = inputs["x"]
    return {"f": ((1.0 - x) ** 2 + 100.0 * (y - x**2) ** 2)[None], "g": jnp.stack([x + y, x * y])}


class Scaled(om.ExplicitComponent):
    """Twice g in centimetres, an output that the solvers see scaled."""

    def setup(self):
        self.add_input("g", shape=2, units="cm")
        self.add_output("h", shape=2, ref=10.0, units="cm")

    def compute(self, inputs, outputs):
        if inputs["g"][0] > 250.0:
            raise ValueError("g is large")
        outputs["h"] = 2.0 * inputs["g"]


class Square(NodesComp):
    """y = x^2 at every node; it fails where x > 2 and rests at 0."""

    def setup(self):
        self.add_point_input("x")
        self.add_point_output("y")
        self.function = lambda inputs, constants, static: {"y": inputs["x"] ** 2}

    def at_rest(self, inputs):
        return not inputs["x"].any()

    def check(self, inputs, values):
        if inputs["x"][0] > 2.0:
            raise om.AnalysisError("x is large")


def valley():
    """JAX, a component that is not and whose output is scaled, a group that iterates, JAX."""
    prob = om.Problem(reports=False)
    model = prob.model
    model.add_subsystem("valley", Valley(), promotes=["*"])
    model.add_subsystem("scaled", Scaled(), promotes=["*"])
    loop = model.add_subsystem("loop", om.Group())
    loop.add_subsystem("a", om.ExecComp("p = 0.5 * q + h", h={"units": "m"}))
    loop.add_subsystem("b", om.ExecComp("q = 0.5 * p"))
    loop.connect("a.p", "b.p")
    loop.connect("b.q", "a.q")
    loop.nonlinear_solver = om.NonlinearBlockGS(atol=1e-14, rtol=1e-14, maxiter=60, iprint=-1)
    model.connect("h", "loop.a.h", src_indices=[1])
    model.add_subsystem("again", Valley())
    model.connect("h", "again.x")
    model.add_design_var("x", lower=-1.5, upper=1.2)
    model.add_objective("f")
    model.add_constraint("g", upper=[2.0, 0.5], indices=[0, 1])
    prob.setup()
    prob.final_setup()
    return prob


def starts_at(prob, name, values):
    """Outputs vectors before runs at some values of a variable."""
    starts = []
    for value in values:
        prob.set_val(name, value)
        starts.append(outputs_of(prob).asarray(copy=True))
    return starts


def outputs_of(prob):
    return prob.model.get_nonlinear_vectors()[1]


def alone(prob, start):
    """Outputs and failure of an ordinary run."""
    outputs_of(prob).set_val(start)
    failure = ""
    try:
        prob.model.run_solve_nonlinear()
    except om.AnalysisError as error:
        failure = str(error)
    return outputs_of(prob).asarray(copy=True), failure


def test_what_does_not_fit_is_refused_before_the_work(monkeypatch):
    prob = valley()
    needed = DesignBatches(prob.model, 1000).memory
    assert 1000 * 5 * 8 <= needed <= 1000 * 500  # two numbers in and three out, and some between
    monkeypatch.setattr(design_batches, "free_memory", lambda: needed // 2)
    with pytest.raises(ValueError, match=r"designs_at_once 1000 needs .* GiB .*: 500 designs fit"):
        DesignBatches(prob.model, 1000)


@pytest.mark.parametrize("at_once", [2, 3, 8])
def test_runs_are_those_of_one_design_at_a_time(at_once):
    prob = valley()
    designs = [[0.5, 0.5], [-1.2, 0.3], [1.0, 1.0], [-0.4, 1.5], [0.1, -0.9]]
    starts = starts_at(prob, "x", designs)
    runs = list(DesignBatches(prob.model, at_once).run(starts))
    # the second by the first component, the last by one behind the others
    assert [bool(run.failure) for run in runs] == [False, True, False, False, True]
    for start, run in zip(starts, runs, strict=True):
        outputs, failure = alone(prob, start)
        assert run.failure == failure and run.error is None
        assert_allclose(run.outputs, outputs, rtol=1e-13)


def runs_of_five():
    """Outputs and failures of five designs, three in a call."""
    prob = valley()
    designs = [[0.5, 0.5], [-1.2, 0.3], [1.0, 1.0], [-0.4, 1.5], [0.1, -0.9]]
    runs = DesignBatches(prob.model, 3).run(starts_at(prob, "x", designs))
    return [[run.outputs.tolist(), run.failure] for run in runs]


def test_two_devices_have_the_runs_of_one(on_devices):
    for there, here in zip(on_devices(2, __file__, "runs_of_five"), runs_of_five(), strict=True):
        assert_allclose(there[0], here[0], rtol=1e-13)
        assert there[1] == here[1]


def test_an_error_belongs_to_its_design():
    prob = valley()
    first, second = DesignBatches(prob.model, 2).run(starts_at(prob, "x", [[1.4, 1.4], [1, 1]]))
    assert isinstance(first.error, ValueError) and "g is large" in str(first.error)
    assert second.error is None and not second.failure


def test_nodes_at_rest_and_the_node_that_fails():
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("square", Square(num_nodes=3), promotes=["*"])
    prob.setup()
    prob.final_setup()
    starts = starts_at(prob, "x", [[1.0, 0.0, 1.5], [0.5, 3.0, 2.5], [0.0, 0.0, 0.0]])
    first, second, third = DesignBatches(prob.model, 3).run(starts)
    outputs_of(prob).set_val(first.outputs)
    assert prob.get_val("y").tolist() == [1.0, 0.0, 2.25]
    assert (
        second.failure.endswith("node 1: x is large")
        and second.failure == alone(prob, starts[1])[1]
    )
    outputs_of(prob).set_val(third.outputs)
    assert not prob.get_val("y").any()


def search(**options):
    prob = valley()
    defaults = {"seed": 4, "disp": False, "max_gen": 8, "pop_size": 10, "tol": 0.0}
    prob.driver = DifferentialEvolutionDriver(**{**defaults, "best_file": None, **options})
    prob.setup()
    return prob


def test_a_search_is_the_same_and_goes_on_from_a_checkpoint(tmp_path):
    one_by_one, at_once = search(), search(designs_at_once=4)
    for prob in (one_by_one, at_once):
        prob.run_driver()
    assert_allclose(at_once.get_val("x"), one_by_one.get_val("x"), rtol=1e-10)
    assert [state.evaluations for state in at_once.driver.history] == [
        state.evaluations for state in one_by_one.driver.history
    ]
    assert at_once.driver.failed_candidates == one_by_one.driver.failed_candidates > 0
    path = tmp_path / "checkpoint"
    short = search(designs_at_once=4, checkpoint=path, max_gen=3)
    short.run_driver()
    with path.open("r+") as file:  # as a kill leaves it in the middle of a batch
        lines = file.readlines()
        file.seek(0)
        file.truncate()
        file.writelines(lines[:-3])
    resumed = search(designs_at_once=4, checkpoint=path)
    resumed.run_driver()
    assert_allclose(resumed.get_val("x"), at_once.get_val("x"), rtol=1e-10)


def test_a_sweep_has_the_same_rows(tmp_path):
    designs = itertools.product([-1.2, 0.0, 1.4], [0.3, 1.4])
    samples = [{"x": {"val": np.array(design)}} for design in designs]
    rows = []
    for at_once in (1, 4):
        prob = valley()
        path = tmp_path / f"{at_once}.csv"
        prob.driver = SweepDriver(samples, table=path, progress=False, designs_at_once=at_once)
        prob.run_driver()
        with path.open(newline="") as file:
            rows.append(list(csv.DictReader(file)))
    for single, batched in zip(*rows, strict=True):
        assert (single["status"], single["reason"]) == (batched["status"], batched["reason"])
        if single["status"] == "ok":
            assert_allclose(float(batched["f"]), float(single["f"]), rtol=1e-13)
    assert {row["status"] for row in rows[0]} == {"ok", "failed"}


def test_a_model_without_such_components_is_refused():
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("f", om.ExecComp("f = x"), promotes=["*"])
    prob.model.add_design_var("x", lower=0.0, upper=1.0)
    prob.model.add_objective("f")
    prob.driver = DifferentialEvolutionDriver(designs_at_once=8, disp=False, best_file=None)
    prob.setup()
    with pytest.raises(ValueError, match="designs_at_once is 8, but the model has no component"):
        prob.run_driver()


def test_one_way_to_run_at_a_time():
    prob = search(designs_at_once=4, n_workers=2)
    with pytest.raises(ValueError, match="in one way; given are n_workers 2 and designs_at_once 4"):
        prob.run_driver()


@pytest.mark.parametrize(
    ("num_nodes", "full"), [(None, False), pytest.param(2, True, marks=pytest.mark.slow)]
)
def test_a_propeller(propeller, small, num_nodes, full):
    """Trim and tones, in full with polars and broadband noise: what each blade gives alone."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "propeller",
        PropellerGroup(
            propeller=propeller,
            observers=arc(1.905, np.array([-45.0, -22.5])),
            fidelity=small,
            viscous=full,
            broadband=full,
            num_nodes=num_nodes,
            design_distributions={"beta": [propeller.r_over_R[0], 0.6, 1.0]},
        ),
        promotes=["*"],
    )
    prob.setup()
    prob.set_val("speed", 5.0)
    prob.final_setup()
    beta = prob.get_val("beta_cp") + np.radians([[0.0, 0.0, 0.0], [2.0, -1.0, 1.0]])
    starts = starts_at(prob, "beta_cp", beta)
    starts += starts_at(prob, "diameter", [0.3])
    thrusts = [1.2, 1e5] if num_nodes is None else [[1.2, 0.0], [1.2, 1e5]]
    starts += starts_at(prob, "thrust_required", thrusts)
    prob.set_val("chord_over_R", -0.1)
    starts += starts_at(prob, "thrust_required", [1.0])
    runs = list(DesignBatches(prob.model, 4).run(starts))
    assert [bool(run.failure) for run in runs] == [False, False, False, False, True, True]
    names = ["rpm", "torque", "efficiency", "oaspl_db", "oaspl_dba"]
    names += ["oaspl_total_dba"] if full else []
    for start, run in zip(starts, runs, strict=True):
        _, failure = alone(prob, start)
        assert run.failure == failure
        if failure:
            continue
        expected = [np.array(prob.get_val(name)) for name in names]
        outputs_of(prob).set_val(run.outputs)
        for name, value in zip(names, expected, strict=True):
            assert_allclose(prob.get_val(name), value, rtol=ROUNDING, err_msg=name)

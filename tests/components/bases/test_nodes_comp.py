"""Components at several operating points: each point as if it were alone, and it costs alone."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose
from openmdao.utils.assert_utils import assert_check_partials

from propmdao.components.bases import array_function, nodes_comp
from propmdao.components.bases.array_function import FunctionDerivatives
from propmdao.components.bases.nodes_comp import STATIC, NodesComp


def _lift(inputs, constants, static):
    q = 0.5 * inputs["density"][0] * inputs["speed"][0] ** 2
    return {"lift": (q * inputs["area"].sum())[None], "share": q * inputs["area"]}


def _lift_alone(inputs, constants, static):
    lift = _lift(inputs, constants, static)["lift"]
    return {"lift": lift, "force": lift * np.array([0.6, 0.0, -0.8])}


class Wing(NodesComp):
    """Lift of surfaces that fly at several speeds, their shares or its vector, and a constant."""

    def initialize(self):
        super().initialize()
        self.options.declare("shares", True)

    def setup(self):
        self.add_point_input("speed", val=10.0, units="m/s")
        self.add_point_input("density", val=1.2, units="kg/m**3")
        self.add_input("area", val=np.array([1.0, 2.0, 2.5, 0.5]), units="m**2", tags=STATIC)
        self.add_point_output("lift", units="N")
        self.add_output("gravity", val=9.81)
        self.function = _lift_alone
        if self.options["shares"]:
            self.add_point_output("share", shape=(4,), units="N")
            self.function = _lift
        else:
            self.add_point_output("force", shape=(3,), units="N")

    def check(self, inputs, values):
        if inputs["speed"][0] > 300.0:
            raise om.AnalysisError("too fast")


def problem(num_nodes, mode="auto", **options):
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", Wing(num_nodes=num_nodes, **options), promotes=["*"])
    prob.setup(mode=mode)
    return prob


@pytest.mark.parametrize(
    ("num_nodes", "scalar", "array"), [(None, (1,), (4,)), (1, (1,), (1, 4)), (5, (5,), (5, 4))]
)
def test_nodes_lead_what_belongs_to_an_operating_point(num_nodes, scalar, array):
    prob = problem(num_nodes)
    prob.run_model()
    assert prob.get_val("speed").shape == prob.get_val("lift").shape == scalar
    assert prob.get_val("share").shape == array
    assert prob.get_val("area").shape == (4,)
    assert_allclose(prob.get_val("lift"), 360.0)
    assert_allclose(prob.get_val("gravity"), 9.81)


def test_an_accelerator_has_all_nodes_in_one_call(monkeypatch):
    """With the numbers, and the failures, of nodes one by one."""
    alone, together = problem(3), problem(3)
    alone.set_val("speed", [8.0, 10.0, 12.0])
    alone.run_model()
    sizes = []
    found = Wing.found_at_all
    monkeypatch.setattr(nodes_comp, "is_accelerated", lambda: True)
    monkeypatch.setattr(
        Wing, "found_at_all", lambda self, *args: (sizes.append(args[1]), found(self, *args))[1]
    )
    together.set_val("speed", [8.0, 10.0, 12.0])
    together.run_model()
    assert sizes == [3]
    for name in ("lift", "share", "gravity"):
        assert_allclose(together.get_val(name), alone.get_val(name), rtol=1e-14)
    together.set_val("speed", [8.0, 400.0, 12.0])
    with pytest.raises(om.AnalysisError, match="node 1: too fast"):
        together.run_model()


@pytest.mark.parametrize("shares", [True, False])
@pytest.mark.parametrize("num_nodes", [None, 1, 3])
def test_partials(num_nodes, shares):
    prob = problem(num_nodes, shares=shares)
    prob.set_val("speed", np.linspace(8.0, 12.0, num_nodes or 1))
    prob.run_model()
    data = prob.check_partials(out_stream=None, method="fd", form="central")
    # quadratic, so that central differences have rounding only
    assert_check_partials(data, atol=1e-6, rtol=1e-7)


@pytest.mark.parametrize("mode", ["fwd", "rev"])
def test_points_without_a_seed_are_not_differentiated(mode, monkeypatch):
    prob = problem(5, mode)
    prob.run_model()
    calls = []
    for name in ("forward", "reverse"):
        product = getattr(FunctionDerivatives, name)
        monkeypatch.setattr(
            FunctionDerivatives,
            name,
            lambda *args, product=product: (calls.append(1), product(*args))[1],
        )
    totals = prob.compute_totals(of=["lift"], wrt=["speed"])["lift", "speed"]
    assert_allclose(totals, np.diag(np.full(5, 72.0)))
    assert len(calls) == 5


def test_a_failure_names_its_node():
    prob = problem(3)
    prob.set_val("speed", [10.0, 400.0, 10.0])
    with pytest.raises(om.AnalysisError, match="node 1: too fast"):
        prob.run_model()
    alone = problem(None)
    alone.set_val("speed", 400.0)
    with pytest.raises(om.AnalysisError, match=r"compute\(\), too fast"):
        alone.run_model()


@pytest.fixture
def products_back(monkeypatch):
    """Grows by one with each product back, by the number of its outputs that have a seed."""
    calls = []
    reverse = FunctionDerivatives.reverse

    def counted(self, seeds):
        calls.append(sum(seed.any() for seed in seeds.values()))
        return reverse(self, seeds)

    monkeypatch.setattr(FunctionDerivatives, "reverse", counted)
    return calls


@pytest.mark.parametrize("mode", ["fwd", "rev"])
def test_gradients_of_scalars_and_vectors_are_taken_once_each_when_asked_for(mode, products_back):
    prob = problem(3, mode, shares=False)
    prob.set_val("speed", [8.0, 10.0, 12.0])
    prob.run_model()
    by_speed = 1.2 * 6.0 * np.array([8.0, 10.0, 12.0])
    for _ in range(2):
        totals = prob.compute_totals(of=["lift"], wrt=["speed", "density", "area"])
        assert len(products_back) == 3  # a number at each of three points
        assert_allclose(totals["lift", "speed"], np.diag(by_speed))
    for _ in range(2):
        totals = prob.compute_totals(of=["lift", "force"], wrt=["speed"])
        assert len(products_back) == 12  # and three numbers more
        blocks = totals["force", "speed"].reshape(3, 3, 3)
        assert_allclose(blocks[[0, 1, 2], :, [0, 1, 2]], np.outer(by_speed, [0.6, 0.0, -0.8]))
    prob.set_val("speed", [8.0, 11.0, 12.0])  # one of the points is another one
    prob.run_model()
    totals = prob.compute_totals(of=["lift"], wrt=["speed"])["lift", "speed"]
    assert_allclose(totals, np.diag(6.0 * 1.2 * np.array([8.0, 11.0, 12.0])))
    assert len(products_back) == 13
    assert set(products_back) == {1}


@pytest.mark.parametrize(("num_nodes", "kept"), [(None, True), (3, False)])
def test_a_point_alone_keeps_its_linearisation(num_nodes, kept, monkeypatch):
    """Many would take much memory."""
    linearised = []
    linearise = array_function._linearise
    monkeypatch.setattr(
        array_function, "_linearise", lambda *args: (linearised.append(1), linearise(*args))[1]
    )
    prob = problem(num_nodes, "rev", shares=False)
    prob.set_val("speed", np.linspace(8.0, 12.0, num_nodes or 1))
    prob.run_model()
    for output in ("lift", "force", "lift"):
        prob.compute_totals(of=[output], wrt=["speed"])
    assert len(linearised) == (1 if kept else 2 * num_nodes)

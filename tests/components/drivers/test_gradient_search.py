"""SLSQP with its history: known optimum, what was tried, a failed analysis."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components.drivers.gradient_search import run_slsqp


class Plane(om.ExplicitComponent):
    """x + y with x y as a constraint, and an analysis that may fail."""

    fails_below = -np.inf

    def setup(self):
        self.add_input("x", val=2.0, units="m")
        self.add_input("y", val=3.0)
        self.add_output("f")
        self.add_output("g", shape=2, units="m")
        self.declare_partials("*", "*")

    def compute(self, inputs, outputs):
        (x,), (y,) = inputs["x"], inputs["y"]
        if x < self.fails_below:
            raise om.AnalysisError(f"x is {x:g}")
        outputs["f"] = x + y
        outputs["g"] = [x * y, y]

    def compute_partials(self, inputs, partials):
        partials["f", "x"] = partials["f", "y"] = 1.0
        partials["g", "x"] = [inputs["y"][0], 0.0]
        partials["g", "y"] = [inputs["x"][0], 1.0]


@pytest.fixture
def plane():
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("plane", Plane(), promotes=["*"])
    prob.model.add_design_var("x", lower=10.0, upper=1000.0, units="cm", ref=100.0)
    prob.model.add_design_var("y", lower=0.1, upper=10.0)
    prob.model.add_constraint("g", lower=[400.0, 0.1], units="cm", ref=100.0)
    prob.model.add_objective("f")
    prob.setup()
    return prob


def test_it_finds_the_optimum_and_says_how(plane, tmp_path):
    history, seconds, compiling = run_slsqp(plane, tmp_path / "cases.sql")
    # f = 4 + (x - 2)^2 / 2 along the constraint: its tolerance of 1e-5 leaves x its root
    assert_allclose([plane.get_val("x")[0], plane.get_val("y")[0]], 2.0, atol=5e-3)
    assert seconds > 0.0 and compiling > 0.0
    assert_allclose(history.objective[0], 5.0)  # the start, which meets the constraints
    assert (history.violation[0], history.constraint[0]) == (0.0, "")
    assert_allclose(history.objective[-1], 4.0, atol=1e-4)
    assert history.violation[-1] < 1e-4
    # between them it leaves the constraint, and the violation is in the constraint's scaling
    worst = int(np.argmax(history.violation))
    assert history.violation[worst] > 1e-2 and history.constraint[worst] == "g"


def test_an_earlier_record_is_replaced(plane, tmp_path):
    first = run_slsqp(plane, tmp_path / "cases.sql").history
    again = run_slsqp(plane, tmp_path / "cases.sql").history
    assert_allclose(again.objective[0], first.objective[-1])  # it starts where the first one ended


def test_a_failed_analysis_ends_the_search_with_its_reason(plane, tmp_path, monkeypatch):
    monkeypatch.setattr(Plane, "fails_below", 1.9)
    with pytest.raises(om.AnalysisError, match="x is 1"):
        run_slsqp(plane, tmp_path / "cases.sql")


def test_a_relative_file_lies_where_the_script_runs(plane, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    history = run_slsqp(plane, "cases.sql").history
    assert (tmp_path / "cases.sql").exists() and history.objective.size > 1

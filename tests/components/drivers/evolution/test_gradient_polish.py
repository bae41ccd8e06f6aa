"""SLSQP from the best design of evolution: several equalities are met, and nothing is lost."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import DifferentialEvolutionDriver


def circle(x):
    return x.sum(), x @ x


def g11(x):
    """Koziel and Michalewicz 1999."""
    return x[0] ** 2 + (x[1] - 1.0) ** 2, x[1] - x[0] ** 2


def two_equalities(x):
    """Hock and Schittkowski 1981, problem 48: five variables, optimum 0 at 1."""
    value = (x[0] - 1) ** 2 + (x[1] - x[2]) ** 2 + (x[3] - x[4]) ** 2
    return value, [x.sum() - 5.0, x[2] - 2 * (x[3] + x[4]) + 3.0]


@pytest.mark.parametrize("seed", [1, 2, *(pytest.param(n, marks=pytest.mark.slow) for n in (3, 4))])
@pytest.mark.parametrize(
    ("function", "bound", "n_g", "equals", "optimum", "generations"),
    [
        (circle, 2.0, 1, 2.0, -2.0, 20),
        (g11, 1.0, 1, 0.0, 0.75, 20),
        (two_equalities, 3.0, 2, 0.0, 0.0, 20),
    ],
)
def test_equalities_are_met_at_the_optimum(
    problem, seed, function, bound, n_g, equals, optimum, generations
):
    n = 2 if n_g == 1 else 5
    prob = problem(
        function, [-bound] * n, [bound] * n, n_g=n_g, constraint={"equals": equals}, seed=seed,
        x0=[0.5] * n, max_gen=generations, polish=True,
    )  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("g"), equals, atol=1.01e-4)
    # The optimum moves by the tolerance of the equalities times their multipliers.
    assert_allclose(prob.get_val("f"), optimum, atol=3e-4)
    assert " and polished by " in prob.driver.message


@pytest.mark.parametrize("seed", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_two_equalities_of_five_variables_without_polishing(problem, seed):
    """Feasible, which takes a slack that shrinks slowly enough; the optimum is 0."""
    prob = problem(
        two_equalities, [-3.0] * 5, [3.0] * 5, n_g=2, constraint={"equals": 0.0}, seed=seed,
    )  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("g"), 0.0, atol=1.01e-4)
    assert prob.get_val("f")[0] < 0.5


class Scaled(om.ExplicitComponent):
    """Quadratic in two angles; it fails where the first is below -0.4 rad."""

    def setup(self):
        self.add_input("x", np.array([0.3, 0.3]), units="rad")
        self.add_input("y", 2.0, units="m")
        self.add_output("f", units="m")
        self.add_output("g", shape=2, units="rad")
        self.declare_partials("*", "*")

    def compute(self, inputs, outputs):
        (x0, x1), y = inputs["x"], inputs["y"][0]
        outputs["f"] = (x0 + 0.3) ** 2 + (x1 - 0.2) ** 2 + (y - 1.5) ** 2
        outputs["g"] = [x0 + x1**2, x0 - x1]

    def compute_partials(self, inputs, partials):
        (x0, x1), y = inputs["x"], inputs["y"][0]
        partials["f", "x"] = [2 * (x0 + 0.3), 2 * (x1 - 0.2)]
        partials["f", "y"] = 2 * (y - 1.5)
        partials["g", "x"] = [[1.0, 2 * x1], [1.0, -1.0]]
        partials["g", "y"] = np.zeros((2, 1))


def scaled(folder=None, **options):
    """Units, scaling (a negative one, too) and one-sided bounds of elements."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", Scaled(), promotes=["*"])
    prob.driver = DifferentialEvolutionDriver(
        seed=3, max_gen=4, pop_size=8, disp=False, best_file=None, **options
    )
    prob.model.add_design_var("x", lower=-30.0, upper=30.0, ref=10.0, units="deg")
    prob.model.add_design_var("y", lower=100.0, upper=300.0, ref=-50.0, ref0=20.0, units="cm")
    prob.model.add_objective("f", ref=0.1)
    prob.model.add_constraint(
        "g", lower=[-5.0, -1e30], upper=[1e30, 10.0], ref=-20.0, ref0=3.0, units="deg"
    )
    prob.setup()
    return prob


def test_units_and_scaling_are_those_of_the_driver():
    plain, polished = scaled(), scaled(polish=True)
    plain.run_driver()
    assert polished.run_driver().success
    # By hand: y = 1.5, and the first constraint is active, x0 = -5 deg - x1^2.
    x1 = np.linspace(0.0, 0.5, 200001)
    x0 = np.radians(-5.0) - x1**2
    best = np.argmin((x0 + 0.3) ** 2 + (x1 - 0.2) ** 2)
    assert_allclose(polished.get_val("x"), [x0[best], x1[best]], atol=1e-5)
    assert_allclose(polished.get_val("y"), 1.5, atol=1e-6)
    assert polished.get_val("f")[0] < plain.get_val("f")[0]


def test_linear_constraints_leave_units_and_scaling_alone():
    """With elements of the variables alone, and a variable that the objective does not know."""
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", Scaled(), promotes=["*"])
    units = {
        "x": {"units": "rad", "val": [0.3, 0.3]},
        "z": {"units": "m", "val": 0.4},
        "h": {"units": "m"},
    }
    line = om.ExecComp("h = 2.0 * x[1] - z - 0.1", **units)
    prob.model.add_subsystem("line", line, promotes=["*"])
    prob.driver = DifferentialEvolutionDriver(
        seed=3, max_gen=2, pop_size=8, disp=False, best_file=None, polish=True
    )
    prob.model.add_design_var("x", lower=-30.0, upper=30.0, ref=10.0, units="deg")
    prob.model.add_design_var("z", lower=20.0, upper=40.0, ref0=-10.0, ref=7.0, units="cm")
    prob.model.add_objective("f", ref=0.1, units="mm")
    prob.model.add_constraint("h", upper=-20.0, ref=-40.0, units="cm", linear=True)
    prob.set_solver_print(-1)
    prob.setup()
    prob.run_driver()
    # By hand: x0 = -0.3, and 2 x1 = z - 0.1 with the largest z.
    assert_allclose(prob.get_val("x"), [-0.3, 0.15], atol=1e-6)
    assert_allclose(prob.get_val("z"), 0.4, atol=1e-6)
    n_polished = int(prob.driver.message.split("polished by ")[1].split()[0])
    assert n_polished < 20


def test_a_polished_search_is_resumed_to_the_same_end(tmp_path):
    whole = scaled(polish=True, checkpoint=tmp_path / "whole")
    whole.run_driver()
    lines = (tmp_path / "whole").read_bytes().splitlines(keepends=True)
    n = len(lines) - 1
    assert n == whole.driver.history[-1].evaluations + int(
        whole.driver.message.split("polished by ")[1].split()[0]
    )
    for kept in (20, n - 2):  # killed within evolution, and while it was polished
        (tmp_path / "part").write_bytes(b"".join(lines[: 1 + kept]))
        resumed = scaled(polish=True, checkpoint=tmp_path / "part")
        resumed.run_driver()
        assert (tmp_path / "part").read_bytes() == b"".join(lines)
        assert resumed.get_val("x").tolist() == whole.get_val("x").tolist()
        assert resumed.driver.message == whole.driver.message
    with pytest.raises(ValueError, match="is of another search: max_gen is 4 there and 9 here"):
        prob = scaled(polish=True, checkpoint=tmp_path / "whole")
        prob.driver.options["max_gen"] = 9
        prob.run_driver()


def test_an_analysis_that_fails_ends_the_polishing_and_loses_nothing(problem):
    def fails_at_the_optimum(x):
        if (x**2).sum() < 0.01:
            raise om.AnalysisError("stalled")
        return x @ x, x[:1]

    options = {"x0": [0.9, 0.9], "max_gen": 2, "pop_size": 6}
    plain = problem(fails_at_the_optimum, [-1.0] * 2, [1.0] * 2, **options)
    polished = problem(fails_at_the_optimum, [-1.0] * 2, [1.0] * 2, polish=True, **options)
    plain.run_driver()
    assert polished.run_driver().success
    assert polished.get_val("f")[0] <= plain.get_val("f")[0]
    assert polished.driver.failed_candidates > plain.driver.failed_candidates


def test_a_search_out_of_time_is_not_polished(problem):
    prob = problem(circle, [-1.0] * 2, [1.0] * 2, polish=True, time_budget=0.0)
    prob.run_driver()
    assert "time budget" in prob.driver.message and "polished" not in prob.driver.message


def test_a_time_limit_and_polishing_are_refused_together(problem):
    prob = problem(circle, [-1.0] * 2, [1.0] * 2, polish=True, design_time_limit=1.0)
    with pytest.raises(ValueError, match="polish runs the model in this process, where design_"):
        prob.run_driver()

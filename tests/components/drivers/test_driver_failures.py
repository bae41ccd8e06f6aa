"""Failed analyses, infeasible problems, interrupts and wrong set-ups of the driver."""

import json

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import DifferentialEvolutionDriver


def fails_at_both_ends(x):
    """Minimum 1 of (x - 0.2)^2 + 1 lies where the analysis fails; nan above 0.8."""
    if x[0] < 0.3:
        raise om.AnalysisError("stalled below 0.3")
    value = np.nan if x[0] > 0.8 else (x[0] - 0.2) ** 2 + 1.0
    return value, x[:1]


@pytest.mark.parametrize("constraint", [None, {"upper": 0.7}])
def test_failed_designs_lose_and_are_counted(problem, constraint):
    prob = problem(fails_at_both_ends, [0.0], [1.0], constraint=constraint, tol=1e-7)
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), 0.3, atol=1e-3)
    designs = np.array(prob.model.comp.designs)[:-1, 0]
    failed = ((designs < 0.3) | (designs > 0.8)).sum()
    assert failed > 0
    assert prob.driver.failed_candidates == prob.driver.history[-1].failed == failed
    assert f"{failed} of them failed" in prob.driver.message
    assert "stalled below 0.3" in prob.driver.last_failure
    reasons = prob.driver.failure_reasons
    assert set(reasons) <= {"comp: stalled below 0.3", "f is not finite: [nan]"}
    assert sum(reasons.values()) == failed
    assert f"failed ({reasons['comp: stalled below 0.3']}: comp: " in prob.driver.message


@pytest.mark.parametrize("value", [np.nan, np.inf, -np.inf])
def test_constraint_that_is_not_finite_is_never_feasible(problem, value):
    """Scipy takes a nan, and inf against an infinite bound, for feasible."""
    prob = problem(
        lambda x: (x[0], value if x[0] < 0.5 else 0.0), [0.0], [1.0], constraint={"lower": -1.0},
        tol=1e-6,
    )  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), 0.5, atol=1e-3)


def test_objective_of_minus_infinity_is_a_failure(problem):
    prob = problem(lambda x: (-np.inf if x[0] < 0.5 else x[0], 0.0), [0.0], [1.0], tol=1e-6)
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), 0.5, atol=1e-3)


def test_the_summary_is_one_line_that_no_terminal_obeys(problem, capsys):
    def fail(x):
        raise om.AnalysisError("red \x1b[31m ink")

    problem(fail, [0.0], [1.0], max_gen=1, disp=True).run_driver()
    (line,) = capsys.readouterr().out.splitlines()
    assert "comp: red \\x1b[31m ink" in line


def test_every_analysis_failed(problem):
    def fail(x):
        raise om.AnalysisError("no thrust")

    prob = problem(fail, [0.0], [1.0], x0=[0.4], max_gen=2)
    result = prob.run_driver()
    assert not result.success and prob.driver.fail and result.exit_status == "FAIL"
    assert "every analysis failed" in prob.driver.message
    assert f"({prob.driver.failed_candidates}: comp: no thrust)" in prob.driver.message
    assert_allclose(prob.get_val("x"), 0.4)


def test_infeasible_problem_is_left_at_the_smallest_violation_and_reported(problem, tmp_path):
    prob = problem(
        lambda x: (x @ x, x), [0.0] * 2, [1.0] * 2, n_g=2, constraint={"lower": [0.5, 2.0]},
        max_gen=60, best_file=str(tmp_path / "best.json"),
    )  # fmt: skip
    result = prob.run_driver()
    assert not result.success and prob.driver.fail and result.exit_status == "FAIL"
    assert "no feasible design" in prob.driver.message
    x = prob.get_val("x")
    assert x[0] >= 0.5 - 1e-3
    assert_allclose(x[1], 1.0, atol=1e-3)
    assert_allclose(prob.driver.history[-1].max_violation, 1.0, atol=1e-3)
    assert np.isnan(prob.driver.history[-1].best_objective)
    assert not (tmp_path / "best.json").exists()


def test_an_error_in_the_model_ends_the_run_under_its_own_name(problem):
    """Scipy renames TypeError and ValueError of an objective to RuntimeError."""

    def wrong(x):
        raise ValueError("chord_over_R must be positive")

    with pytest.raises(ValueError, match="chord_over_R must be positive"):
        problem(wrong, [0.0], [1.0]).run_driver()


class Stateful(om.ImplicitComponent):
    """Solves y = x from its last y; a nan state would survive into every later run."""

    def setup(self):
        self.guesses = []
        self.add_input("x", 0.5)
        self.add_output("y", 7.0)
        self.declare_partials("*", "*", method="fd")

    def apply_nonlinear(self, inputs, outputs, residuals):
        residuals["y"] = outputs["y"] - inputs["x"]

    def solve_nonlinear(self, inputs, outputs):
        self.guesses.append(outputs["y"][0])
        if inputs["x"][0] < 0.3:
            outputs["y"] = np.nan
            raise om.AnalysisError("diverged")
        outputs["y"] = inputs["x"]


def test_every_run_starts_from_the_same_states():
    prob = om.Problem(
        driver=DifferentialEvolutionDriver(max_gen=5, disp=False, best_file=None, seed=2),
        reports=False,
    )
    prob.model.add_subsystem("comp", Stateful(), promotes=["*"])
    prob.model.add_design_var("x", lower=0.0, upper=1.0)
    prob.model.add_objective("y")
    prob.setup()
    prob.run_driver()
    assert prob.driver.failed_candidates > 0
    assert set(prob.model.comp.guesses) == {7.0}


# --- the file of the best design, interrupts, recorders -----------------------------------------


def test_best_file_holds_the_best_design_with_units(tmp_path):
    prob = om.Problem(
        driver=DifferentialEvolutionDriver(
            max_gen=5, disp=False, seed=2, best_file=tmp_path / "new" / "best.json"
        ),
        reports=False,
    )
    prob.model.add_subsystem(
        "comp",
        om.ExecComp(["f = x**2", "g = 3 * x"], x={"units": "rad", "val": 0.2}, g={"units": "rad"}),
        promotes=["*"],
    )
    prob.model.add_design_var("x", lower=10.0, upper=20.0, units="deg", ref=3.0)
    prob.model.add_constraint("g", lower=0.6)
    prob.model.add_objective("f")
    prob.setup()
    prob.run_driver()
    best = json.loads((tmp_path / "new" / "best.json").read_text())
    assert best["objective"] == {"f": {"value": [prob.get_val("f")[0]], "units": None}}
    assert best["constraints"] == {"g": {"value": [prob.get_val("g")[0]], "units": "rad"}}
    assert best["design_variables"]["x"]["units"] == "deg"
    assert_allclose(
        best["design_variables"]["x"]["value"], prob.get_val("x", units="deg"), rtol=1e-12
    )
    assert [path.name for path in (tmp_path / "new").iterdir()] == ["best.json"]


def test_best_file_lies_in_the_outputs_directory_by_default(problem):
    prob = problem(lambda x: (x @ x, 0.0), [0.0], [1.0], max_gen=0, best_file="best_design.json")
    prob.run_driver()
    assert (prob.get_outputs_dir() / "best_design.json").exists()


def test_interrupt_leaves_the_best_design_in_the_model_and_on_disk(problem, tmp_path):
    calls = 0

    def interrupted(x):
        nonlocal calls
        calls += 1
        if calls == 40:
            raise KeyboardInterrupt
        return (x[0] - 0.3) ** 2, x[:1]

    path = tmp_path / "best.json"
    prob = problem(interrupted, [0.0], [1.0], constraint={"lower": 0.4}, best_file=path)
    with pytest.raises(KeyboardInterrupt):
        prob.run_driver()
    tried = np.array(prob.model.comp.designs)[:39, 0]
    best = tried[tried >= 0.4].min()
    assert prob.get_val("x")[0] == best
    assert prob.get_val("f")[0] == (best - 0.3) ** 2
    assert json.loads(path.read_text())["design_variables"]["x"]["value"] == [best]
    assert prob.driver.fail and not prob.driver.result.success
    # and the same Problem can go on
    assert prob.run_driver().success


def test_recorder_keeps_every_case_failures_marked_and_the_best_last(problem):
    prob = problem(fails_at_both_ends, [0.0], [1.0], max_gen=4, pop_size=6)
    prob.driver.add_recorder(om.SqliteRecorder("cases.sql"))
    prob.driver.recording_options["record_objectives"] = True
    prob.run_driver()
    cases = om.CaseReader(prob.get_outputs_dir() / "cases.sql")
    names = cases.list_cases("driver", out_stream=None)
    assert len(names) == len(prob.model.comp.designs)
    success = [cases.get_case(name).success for name in names]
    assert success.count(0) == prob.driver.failed_candidates > 0
    last = cases.get_case(names[-1])
    assert last["f"] == prob.get_val("f") and last.success
    prob.cleanup()


# --- wrong set-ups ------------------------------------------------------------------------------


def set_up(design_var, objectives=("f",), x_size=1, **options):
    prob = om.Problem(driver=DifferentialEvolutionDriver(**options), reports=False)
    prob.model.add_subsystem(
        "comp",
        om.ExecComp(["f = sum(x)", "h = sum(x)", "v = x * 1"],
                    x=np.zeros(x_size), v=np.zeros(x_size)),
        promotes=["*"],
    )  # fmt: skip
    if design_var is not None:
        prob.model.add_design_var("x", **design_var)
    for name in objectives:
        prob.model.add_objective(name)
    prob.setup()
    prob.run_driver()


@pytest.mark.parametrize(
    "bounds", [{}, {"lower": 0.0}, {"upper": 1.0}, {"lower": 0.0, "upper": 1e30}]
)
def test_design_variable_without_finite_bounds(bounds):
    with pytest.raises(ValueError, match="needs finite bounds; design variable 'x' has lower="):
        set_up(bounds)


def test_design_variable_with_swapped_bounds():
    with pytest.raises(ValueError, match="needs lower <= upper; design variable 'x' has lower=2"):
        set_up({"lower": 2.0, "upper": 1.0})


def test_no_objective_no_design_variable_too_small_a_population():
    bounds = {"lower": 0.0, "upper": 1.0}
    with pytest.raises(RuntimeError, match="requires objective to be declared"):
        set_up(bounds, objectives=())
    with pytest.raises(RuntimeError, match="needs a design variable"):
        set_up(None)
    with pytest.raises(ValueError, match="pop_size must be at least 5; it is 4"):
        set_up(bounds, pop_size=4)


def test_a_constraint_that_is_not_there_is_named():
    """OpenMDAO's own message, before anything runs."""
    prob = om.Problem(driver=DifferentialEvolutionDriver(), reports=False)
    prob.model.add_subsystem("comp", om.ExecComp("f = x"), promotes=["*"])
    prob.model.add_design_var("x", lower=0.0, upper=1.0)
    prob.model.add_objective("f")
    prob.model.add_constraint("torqe", upper=1.0)
    prob.setup()
    with pytest.raises(RuntimeError, match="Output not found for response 'torqe'"):
        prob.run_driver()
    assert prob.driver.iter_count == 0


@pytest.mark.parametrize(
    "wrong",
    [{"mutation": (1.0, 0.5)}, {"mutation": 2.0}, {"mutation": (0.5,)}, {"mutation": np.nan},
     {"mutation": (0.5, "1")}, {"equality_tolerance": np.nan}, {"equality_tolerance": -1e-4},
     {"tol": np.nan}, {"time_budget": np.nan}, {"recombination": np.nan}],
)  # fmt: skip
def test_options_out_of_range_are_refused_in_a_line(wrong):
    ((name, value),) = wrong.items()
    with pytest.raises(ValueError, match=name) as raised:
        DifferentialEvolutionDriver(**wrong)
    assert str(value) in str(raised.value) and "\n" not in str(raised.value)


def test_several_objectives():
    bounds = {"lower": 0.0, "upper": 1.0}
    with pytest.raises(RuntimeError, match="one scalar objective; the model has 2: f, h"):
        set_up(bounds, objectives=("f", "h"))
    with pytest.raises(RuntimeError, match="one scalar objective; the model has 3: v"):
        set_up(bounds, objectives=("v",), x_size=3)

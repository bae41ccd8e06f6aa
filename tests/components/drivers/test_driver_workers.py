"""The driver on workers: the same search as without, and what becomes of their errors."""

import functools
import os
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import openmdao.api as om
import pytest

from propmdao.components import DifferentialEvolutionDriver
from propmdao.components.drivers.evaluation.model_run import put_outputs
from propmdao.runtime.worker_processes import WorkerLostError


@pytest.fixture
def threads():
    with ThreadPoolExecutor(2) as executor:
        yield executor


def outcome(prob, tmp_path, name, **recording):
    """Everything that a search leaves behind."""
    prob.driver.options["best_file"] = tmp_path / name / "best.json"
    prob.driver.options["checkpoint"] = tmp_path / name / "checkpoint"
    prob.driver.add_recorder(om.SqliteRecorder(tmp_path / f"{name}.sql"))
    prob.driver.recording_options["includes"] = ["*"]
    result = prob.run_driver()
    prob.cleanup()
    reader = om.CaseReader(tmp_path / f"{name}.sql")
    cases = [
        (case.success, case.msg, {key: case[key].tolist() for key in ("x", "radius", "f", "g")})
        for case in reader.get_cases("driver")
    ]
    files = [(tmp_path / name / file).read_text() for file in ("best.json", "checkpoint")]
    return cases, files, prob.get_val("x").tolist(), prob.driver.history, result.model_evals


@pytest.mark.parametrize("seed", [4, 5])
def test_design_cases_and_files_do_not_depend_on_the_workers(models, threads, tmp_path, seed):
    alone = outcome(models.problem(seed=seed), tmp_path, "alone")
    on_threads = outcome(models.problem(seed=seed, executor=threads), tmp_path, "threads")
    assert on_threads == alone
    assert {success for success, _, _ in alone[0]} == {0, 1}
    threads.submit(int).result()  # and the executor is left open


def test_nor_on_processes(models, tmp_path):
    alone = outcome(models.problem(), tmp_path, "alone")
    assert outcome(models.problem(n_workers=2), tmp_path, "processes") == alone


def test_workers_start_from_the_values_of_the_problem_that_asks(models, threads):
    """What is set on the Problem after its factory has made it holds on the workers too."""
    alone, shared = models.problem(), models.problem(executor=threads)
    for prob in (alone, shared):
        prob.set_val("radius", 0.3)
        prob.run_driver()
    assert np.linalg.norm(alone.get_val("x")) <= 0.3
    assert shared.get_val("x").tolist() == alone.get_val("x").tolist()


def test_every_thread_has_a_problem_of_its_own(models):
    """A Problem that two threads run at once would mix their designs."""
    slow = functools.partial(models.build, seconds=2e-3)
    alone = models.problem(slow, max_gen=3)
    alone.run_driver()
    with ThreadPoolExecutor(4) as executor:
        shared = models.problem(slow, max_gen=3, executor=executor)
        shared.run_driver()
    assert shared.driver.history == alone.driver.history


def test_an_error_of_the_model_ends_the_run_under_its_own_name(models, threads):
    prob = models.problem(functools.partial(models.build, trouble="value"), executor=threads)
    with pytest.raises(ValueError, match="chord_over_R must be positive") as raised:
        prob.run_driver()
    assert "In a worker:" in raised.value.__notes__[0]  # and says where


def test_an_error_that_cannot_travel_is_told(models, threads):
    prob = models.problem(functools.partial(models.build, trouble="strange"), executor=threads)
    with pytest.raises(RuntimeError, match="StrangeError: .*this and that"):
        prob.run_driver()


@pytest.mark.parametrize("name", ["processes", "threads"])
def test_a_factory_that_does_not_pickle_is_refused_before_anything_runs(models, threads, name):
    workers = {"n_workers": 2} if name == "processes" else {"executor": threads}
    prob = models.problem(lambda: models.build(), **workers)
    with pytest.raises(ValueError, match="problem_factory .*lambda.* does not pickle"):
        prob.run_driver()
    assert prob.driver.iter_count == 0


def test_a_factory_of_another_model_is_refused(models, threads):
    prob = models.problem(executor=threads)
    for no_problem_set_up in (om.Problem, int):
        prob.driver.options["problem_factory"] = no_problem_set_up
        with pytest.raises(ValueError, match="must return a Problem that has been set up; it ret"):
            prob.run_driver()
    prob.driver.options["problem_factory"] = set_up_nothing
    with pytest.raises(ValueError, match="builds another model .* differ in .*disc.f"):
        prob.run_driver()


def set_up_nothing():
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", om.ExecComp("y = x"))
    prob.setup()
    return prob


def test_workers_without_a_factory_or_of_two_kinds_are_refused(models, threads):
    with pytest.raises(ValueError, match="give problem_factory"):
        models.problem(n_workers=2, problem_factory=None).run_driver()
    with pytest.raises(ValueError, match="in one way; given are n_workers 2 and an executor"):
        models.problem(n_workers=2, executor=threads).run_driver()


def test_what_a_run_elsewhere_has_left_reaches_every_input():
    """Units and scaled outputs included, as in a run here."""
    prob = om.Problem(reports=False)
    scaled = om.ExecComp("h = 3 * x", h={"ref": 10.0, "units": "m"})
    prob.model.add_subsystem("scaled", scaled)
    prob.model.add_subsystem("feet", om.ExecComp("k = h", h={"units": "ft"}))
    prob.model.connect("scaled.h", "feet.h")
    prob.setup()
    prob.run_model()
    left = prob.model.get_nonlinear_vectors()[1].asarray(copy=True)
    expected = prob.model.feet._inputs["h"].copy()
    prob.model.feet._inputs["h"] = 0.0
    put_outputs(prob.model, left)
    assert prob.model.feet._inputs["h"] == expected


def test_options_of_a_wrong_type_are_refused():
    for wrong in (
        {"n_workers": 0},
        {"executor": 2},
        {"problem_factory": "build"},
        {"designs_at_once": 0},
    ):
        with pytest.raises((TypeError, ValueError), match=next(iter(wrong))):
            DifferentialEvolutionDriver(**wrong)


def test_a_worker_that_dies_ends_the_run_and_a_second_run_ends_as_if_it_had_not(models, tmp_path):
    plain = models.problem()
    plain.run_driver()
    deadly = functools.partial(models.build, trouble="kill", flag=tmp_path / "killed")
    prob = models.problem(deadly, n_workers=2, checkpoint=tmp_path / "checkpoint")
    with pytest.raises(WorkerLostError, match="a worker ended without a result") as raised:
        prob.run_driver()
    n_known = len((tmp_path / "checkpoint").read_text().splitlines()) - 1
    assert f"The {n_known} designs evaluated so far are in" in raised.value.__notes__[0]
    assert (tmp_path / "killed").exists()  # so that it does not kill this process, now
    again = models.problem(deadly, checkpoint=tmp_path / "checkpoint")
    again.run_driver()
    assert again.driver.history == plain.driver.history
    assert again.get_val("x").tolist() == plain.get_val("x").tolist()


@pytest.mark.slow
def test_a_script_that_workers_cannot_import_ends_in_an_error_that_says_so(models, tmp_path):
    """Without a guard every worker would start workers when it imports the script."""
    script = tmp_path / "unguarded.py"
    script.write_text("import worker_models\nworker_models.problem(n_workers=2).run_driver()\n")
    path = {"PYTHONPATH": os.pathsep.join(sys.path), "OPENMDAO_WORKDIR": str(tmp_path)}
    result = subprocess.run(
        [sys.executable, str(script)], env=os.environ | path, capture_output=True, timeout=120
    )
    assert result.returncode == 1
    assert b"WorkerLostError: a worker ended without a result" in result.stderr
    assert b"put that under if __name__ == '__main__':" in result.stderr

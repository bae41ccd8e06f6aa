"""The checkpoint: a search resumed after whatever ended it is the search that was not ended."""

import functools
import json
import os
import signal
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import openmdao.api as om
import pytest

from propmdao.runtime.locks import InUseError, locked
from propmdao.runtime.output_files import OutputError

SCRIPT = Path(__file__).parent / "worker_models.py"


@pytest.fixture
def finished(models, tmp_path):
    """A search that ran to its end, and its checkpoint."""
    prob = models.problem(checkpoint=tmp_path / "checkpoint")
    prob.run_driver()
    return prob, tmp_path / "checkpoint"


def resume(models, path, **options):
    prob = models.problem(checkpoint=path, **options)
    prob.run_driver()
    return prob


def cut(path, n_lines, and_half_a_line=False):
    lines = path.read_bytes().splitlines(keepends=True)
    half = lines[n_lines][:40] if and_half_a_line else b""
    path.write_bytes(b"".join(lines[:n_lines]) + half)


# --- resuming -----------------------------------------------------------------------------------


@pytest.mark.parametrize("n_workers", [1, pytest.param(2, marks=pytest.mark.slow)])
def test_a_killed_search_resumes_to_the_same_design(models, tmp_path, n_workers):
    uninterrupted = models.problem()
    uninterrupted.run_driver()
    path = tmp_path / "checkpoint"
    command = [sys.executable, str(SCRIPT), str(path), str(n_workers), "0.02"]
    environment = os.environ | {"OPENMDAO_WORKDIR": str(tmp_path)}
    with subprocess.Popen(command, env=environment, stdout=subprocess.PIPE) as process:
        deadline = time.monotonic() + 60.0
        while not path.exists() or path.read_bytes().count(b"\n") < 20:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.005)
        process.send_signal(signal.SIGKILL)
        # The pipe closes when the last worker has ended too.
        out, _ = process.communicate(timeout=60.0)
    assert process.returncode == -signal.SIGKILL and out == b""
    n_known = path.read_bytes().count(b"\n") - 1
    assert 19 <= n_known < uninterrupted.driver.history[-1].evaluations
    again = resume(models, path, n_workers=n_workers)
    assert again.get_val("x").tolist() == uninterrupted.get_val("x").tolist()
    assert again.driver.history == uninterrupted.driver.history


@pytest.mark.parametrize("n_lines", [1, 2, 9, 30, 60])
@pytest.mark.parametrize("and_half_a_line", [False, True])
def test_resumed_from_anywhere_it_is_the_same_search(models, finished, n_lines, and_half_a_line):
    prob, path = finished
    whole = path.read_bytes()
    cut(path, n_lines, and_half_a_line)
    again = resume(models, path)
    assert again.driver.history == prob.driver.history
    assert again.driver.message == prob.driver.message
    assert again.get_val("x").tolist() == prob.get_val("x").tolist()
    assert path.read_bytes() == whole


def test_a_finished_search_runs_its_model_twice_more_only(models, finished):
    """Once to see that it is the model of the checkpoint, and once at the best design."""
    prob, path = finished
    again = models.problem(checkpoint=path)
    runs = []
    again.model.disc.compute = lambda *args: (runs.append(1), type(again.model.disc).compute(
        again.model.disc, *args))  # fmt: skip
    again.run_driver()
    assert len(runs) == 2
    assert again.driver.history == prob.driver.history


def test_more_generations_go_on_from_the_end(models, finished):
    _, path = finished
    straight = models.problem(max_gen=14)
    straight.run_driver()
    longer = resume(models, path, max_gen=14)
    assert longer.driver.history == straight.driver.history
    assert longer.get_val("x").tolist() == straight.get_val("x").tolist()


def test_without_a_seed_the_checkpoint_remembers_the_one_that_was_drawn(models, tmp_path):
    path = tmp_path / "new" / "folder" / "checkpoint"
    first = resume(models, path, seed=None)
    other = resume(models, tmp_path / "other", seed=None)
    cut(path, 12)
    again = resume(models, path, seed=None)
    assert again.driver.history == first.driver.history
    assert other.driver.history != first.driver.history


def test_time_that_ran_out_is_given_later(models, tmp_path):
    straight = models.problem()
    straight.run_driver()
    slow = functools.partial(models.build, seconds=0.01)
    path = tmp_path / "checkpoint"
    short = models.problem(slow, checkpoint=path, time_budget=0.1)
    short.run_driver()
    assert "stopped at the end of its time budget" in short.driver.message
    assert 0 < path.read_bytes().count(b"\n") - 1 < 72
    assert short.get_val("f")[0] == short.driver._search.best.objective
    again = resume(models, path, time_budget=60)
    assert again.driver.history == straight.driver.history


def test_no_time_at_all_is_one_design(models):
    prob = models.problem(time_budget=0)
    prob.run_driver()
    assert prob.get_val("x").tolist() == [0.5, 0.5]
    assert "after 0 generations, 1 designs" in prob.driver.message


def test_recorded_cases_are_whole_after_a_resume(models, finished, tmp_path):
    """What the checkpoint does not hold is nan, and nothing is what another design has left."""

    def cases(prob, name):
        prob.driver.add_recorder(om.SqliteRecorder(tmp_path / name))
        prob.driver.recording_options["includes"] = ["*"]
        prob.run_driver()
        prob.cleanup()
        return om.CaseReader(tmp_path / name).get_cases("driver")

    _, path = finished
    straight = cases(models.problem(), "straight.sql")
    cut(path, 30)
    resumed = cases(models.problem(checkpoint=path), "resumed.sql")
    assert len(resumed) == len(straight)
    for before, after in zip(straight, resumed, strict=True):
        assert after.success == before.success and after.msg == before.msg
        assert after["x"].tolist() == before["x"].tolist()
        assert after["radius"] == before["radius"]
        if before.success:
            assert after["f"] == before["f"] and after["g"].tolist() == before["g"].tolist()
    failed = next(case for case in resumed if not case.success)
    assert np.isnan(failed["f"]).all()


# --- one search at a time, and files that cannot be written -------------------------------------


def test_a_second_search_on_a_checkpoint_is_refused_before_any_work(models, finished):
    prob, path = finished
    cut(path, 30)
    before = path.read_bytes()
    with locked(path):
        second = models.problem(checkpoint=path)
        with pytest.raises(InUseError, match="checkpoint' is in use by process .*; wait until"):
            second.run_driver()
        assert second.driver.iter_count == 0 and path.read_bytes() == before
    assert resume(models, path).driver.history == prob.driver.history
    assert not path.with_name("checkpoint.lock").exists()


@pytest.mark.parametrize("option", ["checkpoint", "best_file"])
@pytest.mark.parametrize(
    ("name", "reason"), [("file/below", "cannot be written"), ("folder", "it is a folder")]
)
def test_a_file_that_cannot_be_written_is_known_before_the_first_design(
    models, tmp_path, option, name, reason
):
    (tmp_path / "file").touch()
    (tmp_path / "folder").mkdir()
    prob = models.problem(**{option: tmp_path / name})
    with pytest.raises(OutputError, match=reason) as raised:
        prob.run_driver()
    assert prob.driver.iter_count == 0 and "\n" not in str(raised.value)


# --- files that cannot be resumed ---------------------------------------------------------------


@pytest.mark.parametrize("content", [b"hello", b"hello\n", b"SQLite format 3\0\1\2\n\3", b"{}\n"])
def test_a_foreign_file_is_refused_and_left_alone(models, tmp_path, content):
    path = tmp_path / "cases.sql"
    path.write_bytes(content)
    with pytest.raises(ValueError, match=r"cases.sql' is not a checkpoint of a search"):
        resume(models, path)
    assert path.read_bytes() == content


def test_an_empty_file_or_half_a_header_is_a_new_search(models, finished, tmp_path):
    prob, path = finished
    header = path.read_bytes().splitlines(keepends=True)[0]
    for content in (b"", header[:60]):
        path.write_bytes(content)
        assert resume(models, path).driver.history == prob.driver.history


@pytest.mark.parametrize("n_line", [2, 40])
def test_one_changed_digit_is_found(models, finished, n_line):
    _, path = finished
    lines = path.read_bytes().splitlines(keepends=True)
    checksum, text = lines[n_line - 1].split(b" ", 1)
    assert b"5" in text
    lines[n_line - 1] = checksum + b" " + text.replace(b"5", b"6", 1)
    path.write_bytes(b"".join(lines))
    with pytest.raises(ValueError, match=f"is corrupt in line {n_line}; cut the file off before"):
        resume(models, path)


@pytest.mark.parametrize(
    ("options", "reason"),
    [
        ({"seed": 5}, "seed is 4 there and 5 here"),
        ({"pop_size": 9}, "pop_size is 8 there and 9 here"),
        ({"strategy": "rand1bin"}, "strategy is best1bin there and rand1bin here"),
    ],
)
def test_other_options_are_refused(models, finished, options, reason):
    with pytest.raises(ValueError, match=f"of another search: {reason}"):
        resume(models, finished[1], **options)


def test_another_problem_is_refused(models, finished, problem):
    _, path = finished
    other = problem(lambda x: (x @ x, x), [0.0] * 2, [1.0] * 2, n_g=2, pop_size=8, seed=4,
                    checkpoint=path)  # fmt: skip
    with pytest.raises(ValueError, match="of another search: design variables is"):
        other.run_driver()
    elsewhere = models.problem(checkpoint=path)
    elsewhere.set_val("x", [0.4, 0.5])
    with pytest.raises(ValueError, match="of another search: initial position is"):
        elsewhere.run_driver()
    bounds = models.problem(checkpoint=path)
    bounds.model.set_design_var_options("x", lower=-1.5, upper=1.6)
    with pytest.raises(ValueError, match="of another search: design variables is"):
        bounds.run_driver()


def test_another_model_of_the_same_variables_is_refused(models, finished):
    _, path = finished
    with pytest.raises(ValueError, match=r"of another model: at the same design disc\.g was"):
        resume(models, path, factory=functools.partial(models.build, radius=1.1))


def test_designs_that_this_search_does_not_make_are_refused(models, finished, tmp_path):
    """As another version of SciPy may draw them."""
    _, path = finished
    resume(models, tmp_path / "other", seed=5)
    head, *_ = path.read_bytes().splitlines(keepends=True)
    _, first, *others = (tmp_path / "other").read_bytes().splitlines(keepends=True)
    path.write_bytes(head + first + b"".join(others))
    with pytest.raises(ValueError, match="cannot be resumed: its design 2 is not the one"):
        resume(models, path)


def test_every_line_is_a_checksum_and_json(finished):
    prob, path = finished
    header, *entries = (json.loads(line[9:]) for line in path.read_text().splitlines())
    assert header["format"] == "propmdao search 1" and header["seed"] == 4
    assert len(entries) == prob.driver.history[-1].evaluations
    assert {"design", "failure", "outputs"} == set(entries[0])
    assert sum(bool(entry["failure"]) for entry in entries) == prob.driver.failed_candidates > 0

"""A time limit for every design: what hangs is ended, has failed, and the search goes on."""

import csv
import functools
import multiprocessing
import signal
import threading
import time
from concurrent.futures import ThreadPoolExecutor

import numpy as np
import pytest

from propmdao.components import DifferentialEvolutionDriver, SweepDriver


@pytest.mark.parametrize("n_workers", [pytest.param(1, marks=pytest.mark.slow), 2])
def test_a_design_that_hangs_has_failed_and_the_search_goes_on(models, n_workers):
    hanging = functools.partial(models.build, trouble="hang")
    options = {"max_gen": 1, "pop_size": 6, "seed": 13}  # one design hangs, and a later one is best
    prob = models.problem(hanging, n_workers=n_workers, design_time_limit=1.5, **options)
    begin = time.monotonic()
    prob.run_driver()
    assert time.monotonic() - begin < 200.0
    assert any(reason.startswith("took longer than 1.5") for reason in prob.driver.failure_reasons)
    assert prob.driver.history[-1].evaluations == 12
    x = prob.get_val("x")
    assert x[1] <= 1.2 and prob.get_val("f")[0] == pytest.approx(
        100.0 * (x[1] - x[0] ** 2) ** 2 + (1.0 - x[0]) ** 2
    )
    assert not multiprocessing.active_children()


def test_the_search_does_not_depend_on_a_limit_that_is_kept(models):
    plain, limited = models.problem(), models.problem(n_workers=2, design_time_limit=100)
    plain.run_driver()
    limited.run_driver()
    assert limited.driver.history == plain.driver.history
    assert limited.get_val("x").tolist() == plain.get_val("x").tolist()
    assert limited.get_val("g").tolist() == plain.get_val("g").tolist()


def test_a_factory_that_fails_is_told_as_by_other_workers(models):
    prob = models.problem(design_time_limit=100)
    prob.driver.options["problem_factory"] = int
    with pytest.raises(ValueError, match="must return a Problem that has been set up; it ret"):
        prob.run_driver()


def test_other_ways_to_run_have_no_limit(models):
    with ThreadPoolExecutor(1) as executor:
        prob = models.problem(executor=executor, design_time_limit=1)
        with pytest.raises(ValueError, match="design_time_limit 1 ends .* not an executor"):
            prob.run_driver()
    with pytest.raises(ValueError, match="give problem_factory"):
        models.problem(problem_factory=None, design_time_limit=1).run_driver()


@pytest.mark.parametrize("limit", [0, -1.0, np.nan, np.inf])
def test_a_limit_that_is_no_time_is_refused(limit):
    with pytest.raises(ValueError, match=f"design_time_limit is {limit}; it is a number of sec"):
        DifferentialEvolutionDriver(design_time_limit=limit)


def test_compilation_in_the_first_design_of_a_process_does_not_count(models):
    slow_at_first = functools.partial(models.build, trouble="compile")
    prob = models.problem(slow_at_first, design_time_limit=1.0, max_gen=0)
    prob.run_driver()
    assert prob.driver.failure_reasons.keys() <= {"disc: left of -1"}
    assert prob.driver.history[-1].evaluations == 8


def test_a_design_that_kills_its_process_has_failed(models, tmp_path):
    deadly = functools.partial(models.build, trouble="kill", flag=tmp_path / "once")
    prob = models.problem(deadly, design_time_limit=100, max_gen=1, pop_size=6)
    prob.run_driver()
    reasons = prob.driver.failure_reasons
    assert reasons["its process ended without a result: killed, out of memory or crashed"] == 1
    assert prob.driver.history[-1].evaluations == 12


def test_an_interrupt_ends_the_processes_at_once(models, tmp_path):
    flag = tmp_path / "hangs"
    hanging = functools.partial(models.build, trouble="hang", flag=flag)
    prob = models.problem(hanging, n_workers=2, design_time_limit=500)
    # A shell's job in the background ignores interrupts, and so would the tests in it.
    signal.signal(signal.SIGINT, signal.default_int_handler)
    main = threading.get_ident()

    def interrupt_when_one_hangs():
        deadline = time.monotonic() + 60.0
        while not flag.exists() and time.monotonic() < deadline:
            time.sleep(0.05)
        signal.pthread_kill(main, signal.SIGINT)

    thread = threading.Thread(target=interrupt_when_one_hangs)
    begin = time.monotonic()
    thread.start()
    with pytest.raises(KeyboardInterrupt):
        prob.run_driver()
    assert flag.exists() and time.monotonic() - begin < 60.0
    assert not multiprocessing.active_children()


def test_a_sample_that_hangs_is_a_row_that_says_so(models, tmp_path):
    hanging = functools.partial(models.build, trouble="hang")
    prob = hanging()
    samples = [{"x": {"val": [0.2, x1]}} for x1 in (0.4, 1.3, 0.6)]
    prob.driver = SweepDriver(
        samples,
        table=tmp_path / "sweep.csv",
        problem_factory=hanging,
        design_time_limit=1.5,
        progress=False,
    )
    prob.run_driver()
    with (tmp_path / "sweep.csv").open() as file:
        rows = list(csv.DictReader(file))
    assert [row["status"] for row in rows] == ["ok", "failed", "ok"]
    assert rows[1]["reason"].startswith("took longer than 1.5 s")

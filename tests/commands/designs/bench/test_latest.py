"""One worker and one waiting place: what is stale is never worked on."""

from __future__ import annotations

import threading

import pytest

from propmdao.commands.designs.bench.latest import LatestOnly


class Worker:
    """Work of two steps that waits to be let on at each."""

    def __init__(self) -> None:
        self.begun = threading.Semaphore(0)
        self.go_on = threading.Semaphore(0)
        self.steps: list[tuple[int, int]] = []
        self.refused: list[tuple[int, str]] = []
        self.latest = LatestOnly(self._steps, lambda job, why: self.refused.append((job, why)))

    def _steps(self, job):
        for step in (1, 2):
            self.begun.release()
            assert self.go_on.acquire(timeout=10.0)
            if job < 0:
                raise {-1: ValueError, -2: ZeroDivisionError}[job](f"job {job}")
            self.steps.append((job, step))
            yield


@pytest.fixture
def worker():
    made = Worker()
    yield made
    made.go_on.release(10)
    made.latest.close()


def test_only_the_latest_of_what_waits_is_worked_on(worker):
    worker.latest.ask(1)
    assert worker.begun.acquire(timeout=10.0)
    for job in (2, 3, 4):  # while the first step of 1 goes on
        worker.latest.ask(job)
    assert not worker.latest.wait(0.0)
    worker.go_on.release(3)
    assert worker.latest.wait(10.0)
    # The second step of 1 is left out, 2 and 3 altogether.
    assert worker.steps == [(1, 1), (4, 1), (4, 2)]


def test_who_never_pauses_gets_all_steps_of_every_other_job(worker):
    worker.latest.ask(1)
    for job in range(2, 7):
        assert worker.begun.acquire(timeout=10.0)
        worker.latest.ask(job)
        worker.go_on.release()
        if job % 2:  # the job before was left
            assert worker.begun.acquire(timeout=10.0)
            worker.go_on.release()
    worker.go_on.release(2)
    assert worker.latest.wait(10.0)
    assert worker.steps == [(1, 1), (2, 1), (2, 2), (3, 1), (4, 1), (4, 2), (5, 1), (6, 1), (6, 2)]


def test_an_error_is_said_in_one_line_and_the_next_job_is_done(worker):
    worker.go_on.release(4)
    for job in (-1, -2, 5):
        worker.latest.ask(job)
        assert worker.latest.wait(10.0)
    assert worker.refused == [(-1, "job -1"), (-2, "ZeroDivisionError: job -2")]
    assert worker.steps == [(5, 1), (5, 2)]


def test_after_the_end_nothing_is_begun(worker):
    worker.latest.ask(1)
    assert worker.begun.acquire(timeout=10.0)
    worker.go_on.release(1)
    worker.latest.close()
    assert worker.steps == [(1, 1)]
    worker.latest.ask(2)
    assert not worker.begun.acquire(timeout=0.1)

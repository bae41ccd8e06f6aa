"""One function at several things on threads: order, both cores, failures, one thread in workers."""

from __future__ import annotations

import threading

import pytest

from propmdao.runtime.side_by_side import n_cores, side_by_side


@pytest.fixture
def two_cores(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PJRT_NPROC", "2")


@pytest.mark.usefixtures("two_cores")
def test_two_run_at_the_same_time_and_results_keep_their_order() -> None:
    together = threading.Barrier(2)

    def function(i: int) -> int:
        together.wait(timeout=60.0)  # broken, and an error, unless a second one comes
        return -i

    assert side_by_side(function, range(6)) == [0, -1, -2, -3, -4, -5]


@pytest.mark.usefixtures("two_cores")
def test_the_first_failure_is_raised_and_the_rest_left_out() -> None:
    begun: list[int] = []

    def function(i: int) -> int:
        begun.append(i)
        if i in (1, 2):
            raise ValueError(f"no result of {i}")
        return i

    with pytest.raises(ValueError, match="no result of 1"):
        side_by_side(function, range(1000))
    assert len(begun) < 1000


def test_workers_have_one_core(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PJRT_NPROC", "1")
    assert n_cores() == 1
    assert side_by_side(lambda _: threading.current_thread(), range(3)) == (
        [threading.current_thread()] * 3
    )


def test_there_is_a_core(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.delenv("PJRT_NPROC", raising=False)
    assert n_cores() >= 1

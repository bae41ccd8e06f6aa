"""Outcomes of points on several threads: each has its own result, error and warnings."""

from __future__ import annotations

import threading
import warnings

import pytest

from propmdao.analysis.sweeping.outcomes import Outcome, hearing_warnings, outcome_of
from propmdao.runtime.side_by_side import side_by_side


def test_warnings_are_of_the_point_that_warns(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setenv("PJRT_NPROC", "2")
    together = threading.Barrier(2)

    def point(i: int) -> int:
        together.wait(timeout=60.0)  # both are under way
        for _ in range(2):
            warnings.warn(f"outside\nthe tables at {i}", stacklevel=1)
        together.wait(timeout=60.0)
        if i == 3:
            raise ValueError("no thrust")
        return i

    with hearing_warnings():
        outcomes = side_by_side(lambda i: outcome_of(point, i), range(4))
    assert [outcome.warnings for outcome in outcomes] == [
        [f"outside the tables at {i}"] for i in range(4)
    ]
    assert [outcome.result for outcome in outcomes[:3]] == [0, 1, 2]
    assert str(outcomes[3].result) == "no thrust"


def test_outside_of_the_block_warnings_are_python_s_own() -> None:
    with hearing_warnings():
        assert outcome_of(lambda: 1) == Outcome(1, [])
    with pytest.warns(UserWarning, match="loud"):
        warnings.warn("loud", stacklevel=1)


def test_an_outcome_says_what_it_is() -> None:
    with pytest.warns(UserWarning, match="outside"):
        assert Outcome(5, ["outside"]).said() == 5
    failed: Outcome[int] = Outcome(ValueError("no thrust"), [])
    with pytest.raises(ValueError, match="no thrust"):
        failed.said()

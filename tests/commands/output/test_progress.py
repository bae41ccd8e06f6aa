"""How far a command is, on stderr."""

import io

import pytest

from propmdao.aerodynamics.solutions.marching.marched_loads import MarchProgress
from propmdao.commands.output.progress import progress_line, progress_text, tell_progress

BEGUN = MarchProgress(1, 144, 0.1, float("nan"), 80 * 2**20)


def test_a_march_shows_steps_thrust_time_left_and_memory():
    assert progress_text(BEGUN) == "step 1 of 144, CT 0.1000, 80 MiB"
    under_way = MarchProgress(36, 144, 0.09876, 12.4, 80 * 2**20)
    assert progress_text(under_way) == "step 36 of 144, CT 0.0988, 12 s left, 80 MiB"


def test_the_line_is_overwritten_on_a_terminal_and_nowhere_else(monkeypatch: pytest.MonkeyPatch):
    tell_progress(is_quiet=False)
    monkeypatch.setattr("sys.stderr", stream := io.StringIO())
    assert progress_line() is None
    monkeypatch.setattr(stream, "isatty", lambda: True)
    show = progress_line()
    assert show is not None
    show(BEGUN)
    show(MarchProgress(144, 144, 0.1, 0.0, 80 * 2**20))
    first, second = stream.getvalue().split("\r")[1:]
    assert len(first) == 78 and second.endswith("\n")
    tell_progress(is_quiet=True)
    assert progress_line() is None

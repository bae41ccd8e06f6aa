"""How far a command is, on stderr."""

import io
import threading
import time

import jax
import pytest

from propmdao.aerodynamics.solutions.marching.marched_loads import MarchProgress
from propmdao.commands.output import progress
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


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def compile_for(seconds: float) -> None:
    """Tell of a compilation as JAX does."""
    jax.monitoring.record_event(progress._BEGINS)
    time.sleep(seconds)
    jax.monitoring.record_event_duration_secs(progress._ENDS, seconds)


def test_compilation_is_told_to_who_sits_at_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(progress, "_PATIENCE", 0.1)
    monkeypatch.setattr(progress, "_TICK", 0.01)

    def said(stream: io.StringIO, is_quiet: bool, n_threads: int = 1, seconds: float = 0.6) -> str:
        monkeypatch.setattr("sys.stderr", stream)
        tell_progress(is_quiet)
        with progress.telling_of_compilation("propmdao analyze"):
            time.sleep(0.2)
            threads = [
                threading.Thread(target=compile_for, args=(seconds,)) for _ in range(n_threads)
            ]
            for thread in threads:
                thread.start()
            for thread in threads:
                thread.join()
            compile_for(seconds)
        compile_for(min(seconds, 0.2))  # of which nobody is told
        return stream.getvalue()

    for n_threads in (1, 2):  # side by side takes no longer
        line = said(Terminal(), False, n_threads)
        text = "propmdao analyze: compiling, once on this machine: 1 s"
        assert line.count(text) == 2  # shown, taken away, shown again
        assert line.endswith("\r" + " " * len(text) + "\r") and "\n" not in line
    assert said(Terminal(), True, seconds=0.15) == ""  # longer than patience lasts
    assert said(io.StringIO(), False, seconds=0.15) == ""

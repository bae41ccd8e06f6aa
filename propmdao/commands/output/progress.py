"""What a command tells of its way, on stderr.

Lines are log records of the logger ``propmdao``; compilation and a march in time have one line each
that is overwritten. ``--quiet`` leaves out all of them.
"""

from __future__ import annotations

import contextlib
import logging
import math
import sys
import threading
import time
from collections.abc import Iterator
from typing import TYPE_CHECKING, Any, TextIO

from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.aerodynamics.solutions.marching.marched_loads import MarchProgress, Progress

_PATIENCE, _TICK = 1.0, 0.1  # s
# Events of JAX: a program is asked for that the cache may have, and a program is there.
_BEGINS = "/jax/compilation_cache/compile_requests_use_cache"
_ENDS = "/jax/core/compile/backend_compile_duration"
LOGGER = logging.getLogger("propmdao")


class _Lines(logging.Handler):
    """Log records as lines on stderr."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record."""
        print_line(record.getMessage(), error=True)


def tell_progress(is_quiet: bool) -> None:
    """Show progress on stderr, or not.

    Parameters
    ----------
    is_quiet : bool
        Whether progress is left out; warnings and errors are said all the same.
    """
    if not any(isinstance(handler, _Lines) for handler in LOGGER.handlers):
        LOGGER.addHandler(_Lines())
    LOGGER.setLevel(logging.WARNING if is_quiet else logging.INFO)


def progress(text: str) -> None:
    """Tell how far a command is.

    Parameters
    ----------
    text : str
        One line.
    """
    LOGGER.info("%s", text)


@contextlib.contextmanager
def telling_of_compilation(name: str) -> Iterator[None]:
    """Tell somebody at a terminal for how long code has been compiled, while it is.

    The line is overwritten and then taken away. Nothing is said of what is read from the cache, nor
    where there is none: each run compiles there.

    Parameters
    ----------
    name : str
        Name of the command, with which the line begins.
    """
    if (stream := _watched_stream()) is None:
        yield
        return
    line, over = _CompilationLine(name, stream), threading.Event()
    ticking = threading.Thread(target=line.tick_until, args=(over,), daemon=True)
    ticking.start()
    try:
        yield
    finally:
        over.set()
        ticking.join()


class _CompilationLine:
    """Line that counts the seconds in which something is compiled, in whatever thread."""

    def __init__(self, name: str, stream: TextIO) -> None:
        self._text = f"{name}: compiling, once on this machine: "
        self._stream, self._lock = stream, threading.Lock()
        self._threads: set[int] = set()  # which compile
        self._since = self._spent = 0.0
        self._shown = ""

    def tick_until(self, over: threading.Event) -> None:
        """Show the seconds, again and again."""
        while "jax" not in sys.modules or not hasattr(sys.modules["jax"], "monitoring"):
            if over.wait(_TICK):
                return
        monitoring = sys.modules["jax"].monitoring
        monitoring.register_event_listener(self._begin)
        monitoring.register_event_duration_secs_listener(self._end)
        while not over.wait(_TICK):
            with self._lock:
                seconds = self._spent + time.monotonic() - self._since
                if self._threads and seconds > _PATIENCE:
                    self._show(f"{self._text}{seconds:.0f} s")
        monitoring.unregister_event_listener(self._begin)
        monitoring.unregister_event_duration_listener(self._end)

    def _begin(self, event: str, **_: Any) -> None:
        if event == _BEGINS:
            with self._lock:
                self._since = self._since if self._threads else time.monotonic()
                self._threads.add(threading.get_ident())

    def _end(self, event: str, _duration: float, **_: Any) -> None:
        if event == _ENDS:
            with self._lock:
                self._threads.discard(threading.get_ident())
                if not self._threads:
                    self._spent += time.monotonic() - self._since
                    self._show("")

    def _show(self, text: str) -> None:
        if text != self._shown:
            print(f"\r{text:<{len(self._shown)}}", end="", file=self._stream, flush=True)
            if not text:
                print("\r", end="", file=self._stream, flush=True)
            self._shown = text


def _watched_stream() -> TextIO | None:
    """Standard error, where it is a terminal and progress is not left out."""
    stream = sys.stderr
    if stream is None or not stream.isatty() or not LOGGER.isEnabledFor(logging.INFO):
        return None
    return stream


def progress_line() -> Progress | None:
    """Show a march on one line of standard error, overwritten step by step.

    Returns
    -------
    callable or None
        To be called after every step; None where nobody looks: standard error is no terminal, or
        progress is left out.
    """
    if (stream := _watched_stream()) is None:
        return None

    def show(march: MarchProgress) -> None:
        text = progress_text(march)
        end = "\n" if march.step == march.n_steps else ""
        print(f"\r{text:<78}", end=end, file=stream, flush=True)

    return show


def progress_text(march: MarchProgress) -> str:
    """How far a march is, in words.

    Parameters
    ----------
    march : MarchProgress
        Where it is.

    Returns
    -------
    str
        Steps, thrust, time left and memory.
    """
    left = march.seconds_left
    time = "" if math.isnan(left) else f", {left:.0f} s left"
    return (
        f"step {march.step} of {march.n_steps}, CT {march.CT:.4f}{time},"
        f" {march.memory / 2**20:.0f} MiB"
    )

"""What a command tells of its way, on stderr.

Lines are log records of the logger ``propmdao``; a march in time has one line that is overwritten.
``--quiet`` leaves out both.
"""

from __future__ import annotations

import contextlib
import logging
import math
import sys
import threading
from collections.abc import Iterator
from typing import TYPE_CHECKING

from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.aerodynamics.solutions.marching.marched_loads import MarchProgress, Progress

_PATIENCE = 2.0  # s
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
def telling_of_long_work(name: str) -> Iterator[None]:
    """Tell somebody at a terminal after two seconds that work goes on, and what may take so long.

    Parameters
    ----------
    name : str
        Name of the command, with which the line begins.
    """
    text = f"{name}: working; what a machine runs for the first time is compiled, up to a minute"
    timer = threading.Timer(_PATIENCE, progress, [text])
    timer.daemon = True
    if sys.stderr is not None and sys.stderr.isatty():
        timer.start()
    try:
        yield
    finally:
        timer.cancel()


def progress_line() -> Progress | None:
    """Show a march on one line of standard error, overwritten step by step.

    Returns
    -------
    callable or None
        To be called after every step; None where nobody looks: standard error is no terminal, or
        progress is left out.
    """
    stream = sys.stderr
    if stream is None or not stream.isatty() or not LOGGER.isEnabledFor(logging.INFO):
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

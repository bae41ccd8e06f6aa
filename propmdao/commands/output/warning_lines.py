"""Lines of a command on stderr: warnings, none twice, and how far a march in time is."""

from __future__ import annotations

import contextlib
import math
import sys
import warnings
from collections.abc import Iterator
from typing import TYPE_CHECKING

from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.aerodynamics.solutions.marching.marched_loads import MarchProgress, Progress


@contextlib.contextmanager
def warning_lines(command: str) -> Iterator[None]:
    """Print what is warned of within the block, when it has ended.

    Parameters
    ----------
    command : str
        Name of the command.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            yield
        finally:
            for message in dict.fromkeys(str(warning.message) for warning in caught):
                print_line(f"propmdao {command}: warning: {message}", error=True)


def progress_line() -> Progress | None:
    """Show a march on one line of standard error, overwritten step by step.

    Returns
    -------
    callable or None
        To be called after every step; None where nobody looks: standard error is no terminal.
    """
    stream = sys.stderr
    if stream is None or not stream.isatty():
        return None

    def show(progress: MarchProgress) -> None:
        text = progress_text(progress)
        end = "\n" if progress.step == progress.n_steps else ""
        print(f"\r{text:<78}", end=end, file=stream, flush=True)

    return show


def progress_text(progress: MarchProgress) -> str:
    """How far a march is, in words.

    Parameters
    ----------
    progress : MarchProgress
        Where it is.

    Returns
    -------
    str
        Steps, thrust, time left and memory.
    """
    left = progress.seconds_left
    time = "" if math.isnan(left) else f", {left:.0f} s left"
    return (
        f"step {progress.step} of {progress.n_steps}, CT {progress.CT:.4f}{time},"
        f" {progress.memory / 2**20:.0f} MiB"
    )

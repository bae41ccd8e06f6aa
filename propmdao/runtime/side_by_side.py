"""A function of one thing at several: on threads, for all cores of the processor."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable
from concurrent.futures import ThreadPoolExecutor
from typing import TypeVar

Argument = TypeVar("Argument")
Result = TypeVar("Result")


def n_cores() -> int:
    """Cores that this process may use: one in a worker, which leaves the others to its like."""
    if own := os.environ.get("PJRT_NPROC"):  # what XLA's own threads are counted by
        return int(own)
    if hasattr(os, "sched_getaffinity"):
        return len(os.sched_getaffinity(0))
    return os.cpu_count() or 1


def side_by_side(
    function: Callable[[Argument], Result], arguments: Iterable[Argument]
) -> list[Result]:
    """Results of a function of one argument, on as many threads as there are cores.

    Compiled code runs without Python's lock, and one that solves for a single point keeps hardly
    more than one core busy. What two threads need compiled is compiled once.

    Parameters
    ----------
    function : callable
        Function that other threads may run at the same time.
    arguments : iterable
        Argument of each call.

    Returns
    -------
    list
        Results in the order of the arguments.

    Raises
    ------
    Exception
        What the first argument that has no result raises; what has not begun then is left out.
    """
    arguments = list(arguments)
    n_threads = min(n_cores(), len(arguments))
    if n_threads < 2:
        return [function(argument) for argument in arguments]
    with ThreadPoolExecutor(n_threads) as threads:
        return list(threads.map(function, arguments))

"""A function of one thing at several: on all cores, or in one compiled call on all devices."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Sequence
from concurrent.futures import ThreadPoolExecutor
from functools import cache
from operator import itemgetter
from typing import Any, TypeVar

import jax
import numpy as np
from jax.sharding import Mesh, NamedSharding, PartitionSpec

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_POINTS = PartitionSpec("points")


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


def is_accelerated() -> bool:
    """Whether JAX computes on something else than a processor."""
    return jax.default_backend() != "cpu"


def at_all(function: Callable[[Any, Any], Any], shared: Any, points: Any) -> Any:
    """Evaluate ``function(shared, point)`` at points that have a leading axis, within ``jax.jit``.

    With several devices each has its part of the points and nothing to do with the others: a search
    ends where its own points have ended theirs.

    Parameters
    ----------
    function : callable
        Function of pytrees of arrays.
    shared : pytree
        What all points share.
    points : pytree
        Points as `stacked` makes them.

    Returns
    -------
    pytree
        Results with the leading axis of points.
    """

    def of_device(shared: Any, points: Any) -> Any:
        return jax.vmap(lambda point: function(shared, point))(points)

    if _mesh().size == 1:
        return of_device(shared, points)
    specs = (PartitionSpec(), _POINTS)
    # Unchecked, for a loop of which a device decides by itself when it ends is more than the check
    # knows of.
    shared_out = jax.shard_map(
        of_device, mesh=_mesh(), in_specs=specs, out_specs=_POINTS, check_vma=False
    )
    return shared_out(shared, points)


def stacked(points: Sequence[Any], size: int) -> Any:
    """Put points into one record, and each on its device.

    Parameters
    ----------
    points : sequence of pytrees of numbers
        One point at least.
    size : int
        Number of points that code is compiled for; no less than these.

    Returns
    -------
    pytree
        Arrays with a leading axis, the last point repeated at its end: `size` rounded up to a
        multiple of the number of devices.
    """
    filled = [*points, *[points[-1]] * (filled_size(size) - len(points))]
    together = jax.tree.map(lambda *values: np.stack(values).astype(float), *filled)
    if _mesh().size == 1:
        return together
    return jax.device_put(together, NamedSharding(_mesh(), _POINTS))


def taken_apart(together: Any, n_points: int) -> list[Any]:
    """Take records of several points apart, those of `stacked` or of what came of them.

    Parameters
    ----------
    together : pytree of arrays
        Arrays with a leading axis of points.
    n_points : int
        Points that are wanted; what fills the axis up behind them is left out.

    Returns
    -------
    list of pytrees
        NumPy's arrays and numbers of each point.
    """
    values = jax.device_get(together)
    return [jax.tree.map(itemgetter(place), values) for place in range(n_points)]


def filled_size(size: int) -> int:
    """Least multiple of the number of devices that is no smaller."""
    return -(-size // _mesh().size) * _mesh().size


def free_memory() -> int:
    """Bytes that a program may take on each device, all of a processor's main memory among them."""
    statistics = jax.local_devices()[0].memory_stats()
    if statistics and "bytes_limit" in statistics:
        return int(statistics["bytes_limit"] - statistics.get("bytes_in_use", 0))
    if not hasattr(os, "sysconf"):  # Windows says it to no module of Python's own
        return 2**63
    return os.sysconf("SC_PHYS_PAGES") * os.sysconf("SC_PAGE_SIZE") // _mesh().size


@cache
def _mesh() -> Mesh:
    """All devices of this process, along one axis."""
    return Mesh(np.array(jax.local_devices()), ("points",))

"""A function that remembers its results for the last points it was called with."""

from __future__ import annotations

import threading
from collections import deque
from collections.abc import Callable
from typing import Generic, TypeVar

import numpy as np

from propmdao.components.bases.array_function import Arrays

Result = TypeVar("Result")

#: Held while the results of points are looked up or kept; one for all, for components are copied.
_LOCK = threading.Lock()


class LastPoints(Generic[Result]):
    """A function of a point that remembers its results for the last points it was called with.

    Points are the same where all values are equal to the last bit: nothing stale is ever returned.
    It may be called at several points at once, on threads.

    Parameters
    ----------
    function : callable
        Function of a dictionary of arrays.
    n_points : callable
        Returns the number of points that are remembered.
    """

    def __init__(self, function: Callable[[Arrays], Result], n_points: Callable[[], int]) -> None:
        self._function, self._n_points = function, n_points
        self._results: deque[tuple[Arrays, Result]] = deque()

    def __call__(self, inputs: Arrays) -> Result:
        """Return the function's result, computed where the inputs are not those of a last point."""
        result = self.known(inputs)
        if result is None:
            result = self._function(inputs)
            self.keep(inputs, result)
        return result

    def known(self, inputs: Arrays) -> Result | None:
        """Result at inputs that are those of a last point; None at any others."""
        with _LOCK:
            results = tuple(self._results)
        return next((result for point, result in results if _same(point, inputs)), None)

    def keep(self, inputs: Arrays, result: Result) -> None:
        """Remember a result, and forget the oldest where there are too many."""
        with _LOCK:
            self._results.append((inputs, result))
            while len(self._results) > self._n_points():
                self._results.popleft()

    def last(self) -> Result | None:
        """Return the result at the last new point; None before there is one."""
        return self._results[-1][1] if self._results else None


def _same(a: Arrays, b: Arrays) -> bool:
    # The small ones, as the speed, first: they tell points of one mesh apart.
    return all(np.array_equal(a[name], b[name]) for name in sorted(a, key=lambda n: a[n].size))

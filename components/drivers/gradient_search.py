"""A search by derivatives: SLSQP of SciPy, as OpenMDAO runs it, with its history and cost."""

from __future__ import annotations

import os
import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

import numpy as np
import openmdao.api as om

from propmdao.components.drivers.search_history import (
    SearchHistory,
    SearchRecorder,
    Trial,
    read_history,
    trial_of,
)

#: Function that is told of every design: its number, counted from 1, the design, and the driver,
#: whose model holds it.
Watch = Callable[[int, Trial, om.ScipyOptimizeDriver], None]


class Search(NamedTuple):
    """A search for a design: what it tried and how long it took.

    Attributes
    ----------
    history : SearchHistory
        Designs that the search has tried.
    seconds : float
        Time for these designs and their derivatives [s].
    compiling : float
        Time before, for the first analysis and the first derivatives [s]; nearly all of it
        compiles.
    """

    history: SearchHistory
    seconds: float
    compiling: float


class _WatchedDriver(om.ScipyOptimizeDriver):
    """SciPy's optimisers, which tell of every design."""

    def __init__(self, watch: Watch | None, **options: Any) -> None:
        super().__init__(**options)
        self._watch = watch
        self._n_told = 0

    def record_iteration(self) -> None:
        """Record a design, whether its analysis has failed or not, and tell of it."""
        super().record_iteration()
        if self._watch is None:
            return
        self._n_told += 1
        failure = sys.exc_info()[1]
        if failure is not None:
            trial = Trial(np.nan, np.inf, str(failure))
        else:
            (objective,) = self.get_objective_values(driver_scaling=False).values()
            values = self.get_constraint_values(driver_scaling=False)
            trial = trial_of(float(np.ravel(objective)[0]), values, self._cons)
        self._watch(self._n_told, trial, self)


def run_slsqp(
    prob: om.Problem,
    file: str | os.PathLike[str],
    tolerance: float = 1e-5,
    iterations: int = 100,
    watch: Watch | None = None,
) -> Search:
    """Search with SLSQP, and leave the optimum in the problem.

    SLSQP holds vector and two-sided constraints, and never leaves the bounds of the variables. It
    starts from a unit matrix for the curvature: scale variables by ``ref`` so that they change by
    about one and the objective so that its slope is about one, or the first step leaves for a
    corner of the bounds.

    Parameters
    ----------
    prob : om.Problem
        Problem after ``setup``, with design variables, constraints and one objective. The search
        starts from the values that it holds.
    file : path
        File in which the cases are recorded; an earlier one is replaced.
    tolerance : float
        Change of the scaled objective, and sum of the scaled violations, that end the search.
    iterations : int
        Largest number of iterations, each of which costs one set of derivatives and mostly one
        analysis.
    watch : callable, optional
        Function that is told of every design when it has been analysed: its number, the `Trial`,
        and the driver.

    Returns
    -------
    Search
        History and time.

    Raises
    ------
    om.AnalysisError
        When an analysis fails: SLSQP cannot do without a value. Bounds and constraints on the
        design variables should leave out what cannot be analysed.
    """
    prob.driver = _WatchedDriver(
        watch, optimizer="SLSQP", tol=tolerance, maxiter=iterations, disp=False
    )
    prob.driver.add_recorder(SearchRecorder(file))
    started = time.perf_counter()
    prob.run_model()
    prob.compute_totals()
    compiled = time.perf_counter()
    try:
        prob.run_driver()
    finally:
        prob.cleanup()
    return Search(read_history(prob, file), time.perf_counter() - compiled, compiled - started)

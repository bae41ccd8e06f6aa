"""A search by derivatives: SLSQP of SciPy, as OpenMDAO runs it, with its history and cost."""

from __future__ import annotations

import os
import time
from typing import NamedTuple

import openmdao.api as om

from propmdao.components.drivers.search_history import SearchHistory, read_history


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


def run_slsqp(
    prob: om.Problem, file: str | os.PathLike[str], tolerance: float = 1e-5, iterations: int = 100
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
    prob.driver = om.ScipyOptimizeDriver(
        optimizer="SLSQP", tol=tolerance, maxiter=iterations, disp=False
    )
    prob.driver.add_recorder(om.SqliteRecorder(os.fspath(file), record_viewer_data=False))
    started = time.perf_counter()
    prob.run_model()
    prob.compute_totals()
    compiled = time.perf_counter()
    try:
        prob.run_driver()
    finally:
        prob.cleanup()
    return Search(read_history(prob, file), time.perf_counter() - compiled, compiled - started)

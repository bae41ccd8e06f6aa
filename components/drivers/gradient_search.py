"""A search by derivatives: SLSQP of SciPy, as OpenMDAO runs it, with what it tried and cost."""

from __future__ import annotations

import os
import time
from typing import NamedTuple

import openmdao.api as om

from propmdao.components.drivers.search_history import SearchHistory, read_history


class Search(NamedTuple):
    """How a design was found.

    Attributes
    ----------
    history : SearchHistory
        Designs tried.
    seconds : float
        For these.
    compiling : float
        Before, for the first analysis and the first derivatives: nearly all of it compiles.
    """

    history: SearchHistory
    seconds: float
    compiling: float


def run_slsqp(
    prob: om.Problem, file: str | os.PathLike[str], tolerance: float = 1e-5, iterations: int = 100
) -> Search:
    """Leave the optimum in a problem and say how it was found.

    SLSQP holds vector and two-sided constraints, and never leaves the bounds of the variables. It
    starts from a unit matrix for the curvature: scale variables by ``ref`` so that they change by
    about one and the objective so that its slope is about one, or the first step leaves for a
    corner of the bounds.

    Parameters
    ----------
    prob : om.Problem
        After ``setup``, with design variables, constraints and one objective; the start is what it
        holds.
    file : path
        Where the cases are recorded; an earlier file is replaced.
    tolerance : float
        In the scaled objective and the sum of the scaled constraints, that ends the search.
    iterations : int
        Most iterations, each of which costs one set of derivatives and mostly one analysis.

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

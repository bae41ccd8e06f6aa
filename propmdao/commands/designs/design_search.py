"""The search of ``propmdao optimise``: it tells of every design and can be gone on with."""

from __future__ import annotations

import contextlib
import io
import json
import warnings
from collections.abc import Callable
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.wakes.edgewise import FastEdgewiseWarning
from propmdao.commands.output.progress import progress
from propmdao.components.drivers.best_design_file import write_best_design
from propmdao.components.drivers.differential_evolution_driver import DifferentialEvolutionDriver
from propmdao.components.drivers.gradient_search import run_slsqp
from propmdao.components.drivers.search_history import (
    SearchHistory,
    SearchRecorder,
    read_history,
)
from propmdao.propeller.design_choices import RESPONSES
from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.components.drivers.search_history import Trial

#: Violation of a constraint in driver scaling that counts as none.
TOLERANCE = 1e-4
#: Change of the scaled objective that ends a search by derivatives, 1e-6 dB of a level: by 1e-4 dB
#: it ends where it rests for some steps, 0.06 dB above the optimum.
_SETTLED = 1e-7
_CASES, _BEST, _CHECKPOINT = "cases.sql", "best_design.json", "evolution.checkpoint"


def run_search(
    prob: om.Problem,
    folder: Path,
    search: dict[str, Any],
    minimise: str,
    factory: Callable[[], om.Problem],
) -> SearchHistory:
    """Search for a design, and leave the best one in the problem.

    Parameters
    ----------
    prob : om.Problem
        Problem of `design_problem`.
    folder : Path
        Folder of results. A search by derivatives begins at the best design that is there, one by
        evolution goes on from its checkpoint.
    search : dict
        How is searched, of `design_options.search_of`.
    minimise : str
        Word of what is minimised.
    factory : callable
        Function that makes the problem anew, for worker processes.

    Returns
    -------
    SearchHistory
        All designs of this run.

    Raises
    ------
    ValueError
        If no design meets the limits.
    """
    label = RESPONSES[minimise].label
    with warnings.catch_warnings():
        # There are more limits than variables where sections have a least thickness, but these
        # cost nothing backward: they depend on the splines alone.
        warnings.filterwarnings("ignore", category=om.DerivativesWarning)
        warnings.filterwarnings("ignore", category=om.OMDeprecationWarning)
        # The analyses of both blades, before and after, tell of it.
        warnings.filterwarnings("ignore", category=FastEdgewiseWarning)
        if search["method"] == "evolution":
            return _evolve(prob, folder, search, factory, label)
        return _descend(prob, folder, search["iterations"], label)


def _descend(prob: om.Problem, folder: Path, iterations: int, label: str) -> SearchHistory:
    """Search by derivatives."""
    best: list[Trial] = []
    prob.final_setup()
    if (folder / _BEST).exists():
        evaluations = _take(prob, folder / _BEST)
        progress(f"going on from the best design of {evaluations} in {folder / _BEST}")

    def watch(number: int, trial: Trial, driver: om.ScipyOptimizeDriver) -> None:
        progress(_line(number, trial, label))
        if np.isfinite(trial.violation) and (not best or _rank(trial) < _rank(best[0])):
            best[:] = [trial]
            write_best_design(folder / _BEST, driver, number)

    progress("compiling the analysis and its derivatives, the first time for a minute or more")
    try:
        with contextlib.redirect_stdout(io.StringIO()):  # OpenMDAO prints that SLSQP was stopped
            run_slsqp(prob, folder / _CASES, _SETTLED, iterations, watch)
        if prob.driver.fail:
            progress(
                f"stopped before it had converged, by --iterations {iterations} or for want of"
                " progress; the same command goes on from the best design"
            )
    except om.AnalysisError as error:
        if not best:
            raise ValueError(f"the first analysis has failed: {error}") from error
        print_line(
            f"propmdao optimise: warning: the search ended early, an analysis failed: {error}; the"
            " best design so far is taken. A narrower range or --de go around such designs",
            error=True,
        )
        _take(prob, folder / _BEST)
        prob.run_model()
    history = read_history(prob, folder / _CASES)
    if not best or best[0].violation > TOLERANCE:
        raise ValueError(_no_design(history))
    if history.violation[-1] > TOLERANCE:
        _take(prob, folder / _BEST)
        prob.run_model()
    return history


def _evolve(
    prob: om.Problem,
    folder: Path,
    search: dict[str, Any],
    factory: Callable[[], om.Problem],
    label: str,
) -> SearchHistory:
    """Search by differential evolution, and then by derivatives from the best design."""
    workers = {"n_workers": search["workers"], "problem_factory": factory}
    prob.driver = DifferentialEvolutionDriver(
        pop_size=search["population"],
        max_gen=search["generations"],
        seed=search["seed"],
        polish=True,
        checkpoint=(folder / _CHECKPOINT).absolute(),
        best_file=(folder / _BEST).absolute(),
        disp=False,
        progress=False,
        **(workers if search["workers"] > 1 else {}),
    )
    prob.driver.watch = lambda generation: progress(
        f"generation {generation.generation}: best {label} {generation.best_objective:.4f},"
        f" violation {generation.max_violation:.2g}, {generation.evaluations} designs,"
        f" {generation.failed} failed"
    )
    prob.driver.add_recorder(SearchRecorder(folder / _CASES))
    try:
        prob.run_driver()
    finally:
        prob.cleanup()
    progress(f"differential evolution: {prob.driver.message}")
    history = read_history(prob, folder / _CASES)
    if prob.driver.fail:
        raise ValueError(_no_design(history))
    return history


def _no_design(history: SearchHistory) -> str:
    least = int(np.argmin(history.violation))
    return (
        f"no design of {history.objective.size} meets the limits; the nearest misses"
        f" {history.constraint[least]} by {history.violation[least]:.3g} of its scale; try wider"
        " ranges, more that is free, or other limits"
    )


def _take(prob: om.Problem, path: Path) -> int:
    """Put the design of a file into a problem; how many designs had been evaluated then."""
    content = json.loads(path.read_text(encoding="utf-8"))
    for name, meta in prob.driver._designvars.items():
        value = np.array(content["design_variables"][name]["value"], float)
        # Units that are changed and changed back leave a point on its bound a digit beyond it.
        rounding = 1e-12 * (meta["upper"] - meta["lower"])
        value = np.clip(value, meta["lower"] + rounding, meta["upper"] - rounding)
        prob.driver._set_design_var(name, value, units=meta["units"])
    return int(content["evaluations"])


def _rank(trial: Trial) -> tuple[bool, float]:
    """Key that sorts best first: what meets all limits by objective, the rest by violation."""
    missed = trial.violation > TOLERANCE
    return missed, trial.violation if missed else trial.objective


def _line(number: int, trial: Trial, label: str) -> str:
    if not np.isfinite(trial.violation):
        return f"design {number}: failed: {trial.constraint}"
    violated = f", violation {trial.violation:.2g} ({trial.constraint})" if trial.constraint else ""
    return f"design {number}: {label} {trial.objective:.4f}{violated}"

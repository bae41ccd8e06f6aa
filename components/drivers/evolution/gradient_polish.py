"""SLSQP from the best design of a search, with the model's total derivatives."""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping
from functools import cache
from typing import Any, NamedTuple

import numpy as np
import openmdao.api as om
from numpy.typing import NDArray
from openmdao.core.driver import Driver
from scipy.optimize import minimize

from propmdao.components.drivers.evaluation.candidate import Array, Candidate
from propmdao.components.drivers.evaluation.design_problem import DesignProblem

#: Change of the objective, and sum of the violations, that end it; both over the first slope.
_TOLERANCE = 1e-10
_ITERATIONS = 100
#: How far within their bounds constraints are held, in driver scaling: SLSQP meets them to its
#: tolerance, and a design that is beyond a bound by rounding alone is not the best.
_WITHIN = 1e-9

_Totals = dict[tuple[str, str], Array]  # of a response by a design variable


class _Ended(Exception):
    """An analysis has failed, and SLSQP cannot do without a value."""


class _Point(NamedTuple):
    """Objective and constraints at a position; all that follows is over positions and scaled."""

    energy: Any  # a number, or its derivatives
    equal: Array  # zero where it holds
    within: Array  # at least zero where it holds, by a little


def polish(
    driver: Driver,
    problem: DesignProblem,
    evaluate: Callable[[Array], Candidate],
    start: Candidate,
) -> None:
    """Go from a design to the optimum near it; what is found there, `evaluate` keeps.

    Parameters
    ----------
    driver : Driver
        Driver of a Problem whose model has derivatives.
    problem : DesignProblem
        The model of the driver as a function of a design.
    evaluate : callable
        Function that evaluates a position (n_variables,) in the unit cube between the bounds, and
        leaves the model there.
    start : Candidate
        Design that has been analysed without a failure.

    Notes
    -----
    The objective is divided by its largest slope over the bounds at the start: the first step of
    SLSQP, which knows no curvature yet, is then of the size of the bounds at most. Derivatives cost
    a run of the model in this process each. A design whose analysis fails ends it.
    """
    slopes, linear = _slopes(driver, problem), cache(lambda: _linear_totals(driver))
    points: dict[bytes, _Point] = {}
    derivatives: dict[bytes, _Point] = {}
    span = problem.upper - problem.lower
    first = np.where(span > 0.0, (start.design - problem.lower) / np.where(span > 0.0, span, 1), 0)

    def value(position: Array) -> _Point:
        key = position.tobytes()
        if key not in points:
            candidate = evaluate(position)
            if candidate.failure:
                raise _Ended
            points[key] = _Point(candidate.energy, *_residuals(driver))
        return points[key]

    def slope(position: Array) -> _Point:
        key = position.tobytes()
        if key not in derivatives:
            problem.set_design(problem.at_position(position))
            try:
                driver._run_solve_nonlinear()
            except om.AnalysisError:
                raise _Ended from None
            (energy,) = driver.get_objective_values().values()
            points.setdefault(key, _Point(float(energy.item()), *_residuals(driver)))
            derivatives[key] = _derivatives(driver, slopes, linear())
        return derivatives[key]

    try:
        unit = float(np.abs(slope(first).energy).max()) or 1.0
        minimize(
            lambda x: value(x).energy / unit,
            first,
            jac=lambda x: slope(x).energy / unit,
            method="SLSQP",
            bounds=[(0.0, float(free)) for free in span > 0.0],
            constraints=[
                {"type": kind, "fun": lambda x, k=k: value(x)[k], "jac": lambda x, k=k: slope(x)[k]}
                for k, kind in ((1, "eq"), (2, "ineq"))
                if value(first)[k].size
            ],
            options={"ftol": _TOLERANCE, "maxiter": _ITERATIONS},
        )
    except _Ended:
        return


def _slopes(driver: Driver, problem: DesignProblem) -> Array:
    """Derivatives of the scaled design variables by the position, which scale them linearly."""
    ends = []
    for design in (problem.lower, problem.upper):
        problem.set_design(design)
        ends.append(np.concatenate(list(driver.get_design_var_values().values())))
    slopes: Array = ends[1] - ends[0]
    return slopes


class _Side(NamedTuple):
    """One side of a constraint, in driver scaling."""

    name: str
    is_equality: bool
    factor: Any  # scale of a violation, negative where the value has to stay below
    bound: Any
    bounded: NDArray[np.bool_]  # elements that have a bound there


def _sides(driver: Driver) -> list[_Side]:
    """All sides on which constraints are bounded."""
    sides = []
    for name, meta in driver._cons.items():
        scale = 1.0 if meta["total_scaler"] is None else np.abs(meta["total_scaler"])
        for side, sign in (("equals", 1.0), ("lower", 1.0), ("upper", -1.0)):
            bound = meta[side]
            # OpenMDAO keeps None for a bound that was not given; users also write 1e30.
            if bound is not None:
                bounded = np.broadcast_to(np.abs(bound) < 1e30, meta["size"])
                sides.append(_Side(name, side == "equals", sign * scale, bound, bounded))
    return sides


def _residuals(driver: Driver) -> tuple[Array, Array]:
    """Equalities and inequalities of the model as it is."""
    values = driver.get_constraint_values(driver_scaling=False)
    equal, within = _by_kind(
        (side, np.ravel(side.factor * (values[side.name] - side.bound))) for side in _sides(driver)
    )
    return equal, within - _WITHIN


def _derivatives(driver: Driver, slopes: Array, linear: _Totals) -> _Point:
    """Derivatives of objective, equalities and inequalities of the model as it is."""
    driver._total_jac = None
    totals = linear | driver._compute_totals(return_format="flat_dict")
    (objective,) = driver._objs

    def rows(name: str, size: int) -> Array:
        # A variable of linear constraints alone has no derivatives of the others.
        parts = [
            totals.get((name, variable), np.zeros((size, meta["size"])))
            for variable, meta in driver._designvars.items()
        ]
        joined: Array = np.concatenate(parts, axis=1) * slopes
        return joined

    def turned(side: _Side) -> Array:
        meta = driver._cons[side.name]
        scaler = meta["total_scaler"]
        sign = np.sign(side.factor) * (1.0 if scaler is None else np.sign(scaler))
        return np.broadcast_to(sign, meta["size"])[:, None] * rows(side.name, meta["size"])

    return _Point(rows(objective, 1)[0], *_by_kind((side, turned(side)) for side in _sides(driver)))


def _linear_totals(driver: Driver) -> _Totals:
    """Derivatives of the linear constraints, which are the same everywhere, in driver scaling.

    OpenMDAO leaves out the units of derivatives that are asked for by name, unless they are those
    of all responses that are not linear; so here they are asked for without its scaling.
    """
    names = [name for name, meta in driver._cons.items() if meta["linear"]]
    if not names:
        return {}
    variables = driver._designvars
    totals = driver._problem().compute_totals(names, list(variables))
    return {
        (name, variable): _scale(driver._cons[name])[:, None] * block / _scale(variables[variable])
        for (name, variable), block in totals.items()
    }


def _scale(meta: Mapping[str, Any]) -> Array:
    """Change of a variable in driver scaling with that in its own units: (size,)."""
    by_user, by_units = meta["total_scaler"], meta["unit_scaler"]
    scale = (1.0 if by_user is None else by_user) * (1.0 if by_units is None else by_units)
    return np.broadcast_to(scale, meta["size"])


def _by_kind(rows: Iterable[tuple[_Side, Array]]) -> tuple[Array, Array]:
    """Rows of the bounded elements: those of equalities, those of inequalities."""
    kinds: dict[bool, list[Array]] = {True: [], False: []}
    for side, values in rows:
        kinds[side.is_equality].append(values[side.bounded])
    equal, within = (np.concatenate(kind) if kind else np.empty(0) for kind in kinds.values())
    return equal, within

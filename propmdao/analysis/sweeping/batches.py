"""A propeller at several points: what they share is done once, blade elements in one call."""

from __future__ import annotations

import dataclasses
import warnings
from collections.abc import Callable, Iterator, Mapping, Sequence
from operator import itemgetter
from typing import Any, Generic, NamedTuple, ParamSpec, TypeVar

import jax
import numpy as np

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.aerodynamics.solutions import blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads
from propmdao.aerodynamics.trim import (
    Bounds,
    Trimmed,
    require_bounds,
    require_reached,
    rotation_bounds,
    solve_for_thrust,
)
from propmdao.analysis.elastic.deflections import Solved
from propmdao.analysis.elastic.modelled_blade import HeldBlade, ModelledBlade
from propmdao.analysis.request import Asked, Request
from propmdao.analysis.results import Analysis
from propmdao.analysis.single_point import analysis_of, require_analysable
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.models import Model
from propmdao.records.states import OperatingPoint, RotorState
from propmdao.runtime.compilation import compiled

#: Points that blade elements are solved for in one compiled call; fewer are filled up.
BATCH_SIZE = 64

Result = TypeVar("Result")
Given = ParamSpec("Given")


class Outcome(NamedTuple, Generic[Result]):
    """What has become of a point.

    Attributes
    ----------
    result : Analysis or Exception
        The analysis, or why there is none.
    warnings : list of str
        What was warned of, each once.
    """

    result: Result | Exception
    warnings: list[str]


def analyze_each(propeller: Propeller, asked: Sequence[Asked]) -> Iterator[Outcome[Analysis]]:
    """Analyse a propeller at several points, as `propmdao.analyze` does at one.

    The blade of each change is made ready once. Blade elements of a blade are solved for at all
    points in one call, the lattice at one point after the other: together it takes as long.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    asked : sequence of dict
        Single values of each point; blades and loads of all are held until the last is done.

    Yields
    ------
    Outcome
        What has become of each point, in their order; none of them raises.
    """
    requests = [_caught(_request, propeller, values) for values in asked]
    places: dict[tuple[Change, Model], list[int]] = {}
    for place, (request, _) in enumerate(requests):
        if isinstance(request, Request):
            places.setdefault((request.change, request.model), []).append(place)
    blades: dict[tuple[Change, Model], Outcome[ModelledBlade]] = {}
    known: dict[int, Solved | Exception] = {}
    for place, (request, of_request) in enumerate(requests):
        if isinstance(request, Exception):
            yield Outcome(request, of_request)
            continue
        key = request.change, request.model
        if key not in blades:
            blades[key] = _caught(ModelledBlade.of, propeller, *key)
            known |= _known(blades[key].result, {k: requests[k].result for k in places[key]})
        modelled, of_blade = blades[key]
        if isinstance(modelled, Exception):
            yield Outcome(modelled, [*of_request, *of_blade])
            continue
        result, of_point = _caught(_analysis, modelled, request, known.get(place))
        yield Outcome(result, list(dict.fromkeys([*of_request, *of_blade, *of_point])))


def _known(
    modelled: ModelledBlade | Exception, requests: Mapping[int, Any]
) -> dict[int, Solved | Exception]:
    """Loads that are solved for together, those of blade elements, by the place of the point."""
    if isinstance(modelled, Exception):
        return {}
    loads = modelled.model.loads
    if not loads.blade_element or loads.elastic is not None:
        return {}
    # Those at an incidence take so long each that nothing is gained.
    points = {k: r.point for k, r in requests.items() if r.point.incidence_deg == 0.0}
    return dict(zip(points, _solved(modelled.unloaded, [*points.values()]), strict=True))


def _caught(
    function: Callable[Given, Result], *args: Given.args, **kwargs: Given.kwargs
) -> Outcome[Result]:
    """Result of a function, or the exception that it raises, and its warnings."""
    result: Result | Exception
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            result = function(*args, **kwargs)
        except Exception as error:  # a survey of thousands of points does not end at one of them
            result = error
    said = dict.fromkeys(" ".join(str(warning.message).split()) for warning in caught)
    return Outcome(result, list(said))


def _request(propeller: Propeller, values: Asked) -> Request:
    request = Request.of(**values).completed(propeller)
    require_analysable(propeller, request)
    return request


def _analysis(
    modelled: ModelledBlade, request: Request, solved: Solved | Exception | None
) -> Analysis:
    if isinstance(solved, Exception):
        raise solved
    return analysis_of(modelled, request, solved)


def _solved(held: HeldBlade, points: Sequence[OperatingPoint]) -> list[Solved | Exception]:
    """Loads of the blade elements of a blade at several points, or why a point has none."""
    radius = float(held.rotor.radius)
    results: list[Solved | Exception] = []
    for first in range(0, len(points), BATCH_SIZE):
        batch = points[first : first + BATCH_SIZE]
        filled = [*batch, *[batch[-1]] * (BATCH_SIZE - len(batch))]
        solve = _at_rpm if batch[0].thrust is None else _at_thrust
        results += solve(held, filled, radius)[: len(batch)]
    return results


def _at_rpm(
    held: HeldBlade, points: Sequence[OperatingPoint], radius: float
) -> list[Solved | Exception]:
    states = [point.at(point.rotation_speed or 0.0) for point in points]
    loads = _each(_solve_all(held.case(points[0]), _stacked(states)))

    def solved(point: OperatingPoint, state: RotorState, loads: RotorLoads) -> Solved:
        require_subsonic_tip(radius, state)
        return held.solved(held.case(point), loads, state)

    every = zip(points, states, loads, strict=True)
    return [_caught(solved, *of_point).result for of_point in every]


def _at_thrust(
    held: HeldBlade, points: Sequence[OperatingPoint], radius: float
) -> list[Solved | Exception]:
    bounds = [rotation_bounds(radius, float(point.speed)) for point in points]
    states, thrusts = [point.at(0.0) for point in points], [float(p.thrust or 0.0) for p in points]
    every_trim = _trim_all(
        held.case(points[0]), _stacked(states), np.array(thrusts), _stacked(bounds)
    )

    def solved(point: OperatingPoint, within: Bounds, trimmed: Trimmed) -> Solved:
        require_bounds(within, float(point.speed))
        case = held.case(point)
        require_reached(trimmed, blade_element, case, point.thrust or 0.0, within)
        return held.solved(case, trimmed.loads, point.at(float(trimmed.rotation_speed)))

    every = zip(points, bounds, _each(every_trim), strict=True)
    return [_caught(solved, *of_point).result for of_point in every]


def _stacked(records: Sequence[Any]) -> Any:
    """Pytree of arrays with a leading axis of records."""
    return jax.tree.map(lambda *values: np.array(values, dtype=float), *records)


def _each(stacked: Any) -> list[Any]:
    """Records of a pytree of arrays with a leading axis."""
    values = jax.device_get(stacked)
    return [jax.tree.map(itemgetter(place), values) for place in range(BATCH_SIZE)]


@compiled
def _solve_all(case: RotorCase, states: RotorState) -> RotorLoads:
    """Loads by blade elements in states that have a leading axis."""

    def solve(state: RotorState) -> RotorLoads:
        return blade_element.solve(dataclasses.replace(case, state=state))

    return jax.vmap(solve)(states)


@compiled
def _trim_all(case: RotorCase, states: RotorState, thrusts: Any, bounds: Bounds) -> Trimmed:
    """Rotation speeds for thrusts in states that have a leading axis, by blade elements."""

    def trimmed(state: RotorState, thrust: Any, bounds: Bounds) -> Trimmed:
        return solve_for_thrust(
            blade_element, dataclasses.replace(case, state=state), thrust, bounds
        )

    return jax.vmap(trimmed)(states, thrusts, bounds)

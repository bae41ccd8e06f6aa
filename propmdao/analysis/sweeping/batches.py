"""A propeller at several points: what they share is done once, many in one call or on all cores."""

from __future__ import annotations

import dataclasses
from collections.abc import Iterator, Mapping, Sequence
from functools import partial
from typing import Any, NamedTuple

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.aerodynamics.calls import points_in_a_call
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.solutions import axial, blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched_loads import Progress
from propmdao.aerodynamics.solutions.result import RotorLoads
from propmdao.aerodynamics.trim import (
    Bounds,
    Solver,
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
from propmdao.analysis.sweeping.outcomes import Outcome, hearing_warnings, outcome_of
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.models import Model
from propmdao.records.states import OperatingPoint, RotorState
from propmdao.runtime.compilation import compiled
from propmdao.runtime.side_by_side import at_all, n_cores, side_by_side, stacked, taken_apart

_SHORT_POINTS = 8  # in axial flight, that a core has in a row


def analyze_each(
    propeller: Propeller,
    asked: Sequence[Asked | Request],
    *,
    polars: SectionPolars | None = None,
    progress: Progress | None = None,
) -> Iterator[Outcome[Analysis]]:
    """Analyse a propeller at several points, as `propmdao.analyze` does at one.

    The blade of each change is made ready once, and its points are solved for in compiled calls of
    several (`aerodynamics.calls`). Each core has a call of its own, and then the noise of a point
    of its own. Marches in time go one after the other, for the wakes of each fill memory.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    asked : sequence of dict or Request
        Single values of each point, or what they make; blades and loads of all are held until the
        last is done.
    polars : SectionPolars, optional
        Polars by `polars_for`, for tables of one's own; by default the catalogue's.
    progress : callable, optional
        Called after every step of a march in time, with a `MarchProgress`.

    Yields
    ------
    Outcome
        What has become of each point, in their order; none of them raises.
    """
    with hearing_warnings():
        requests = [outcome_of(_request, propeller, values) for values in asked]
        places: dict[tuple[Change, Model], list[int]] = {}
        for place, (request, _) in enumerate(requests):
            if isinstance(request, Request):
                places.setdefault((request.change, request.model), []).append(place)
        made = side_by_side(lambda key: outcome_of(_blade, propeller, *key, polars), places)
        blades = dict(zip(places, made, strict=True))
        batches = [
            batch
            for key, of_one in places.items()
            for batch in _batches(blades[key].result, {k: requests[k].result for k in of_one})
        ]
        known: dict[int, Solved | Exception] = {}
        for batch, solved in zip(batches, side_by_side(_Batch.solved, batches), strict=True):
            known |= zip(batch.points, solved, strict=True)

    def finished(place: int) -> Outcome[Analysis]:
        request, of_request = requests[place]
        if isinstance(request, Exception):
            return Outcome(request, of_request)
        modelled, of_blade = blades[request.change, request.model]
        if isinstance(modelled, Exception):
            return Outcome(modelled, [*of_request, *of_blade])
        solved = known.get(place)
        result, of_point = outcome_of(_analysis, modelled, request, solved, progress)
        return Outcome(result, list(dict.fromkeys([*of_request, *of_blade, *of_point])))

    n = _n_at_once([request for request, _ in requests if isinstance(request, Request)])
    for first in range(0, len(requests), n):
        with hearing_warnings():
            outcomes = side_by_side(finished, range(len(requests))[first : first + n])
        yield from outcomes


def _n_at_once(requests: Sequence[Request]) -> int:
    """Points after which those that are done are handed over.

    Many where they are short, lest a core waits for another; who stops loses few where not.
    """
    if any(request.model.loads.unsteady is not None for request in requests):
        return 1
    short = all(request.point.incidence_deg == 0.0 for request in requests)
    return n_cores() * (_SHORT_POINTS if short else 1)


class _Batch(NamedTuple):
    """Points of a blade that are solved for in one call.

    Attributes
    ----------
    solver : module
        Solver of the loads.
    held : HeldBlade
        The blade.
    points : dict of int to OperatingPoint
        Points by their places among all that are asked for.
    size : int
        Number of points that the code is compiled for.
    """

    solver: Solver
    held: HeldBlade
    points: dict[int, OperatingPoint]
    size: int

    def solved(self) -> list[Solved | Exception]:
        """Loads at the points, or why a point has none."""
        points = [*self.points.values()]
        solve = _at_rpm if points[0].thrust is None else _at_thrust
        result, _ = outcome_of(solve, self, points)
        return [result] * len(points) if isinstance(result, Exception) else result


def _batches(modelled: ModelledBlade | Exception, requests: Mapping[int, Any]) -> Iterator[_Batch]:
    """Points of a blade that are solved for together; the others have a call each.

    Those at an incidence are among the others: they take so long that nothing would be gained.
    """
    if isinstance(modelled, Exception):
        return
    loads = modelled.model.loads
    if loads.elastic is not None or loads.unsteady is not None:
        return
    solver: Solver = blade_element if loads.blade_element else axial
    for has_thrust in (False, True):
        points = [
            (place, request.point)
            for place, request in requests.items()
            if request.point.incidence_deg == 0.0
            and (request.point.thrust is not None) == has_thrust
        ]
        size = points_in_a_call(len(points), loads.blade_element)
        for first in range(0, len(points), size) if size > 1 else ():
            yield _Batch(solver, modelled.unloaded, dict(points[first : first + size]), size)


def _blade(
    propeller: Propeller, change: Change, model: Model, polars: SectionPolars | None
) -> ModelledBlade:
    """Make a blade ready, with its meshes, before several threads ask for them."""
    modelled = ModelledBlade.of(propeller, change, model, polars)
    _ = modelled.unloaded
    return modelled


def _request(propeller: Propeller, asked: Asked | Request) -> Request:
    request = asked if isinstance(asked, Request) else Request.of(**asked)
    request = request.completed(propeller)
    require_analysable(propeller, request)
    return request


def _analysis(
    modelled: ModelledBlade,
    request: Request,
    solved: Solved | Exception | None,
    progress: Progress | None,
) -> Analysis:
    if isinstance(solved, Exception):
        raise solved
    return analysis_of(modelled, request, solved, progress)


def _at_rpm(batch: _Batch, points: Sequence[OperatingPoint]) -> list[Solved | Exception]:
    held, radius = batch.held, float(batch.held.rotor.radius)
    states = [point.at(point.rotation_speed or 0.0) for point in points]
    case = held.case(points[0])
    loads = taken_apart(_solve_all(batch.solver, case, stacked(states, batch.size)), len(points))

    def solved(point: OperatingPoint, state: RotorState, loads: RotorLoads) -> Solved:
        require_subsonic_tip(radius, state)
        return held.solved(held.case(point), loads, state)

    every = zip(points, states, loads, strict=True)
    return [outcome_of(solved, *of_point).result for of_point in every]


def _at_thrust(batch: _Batch, points: Sequence[OperatingPoint]) -> list[Solved | Exception]:
    held, radius = batch.held, float(batch.held.rotor.radius)
    bounds = [rotation_bounds(radius, float(point.speed)) for point in points]
    searches = [
        _Search(point.at(0.0), float(point.thrust or 0.0), within)
        for point, within in zip(points, bounds, strict=True)
    ]
    case = held.case(points[0])
    every_trim = _trim_all(batch.solver, case, stacked(searches, batch.size))

    def solved(point: OperatingPoint, within: Bounds, trimmed: Trimmed) -> Solved:
        require_bounds(within, float(point.speed))
        case = held.case(point)
        require_reached(trimmed, batch.solver, case, point.thrust or 0.0, within)
        return held.solved(case, trimmed.loads, point.at(float(trimmed.rotation_speed)))

    every = zip(points, bounds, taken_apart(every_trim, len(points)), strict=True)
    return [outcome_of(solved, *of_point).result for of_point in every]


class _Search(NamedTuple):
    """What the search for a rotation speed is about at a point."""

    state: RotorState
    thrust: float
    bounds: Bounds


@partial(compiled, static_argnames="solver")
def _solve_all(solver: Solver, case: RotorCase, states: RotorState) -> RotorLoads:
    """Loads in states that have a leading axis."""
    return at_all(
        lambda case, state: solver.solve(dataclasses.replace(case, state=state)), case, states
    )


@partial(compiled, static_argnames="solver")
def _trim_all(solver: Solver, case: RotorCase, searches: _Search) -> Trimmed:
    """Rotation speeds for thrusts of searches that have a leading axis."""

    def trimmed(case: RotorCase, search: _Search) -> Trimmed:
        moved = dataclasses.replace(case, state=search.state)
        return solve_for_thrust(solver, moved, search.thrust, search.bounds)

    return at_all(trimmed, case, searches)

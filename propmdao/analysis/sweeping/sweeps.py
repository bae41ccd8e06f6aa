"""A propeller at many points: operating conditions and simple changes of the blade."""

from __future__ import annotations

import os
from collections.abc import Callable, Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from functools import partial
from itertools import chain
from typing import Any, TypeVar, Unpack, cast

from tqdm import tqdm

from propmdao.analysis.request import Asked, Request
from propmdao.analysis.sweeping.points import N_POINTS, Point
from propmdao.formats.result_table import STATUS, ResultTable, table_files
from propmdao.propeller.description import Propeller
from propmdao.propeller.identity import checksum
from propmdao.records.plain import to_plain
from propmdao.records.quantities import (
    BROADBAND_LEVELS,
    HUB_LOADS,
    LEVELS,
    RESULTS,
    VARIABLES,
    require_asked,
)
from propmdao.records.units import Range
from propmdao.runtime.locks import locked
from propmdao.runtime.output_files import make_folder, require_writable
from propmdao.runtime.worker_processes import results_in_order, start_workers

Argument = TypeVar("Argument")
Result = TypeVar("Result")

_N_WORKERS = Range(1, 256)
#: Points that are analysed together: as many as their blades and loads fit into memory, and few
#: enough that the lattice's are shared out evenly.
_WINDOW, _WINDOW_OF_WORKERS = 256, 4


_RESULTS = [name for name in ("rpm", *RESULTS) if name != "failure"]
_RESULTS += [column for vector in HUB_LOADS.values() for column in vector.columns]
_WARNINGS = "warnings"


def sweep(
    propeller: Propeller,
    points: Iterable[Point],
    path: str | os.PathLike[str],
    *,
    n_workers: int = 1,
    **asked: Unpack[Asked],
) -> tuple[int, list[str]]:
    """Analyse a propeller at many points into a table.

    Points that the table has are left as they are, so that a sweep that was ended goes on, and one
    that is given more points adds these. A point that cannot be analysed, or does not converge,
    becomes a row that says why. The table is the same with any number of workers.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    points : iterable of dict
        Values of `VARIABLES`, ``rpm`` or ``thrust_required`` [N] in each, the same in all;
        ``chord_factor`` stretches the chord, ``diameter`` [m] the whole blade.
    path : path
        Table to make or go on with, a row per point: its variables with ``propeller``, the checksum
        ``blade`` of its description and all that was asked in front of what `propmdao.analyze`
        gives, levels as ``oaspl_db@1.905m-45deg``, and what it warns of. CSV, or with the ending
        ``.parquet`` a Parquet file that is written at the end beside the CSV file of the same name.
    n_workers : int
        Processes that analyse; 1: only this one.
    **asked
        Single values as `propmdao.analyze` takes them, the same for all points: observers,
        surroundings, viscous, stall_delay, broadband, trip, layers, fidelity, the air.

    Returns
    -------
    n_new : int
        Number of points that the table did not have.
    failures : list of str
        Reason for each of `points` that has failed.

    Raises
    ------
    ValueError
        When the points do not say what turns the propeller, a value of theirs is out of range, or
        the file is of another sweep, cannot be written or is in use by another one.
    WorkerLostError
        When a worker dies; the rows so far are in the table.
    """
    csv_file, parquet_file = table_files(path)
    _N_WORKERS.require("number of workers", n_workers)
    points = list(points)
    N_POINTS.require("number of points", len(points))
    # Whatever is wrong with what all points share is said before the first of them.
    request = Request.of(rpm=0.0, **asked)
    if request.model.loads.elastic is not None:
        raise ValueError("points of a sweep have rigid blades: analyze elastic ones one by one")
    if request.model.loads.unsteady is not None:
        raise ValueError("points of a sweep are not marched in time: analyze them one by one")
    complete = _complete_points(propeller, points, request)
    suffixes = _suffixes(request.listening.observers)
    point_columns, results = _columns(complete, suffixes)
    analysed = partial(_analysed, propeller, asked, suffixes)
    make_folder(csv_file.parent)
    with ExitStack() as stack:
        stack.enter_context(locked(csv_file))
        table = ResultTable(csv_file, point_columns, results)
        if parquet_file is not None:
            require_writable(parquet_file)
        new = [complete[place] for place in table.missing(complete)]
        # Windows of points that share what is known of their blades. Workers have something to do
        # only if the lattice's are small.
        small = n_workers > 1 and not request.model.loads.blade_element
        size = _WINDOW_OF_WORKERS if small else _WINDOW
        windows = [new[first : first + size] for first in range(0, len(new), size)]
        batches: Iterator[Iterable[tuple[dict[str, Any], str]]] = map(analysed, windows)
        if n_workers > 1:
            workers = stack.enter_context(start_workers(n_workers))
            listed = partial(_listed, analysed)
            batches = stack.enter_context(closing(results_in_order(workers, listed, windows)))
        rows = chain.from_iterable(batches)
        for point in tqdm(new, desc="sweep", unit="point", disable=None):
            values, reason = next(rows)
            table.add(point, {name: values[name] for name in results if name in values}, reason)
        if parquet_file is not None:
            table.write_parquet(parquet_file)
    return len(new), table.failures(complete)


def swept_rows(
    propeller: Propeller,
    points: Iterable[Point],
    path: str | os.PathLike[str],
    **asked: Unpack[Asked],
) -> list[dict[str, str]]:
    """Rows that a sweep has left of its points, those that have failed left out.

    Parameters
    ----------
    propeller, points, path, **asked
        The same as of `sweep`. The table may have rows of other points, blades and settings.

    Returns
    -------
    list of dict
        Cells by column.

    Raises
    ------
    ValueError
        If the file is of another sweep.
    """
    request = Request.of(rpm=0.0, **asked)
    complete = _complete_points(propeller, points, request)
    columns = _columns(complete, _suffixes(request.listening.observers))
    table = ResultTable(table_files(path)[0], *columns)
    rows = [table.row(point) for point in complete if point in table]
    return [row for row in rows if row[STATUS] == "ok"]


def _complete_points(
    propeller: Propeller, points: Iterable[Point], request: Request
) -> list[dict[str, Any]]:
    """Points with a value in every column that tells them from others."""
    same = _same_columns(propeller, request)
    complete = [_complete(propeller, point) | same for point in points]
    drives = {"rpm" if "rpm" in point else "thrust_required" for point in complete}
    if len(drives) != 1:
        raise ValueError("a sweep needs in all points rpm or in all thrust_required")
    return complete


def _columns(
    complete: Sequence[Mapping[str, Any]], suffixes: Sequence[str]
) -> tuple[list[str], list[str]]:
    """Columns of points and of their results."""
    point_columns = list(complete[0])
    levels = [*LEVELS, *(BROADBAND_LEVELS if complete[0]["broadband"] else ())]
    results = [name for name in _RESULTS if name not in point_columns]
    results += [name + suffix for suffix in suffixes for name in levels] + [_WARNINGS]
    return point_columns, results


def _same_columns(propeller: Propeller, request: Request) -> dict[str, Any]:
    """Columns of what is asked of all points alike."""
    model = request.model.completed(propeller.transition, propeller.tip, propeller.trip)
    loads, broadband = model.loads, model.noise.broadband
    trip = "none" if broadband is None else broadband.trip
    return {
        "viscous": loads.viscous,
        "stall_delay": loads.stall_delay,
        "broadband": broadband is not None,
        "trip": " ".join(trip) if isinstance(trip, tuple) else trip,
        "surroundings": str(request.listening.surroundings),
        "settings": " ".join(_other_settings(request)) or "default",
    }


def _other_settings(request: Request) -> Iterator[str]:
    """What differs from the defaults and has no column of its own, as name=value."""
    broadband = request.model.noise.broadband is not None
    default = Request.of(rpm=0.0, broadband=broadband)
    own = ("viscous", "stall_delay", "trip", "rho")

    def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
        if isinstance(value, dict):
            for key, item in value.items():
                yield from leaves(item, f"{name}.{key}" if name else key)
        else:
            yield name, value

    for of_request, of_default in (
        (request.model, default.model),
        (request.point.air, default.point.air),
        (request.point.turbulence, default.point.turbulence),
    ):
        known = dict(leaves(to_plain(of_default)))
        for name, value in leaves(to_plain(of_request)):
            if value != known[name] and name.split(".")[-1] not in own:
                yield f"{name}={value}"


def _complete(propeller: Propeller, point: Mapping[str, float]) -> dict[str, Any]:
    """Return the point with a value for every variable but the drive that is not given."""
    for name in point:
        if name not in VARIABLES:
            raise ValueError(
                f"'{name}' is no variable of a sweep; there are {', '.join(VARIABLES)}"
            )
    if ("rpm" in point) == ("thrust_required" in point):
        raise ValueError(f"every point needs either rpm or thrust_required; one has {dict(point)}")
    for name, value in point.items():
        require_asked(VARIABLES[name].name, value)
    blades = point.get("n_blades", propeller.n_blades)
    if blades != int(blades):
        raise ValueError(f"n_blades must be a whole number; it is {blades:g}")
    defaults = {name: quantity.default for name, quantity in VARIABLES.items()}
    defaults["diameter"] = propeller.diameter
    complete = {
        name: float(value) for name, value in {**defaults, **point}.items() if value is not None
    }
    named = {"propeller": propeller.name, "blade": checksum(propeller)}
    return {**named, **complete, "n_blades": int(blades)}


def _analysed(
    propeller: Propeller, asked: Asked, suffixes: Sequence[str], points: Sequence[Mapping[str, Any]]
) -> Iterator[tuple[dict[str, Any], str]]:
    """Results by column at each of some points, or none and the reason, as they come."""
    from propmdao.analysis.sweeping.batches import analyze_each  # slow to import

    outcomes = analyze_each(propeller, [_asked_at(propeller, asked, point) for point in points])
    return (_row(outcome.result, outcome.warnings, suffixes) for outcome in outcomes)


def _listed(function: Callable[[Argument], Iterable[Result]], argument: Argument) -> list[Result]:
    """All results of a function that gives them one by one, for another process."""
    return list(function(argument))


def _asked_at(propeller: Propeller, asked: Asked, point: Mapping[str, Any]) -> Asked:
    """What is asked of all points, and the values of one."""
    of_point = {
        quantity.name: point[column] for column, quantity in VARIABLES.items() if column in point
    }
    # What is not changed is left out, so that the description stays as it is.
    for name, described in (("diameter", propeller.diameter), ("n_blades", propeller.n_blades)):
        if of_point[name] == described:
            del of_point[name]
    return cast(Asked, {**asked, **of_point})


def _row(result: Any, said: Sequence[str], suffixes: Sequence[str]) -> tuple[dict[str, Any], str]:
    """Results by column of an analysis, or none and the reason."""
    if isinstance(result, ValueError):
        return {}, str(result)
    if isinstance(result, Exception):
        return {}, f"{type(result).__name__}: {result}"
    results = result.to_dict()
    levels = {
        name + suffix: observer[name]
        for observer, suffix in zip(results.pop("observers"), suffixes, strict=True)
        for name in (*LEVELS, *BROADBAND_LEVELS)
        if name in observer
    }
    for name, vector in HUB_LOADS.items():
        results |= zip(vector.columns, results.pop(name), strict=True)
    results[_WARNINGS] = "; ".join(said)
    unconverged = "" if results["converged"] else "the solution has not converged"
    return results | levels, results.get("failure") or unconverged


def _suffixes(observers: Any) -> list[str]:
    """What tells the columns of one observer from those of another."""
    from propmdao.acoustics.kinematics.observers import directions  # slow to import

    suffixes = [
        f"@{radius:g}m{elevation:+g}deg" + (f"_az{azimuth:+g}deg" if azimuth else "")
        for radius, elevation, azimuth in zip(*directions(observers).rounded(), strict=True)
    ]
    for number, suffix in enumerate(suffixes):
        if suffix in suffixes[:number]:
            raise ValueError(
                f"observers {suffixes.index(suffix) + 1} and {number + 1} are both at "
                f"{suffix[1:]}; a table has columns for each, so each must be at its own place"
            )
    return suffixes

"""A propeller at many points: operating conditions and simple changes of the blade."""

from __future__ import annotations

import csv
import io
import itertools
import math
import os
import warnings
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from functools import partial
from typing import Any, Unpack

from scipy.stats import qmc
from tqdm import tqdm

from propmdao.analysis.request import Asked, Request
from propmdao.formats.result_table import ResultTable, table_files
from propmdao.propeller.description import Propeller
from propmdao.propeller.identity import checksum
from propmdao.records.models import Model
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
from propmdao.runtime.input_files import read_text
from propmdao.runtime.locks import locked
from propmdao.runtime.output_files import make_folder, require_writable
from propmdao.runtime.worker_processes import results_in_order, start_workers

Point = dict[str, float]
#: Points of a sweep: those of a day, with a table that fits memory.
MOST_POINTS = 100_000
_N_POINTS = Range(1, MOST_POINTS)
_SEED = Range(0, 2**128)
_N_WORKERS = Range(1, 256)


_RESULTS = [name for name in ("rpm", *RESULTS) if name != "failure"]
_RESULTS += [column for vector in HUB_LOADS.values() for column in vector.columns]
_WARNINGS = "warnings"


def grid(values: Mapping[str, Sequence[float]]) -> list[Point]:
    """Every combination of values, the last variable changing first.

    Parameters
    ----------
    values : mapping of str to sequence of float
        Values by variable, keys of `VARIABLES`.

    Returns
    -------
    list of dict
        Points.

    Raises
    ------
    ValueError
        If there are more combinations than `MOST_POINTS`.
    """
    _N_POINTS.require("number of points", math.prod(map(len, values.values())))
    return [dict(zip(values, point, strict=True)) for point in itertools.product(*values.values())]


def latin_hypercube(
    ranges: Mapping[str, tuple[float, float]], n_points: int, seed: int
) -> list[Point]:
    """Points that fill ranges evenly, each variable at as many values as there are points.

    Parameters
    ----------
    ranges : mapping of str to (float, float)
        Lowest and highest value by variable.
    n_points : int
        Number of points.
    seed : int
        Same seed, same points.

    Returns
    -------
    list of dict
        Points.

    Raises
    ------
    ValueError
        If there are more points than `MOST_POINTS`, or the seed is negative.
    """
    _N_POINTS.require("number of points", n_points)
    _SEED.require("seed", seed)
    sample = qmc.LatinHypercube(len(ranges), rng=seed).random(n_points)
    lower, upper = zip(*ranges.values(), strict=True)
    scaled = [
        [low + u * (high - low) for u, low, high in zip(row, lower, upper, strict=True)]
        for row in sample.tolist()
    ]
    return [dict(zip(ranges, row, strict=True)) for row in scaled]


def read_points(path: str | os.PathLike[str]) -> list[Point]:
    """Points of a CSV file whose header names variables.

    Parameters
    ----------
    path : path
        CSV file.

    Returns
    -------
    list of dict
        Points.

    Raises
    ------
    ValueError
        When there is no such file, a column is no variable or comes twice, or a cell is not a
        number.
    """
    complaint = f"points cannot be read from '{path}'"
    text = read_text(path, ValueError, complaint=complaint, encoding="utf-8-sig")
    reader = csv.DictReader(io.StringIO(text))
    names, rows = reader.fieldnames or [""], list(reader)
    for name in names:
        if name not in VARIABLES:
            raise ValueError(
                f"'{path}' has a column '{name}', which is no variable of a sweep; there are"
                f" {', '.join(VARIABLES)}"
            )
        if names.count(name) > 1:
            raise ValueError(f"'{path}', line 1: the column '{name}' is there more than once")
    points = []
    for number, row in enumerate(rows, start=2):
        try:
            points.append({name: float(row[name]) for name in row})
        except (TypeError, ValueError):
            raise ValueError(f"row {number} of '{path}' is not all numbers: {row}") from None
    return points


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
        surroundings, viscous, stall_delay, broadband, trip, fidelity, the air.

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
    _N_POINTS.require("number of points", len(points))
    # Whatever is wrong with what all points share is said before the first of them.
    request = Request.of(rpm=0.0, **asked)
    if request.model.loads.elastic is not None:
        raise ValueError("points of a sweep have rigid blades: analyze elastic ones one by one")
    if request.model.loads.unsteady is not None:
        raise ValueError("points of a sweep are not marched in time: analyze them one by one")
    same = _same_columns(request)
    complete = [_complete(propeller, point) | same for point in points]
    drives = {"rpm" if "rpm" in point else "thrust_required" for point in complete}
    if len(drives) != 1:
        raise ValueError("a sweep needs in all points rpm or in all thrust_required")
    point_columns = list(complete[0])
    suffixes = _suffixes(request.listening.observers)
    levels = [*LEVELS, *(BROADBAND_LEVELS if same["broadband"] else ())]
    results = [name for name in _RESULTS if name not in point_columns]
    results += [name + suffix for suffix in suffixes for name in levels] + [_WARNINGS]
    analysed = partial(_analysed, propeller, asked, suffixes)
    make_folder(csv_file.parent)
    with ExitStack() as stack:
        stack.enter_context(locked(csv_file))
        table = ResultTable(csv_file, point_columns, results)
        if parquet_file is not None:
            require_writable(parquet_file)
        new = [complete[place] for place in table.missing(complete)]
        rows: Iterator[tuple[dict[str, Any], str]] = map(analysed, new)
        if n_workers > 1:
            workers = stack.enter_context(start_workers(n_workers))
            rows = stack.enter_context(closing(results_in_order(workers, analysed, new)))
        for point in tqdm(new, desc="sweep", unit="point", disable=None):
            values, reason = next(rows)
            table.add(point, {name: values[name] for name in results if name in values}, reason)
        if parquet_file is not None:
            table.write_parquet(parquet_file)
    return len(new), table.failures(complete)


def _same_columns(request: Request) -> dict[str, Any]:
    """Columns of what is asked of all points alike."""
    loads, broadband = request.model.loads, request.model.noise.broadband
    return {
        "viscous": loads.viscous,
        "stall_delay": loads.stall_delay,
        "broadband": broadband is not None,
        "trip": "none" if broadband is None else broadband.trip,
        "surroundings": str(request.listening.surroundings),
        "settings": " ".join(_other_settings(request)) or "default",
    }


def _other_settings(request: Request) -> Iterator[str]:
    """What differs from the defaults and has no column of its own, as name=value."""
    default = Request.of(rpm=0.0)
    own = ("viscous", "stall_delay", "trip", "rho")

    def leaves(value: Any, name: str = "") -> Iterator[tuple[str, Any]]:
        if isinstance(value, dict):
            for key, item in value.items():
                yield from leaves(item, f"{name}.{key}" if name else key)
        else:
            yield name, value

    for of_request, of_default in (
        (request.model, Model(noise=request.model.noise)),
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
    propeller: Propeller, asked: Asked, suffixes: Sequence[str], point: Mapping[str, Any]
) -> tuple[dict[str, Any], str]:
    """Results by column at a point, or none and the reason."""
    from propmdao.analysis.single_point import analyze  # slow to import

    of_point = {
        quantity.name: point[column] for column, quantity in VARIABLES.items() if column in point
    }
    # What is not changed is left out, so that the description stays as it is.
    for name, described in (("diameter", propeller.diameter), ("n_blades", propeller.n_blades)):
        if of_point[name] == described:
            del of_point[name]
    try:
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            results = analyze(propeller, **{**asked, **of_point}).to_dict()
    except ValueError as error:
        return {}, str(error)
    except Exception as error:  # a survey of thousands of points does not end at one of them
        return {}, f"{type(error).__name__}: {error}"
    levels = {
        name + suffix: observer[name]
        for observer, suffix in zip(results.pop("observers"), suffixes, strict=True)
        for name in (*LEVELS, *BROADBAND_LEVELS)
        if name in observer
    }
    for name, vector in HUB_LOADS.items():
        results |= zip(vector.columns, results.pop(name), strict=True)
    said = dict.fromkeys(" ".join(str(warning.message).split()) for warning in caught)
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

"""A propeller at many points: operating conditions and simple changes of the blade."""

from __future__ import annotations

import csv
import dataclasses
import io
import itertools
import json
import os
import warnings
import zlib
from collections.abc import Iterable, Iterator, Mapping, Sequence
from contextlib import ExitStack, closing
from functools import partial
from typing import TYPE_CHECKING, Any

from scipy.stats import qmc
from tqdm import tqdm

from propmdao.formats.result_table import ResultTable, table_files
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import read_text
from propmdao.runtime.worker_processes import results_in_order, start_workers

if TYPE_CHECKING:
    from propmdao.acoustics.broadband.boundary_layer import Trip
    from propmdao.records.listening import Surroundings

Point = dict[str, float]
#: What a point may give, with the value where it does not; None is the propeller's own.
VARIABLES: dict[str, float | None] = {
    "rpm": None,
    "thrust_required": None,
    "speed": 0.0,
    "rho": 1.225,
    "twist_offset_deg": 0.0,
    "chord_factor": 1.0,
    "diameter": None,
    "n_blades": None,
}
_RESULTS = "rpm J thrust torque shaft_power CT CQ CP eta converged".split()
_WARNINGS = "warnings"
_LEVELS = "spl_bpf_db oaspl_db oaspl_thickness_db oaspl_loading_db oaspl_dba".split()
_BROADBAND = ("oaspl_broadband_db",)


def grid(values: Mapping[str, Sequence[float]]) -> list[Point]:
    """Every combination of values, the last variable changing first.

    Parameters
    ----------
    values : mapping of str to sequence of float
        Values by variable, of `VARIABLES`.

    Returns
    -------
    list of dict
        Points.
    """
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
    """
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
        When there is no such file, a column is no variable, or a cell is not a number.
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
    observers: Sequence[Sequence[float]] = (),
    viscous: bool = True,
    broadband: bool = False,
    trip: Trip = "none",
    surroundings: Surroundings | None = None,
    n_workers: int = 1,
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
        Table to make or go on with, a row per point, its variables with ``propeller`` and the
        checksum ``blade`` of its description in front of what `propmdao.analyze` gives, levels
        as ``oaspl_db@1.905m-45deg``, and what it warns of. CSV, or with the ending ``.parquet`` a
        Parquet file that is written at the end beside the CSV file of the same name.
    observers, viscous, broadband, trip, surroundings
        As `propmdao.analyze` takes them; they are the same for all points.
    n_workers : int
        Processes that analyse; 1: only this one.

    Returns
    -------
    n_new : int
        Number of points that the table did not have.
    failures : list of str
        Reason for each of `points` that has failed.

    Raises
    ------
    ValueError
        When the points do not say what turns the propeller, or the file is of another sweep.
    WorkerLostError
        When a worker dies; the rows so far are in the table.
    """
    csv_file, parquet_file = table_files(path)
    noise = {"broadband": broadband, "trip": trip, "surroundings": surroundings}
    same = noise | {"viscous": viscous, "surroundings": str(surroundings or "free field")}
    complete = [_complete(propeller, point) | same for point in points]
    drives = {"rpm" if "rpm" in point else "thrust_required" for point in complete}
    if len(drives) != 1:
        raise ValueError("a sweep needs points, and in all of them rpm or in all thrust_required")
    point_columns = list(complete[0])
    heard = [_suffix(*observer) for observer in observers]
    of_noise = [*_LEVELS, *_BROADBAND] if broadband else _LEVELS
    results = [name for name in _RESULTS if name not in point_columns]
    results += [name + suffix for suffix in heard for name in of_noise] + [_WARNINGS]
    table = ResultTable(csv_file, point_columns, results)
    new = [complete[place] for place in table.missing(complete)]
    how = {name: value for name, value in noise.items() if value is not None}
    analysed = partial(_analysed, propeller, how | {"observers": list(observers)})
    with ExitStack() as stack:
        rows: Iterator[tuple[dict[str, Any], str]] = map(analysed, new)
        if n_workers > 1:
            workers = stack.enter_context(start_workers(n_workers))
            rows = stack.enter_context(closing(results_in_order(workers, analysed, new)))
        for point in tqdm(new, desc="sweep", unit="point", disable=None):
            found, reason = next(rows)
            table.add(point, {name: found[name] for name in results if name in found}, reason)
    if parquet_file is not None:
        table.write_parquet(parquet_file)
    return len(new), table.failures(complete)


def _complete(propeller: Propeller, point: Mapping[str, float]) -> dict[str, Any]:
    """Return the point with a value for every variable but the drive that is not given."""
    for name in point:
        if name not in VARIABLES:
            raise ValueError(
                f"'{name}' is no variable of a sweep; there are {', '.join(VARIABLES)}"
            )
    if ("rpm" in point) == ("thrust_required" in point):
        raise ValueError(f"every point needs either rpm or thrust_required; one has {dict(point)}")
    blades = point.get("n_blades", propeller.n_blades)
    if blades != int(blades):
        raise ValueError(f"n_blades must be a whole number; it is {blades:g}")
    defaults = {**VARIABLES, "diameter": propeller.diameter}
    complete = {
        name: float(value) for name, value in {**defaults, **point}.items() if value is not None
    }
    named = {"propeller": propeller.name, "blade": _checksum(propeller)}
    return {**named, **complete, "n_blades": int(blades)}


def _checksum(propeller: Propeller) -> str:
    """Tells descriptions of one name apart, such as a file before and after a change."""
    description = json.dumps(dataclasses.asdict(propeller), default=lambda array: array.tolist())
    return f"{zlib.crc32(description.encode()):08x}"


def _analysed(
    propeller: Propeller, how: Mapping[str, Any], point: Mapping[str, Any]
) -> tuple[dict[str, Any], str]:
    """Results by column at a point, or none and the reason."""
    from propmdao.analysis.single_point import analyze  # slow to import

    try:
        blade = dataclasses.replace(
            propeller,
            diameter=point["diameter"],
            n_blades=point["n_blades"],
            c_over_R=propeller.c_over_R * point["chord_factor"],
        )
        with warnings.catch_warnings(record=True) as caught:
            warnings.simplefilter("always")
            results = analyze(
                blade,
                rpm=point.get("rpm"),
                thrust=point.get("thrust_required"),
                speed=point["speed"],
                density=point["rho"],
                twist_offset_deg=point["twist_offset_deg"],
                viscous=point["viscous"],
                **how,
            ).to_dict()
    except ValueError as error:
        return {}, str(error)
    except Exception as error:  # a survey of thousands of points does not end at one of them
        return {}, f"{type(error).__name__}: {error}"
    suffixes = [_suffix(*observer) for observer in how["observers"]]
    levels = {
        name + suffix: heard[name]
        for heard, suffix in zip(results.pop("observers"), suffixes, strict=True)
        for name in (*_LEVELS, *_BROADBAND)
        if name in heard
    }
    results[_WARNINGS] = "; ".join(" ".join(str(warning.message).split()) for warning in caught)
    unconverged = "" if results["converged"] else "the solution has not converged"
    return results | levels, results.get("failure") or unconverged


def _suffix(radius: float, elevation_deg: float, azimuth_deg: float = 0.0) -> str:
    """What tells the columns of one observer from those of another."""
    azimuth = f"_az{azimuth_deg:+g}deg" if azimuth_deg else ""
    return f"@{radius:g}m{elevation_deg:+g}deg{azimuth}"

"""Points of a sweep: all combinations, samples that fill ranges, or those of a file."""

from __future__ import annotations

import csv
import io
import itertools
import math
import os
from collections.abc import Mapping, Sequence

from scipy.stats import qmc

from propmdao.records.quantities import VARIABLES
from propmdao.records.units import Range
from propmdao.runtime.input_files import read_text

Point = dict[str, float]
#: Points of a sweep: those of a day, with a table that fits memory.
MOST_POINTS = 100_000
N_POINTS = Range(1, MOST_POINTS)
_SEED = Range(0, 2**128)


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
    N_POINTS.require("number of points", math.prod(map(len, values.values())))
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
    N_POINTS.require("number of points", n_points)
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

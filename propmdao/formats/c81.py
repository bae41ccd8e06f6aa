"""C81 tables: lift, drag and moment over angle and Mach number."""

from __future__ import annotations

import os
import re

import numpy as np
from scipy.interpolate import PchipInterpolator

from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import LARGEST_MACH, Polar, table_over_mach
from propmdao.runtime.input_files import finite_number, read_text

#: Width of a number and numbers per line after the first field.
_WIDTH, _PER_LINE = 7, 9
#: Widest step between the Mach numbers of a table: its logarithm of drag follows the file's drag.
_MACH_STEP = 0.05
_COEFFICIENTS = ("lift", "drag", "moment")


def read_c81(path: str | os.PathLike[str]) -> PolarTable:
    """Read a C81 file.

    Parameters
    ----------
    path : path
        Fixed columns: lines of any text, which may be missing, a name of 30 characters and six
        counts of two characters (Mach numbers and angles of lift, drag, moment), then per
        coefficient the Mach numbers and a row per angle [deg], fields of 7 characters, ten a line.

    Returns
    -------
    PolarTable
        The table of one section over the file's Mach numbers, between which coefficients run
        monotonically; it is the same at all Reynolds numbers, which the format does not hold.

    Raises
    ------
    PolarError
        If the file cannot be read, ends early, holds something that is not a number, or Mach
        numbers or angles do not rise; the message begins with the file and names line and column.

    Notes
    -----
    A column is what was found at its Mach number, compressibility included: its lift and moment
    are not corrected once more, and between two columns coefficients go from one to the other.
    Equal columns therefore say that the section does not feel compressibility. A file of one
    column says nothing about other Mach numbers: there lift and moment follow
    `propmdao.aerodynamics.sections.polars.mach` from the column's own. At a tip Mach number of
    0.5 the rule on top of two columns would be a lift up to 17 % too high where sections work,
    and a torque 3 to 5 % too high.
    """
    lines = read_text(path, PolarError, undecodable="replace").splitlines()
    title = next((k for k, line in enumerate(lines) if _counts(line)), None)
    if title is None:
        raise PolarError(
            f"{path}: line 1: columns 31-42 must hold six counts, two characters each, and there "
            "is no such line behind it"
        )
    counts, start, tables = _counts(lines[title]), title + 1, []
    for k, name in enumerate(_COEFFICIENTS):
        n_mach, n_alpha = counts[2 * k : 2 * k + 2]
        per_row = max(-(-n_mach // _PER_LINE), 1)
        stop = start + per_row * (n_alpha + 1)
        if stop > len(lines):
            raise PolarError(
                f"{path}: the {name} table needs {n_alpha} angles up to line {stop}; the file "
                f"ends at line {len(lines)}"
            )
        rows = [
            _fields(path, lines, first, per_row, n_mach, leading=first > start)
            for first in range(start, stop, per_row)
        ]
        mach, table = rows[0], np.array(rows[1:])
        _require_rising(f"{path}: line {start + 1}: Mach numbers of {name}", mach)
        for row, first in enumerate(range(start + per_row, stop, per_row)):
            above = table[max(row - 1, 0) : row + 1, 0]
            _require_rising(f"{path}: line {first + 1}: angles of {name}", above)
        tables.append((mach, table[:, 0], table[:, 1:]))
        start = stop
    try:
        return table_over_mach(_polars(lines[title][:30].strip(), tables))
    except PolarError as error:
        raise PolarError(f"{path}: {error}") from None


def _counts(line: str) -> list[int]:
    """Six counts of a title line, none where it is no title line."""
    counts = re.findall(r"..", line[30:42])
    valid = all(re.fullmatch(r"[ 0][1-9]|[1-9][0-9]", count) for count in counts)
    return [int(count) for count in counts] if len(counts) == 6 and valid else []


def _require_rising(what: str, values: FloatArray) -> None:
    """Refuse angles or Mach numbers out of order, the first of which are named."""
    wrong = np.flatnonzero(np.diff(values) <= 0.0)
    if wrong.size:
        raise PolarError(f"{what} must rise; {values[wrong[0] + 1]:g} follows {values[wrong[0]]:g}")


def _polars(name: str, tables: list[tuple[FloatArray, FloatArray, FloatArray]]) -> list[Polar]:
    """Polars at the Mach numbers of lift, drag and moment, each held at the ends of its own."""
    nodes = np.unique(np.concatenate([mach for mach, _, _ in tables]))
    if nodes[0] < 0.0 or nodes[-1] > LARGEST_MACH:
        worst = nodes[0] if nodes[0] < 0.0 else nodes[-1]
        raise PolarError(f"Mach numbers must be within 0..{LARGEST_MACH:g}; there is {worst:g}")
    between = [
        np.linspace(low, high, int(np.ceil((high - low) / _MACH_STEP - 1e-9)) + 1)
        for low, high in zip(nodes, nodes[1:], strict=False)
    ]
    machs = np.unique(np.concatenate([nodes, *between]))
    low = max(angle[0] for _, angle, _ in tables)
    high = min(angle[-1] for _, angle, _ in tables)
    angles = np.unique(np.concatenate([angle for _, angle, _ in tables]))
    angles = angles[(angles >= low) & (angles <= high)]
    curves = []
    for own, angle, values in tables:
        if own.size > 1:
            inside = np.clip(machs, own[0], own[-1])
            values = PchipInterpolator(own, values, axis=1)(inside)
        else:
            values = np.repeat(values, machs.size, axis=1)
        curves.append([np.interp(angles, angle, column) for column in values.T])
    return [
        Polar(name, None, float(mach), np.radians(angles), *coefficients)
        for mach, *coefficients in zip(machs, *curves, strict=True)
    ]


def _fields(
    path: str | os.PathLike[str],
    lines: list[str],
    first: int,
    per_row: int,
    count: int,
    leading: bool,
) -> FloatArray:
    """Numbers of one row of a C81 file, which may go on over several lines."""
    values = []
    for number in range(first, first + per_row):
        line, n_fields = lines[number], min(count - _PER_LINE * (number - first), _PER_LINE)
        for field in range(0 if leading and number == first else 1, n_fields + 1):
            text = line[_WIDTH * field : _WIDTH * (field + 1)]
            where = (
                f"{path}: line {number + 1}, columns {_WIDTH * field + 1}-{_WIDTH * (field + 1)}"
            )
            values.append(finite_number(text.strip(), PolarError, where))
    return np.array(values)

"""Polars from files: XFOIL and XFLR5 text polars, C81 tables."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import Polar, table_from_polars
from propmdao.formats.endings import POLAR_READERS
from propmdao.runtime.input_files import read_text

_COLUMNS = ("alpha", "cl", "cd", "cm")
_NUMBER = r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)"
#: Width of a number and numbers per line after the first field of a C81 file.
_WIDTH, _PER_LINE = 7, 9


def load_polars(*paths: str | os.PathLike[str]) -> PolarTable:
    """Read the polars of one section from files of any format that is read.

    Parameters
    ----------
    *paths : path
        Files, whose endings choose among `propmdao.formats.endings.POLAR_READERS`.

    Returns
    -------
    PolarTable
        The table of one section.

    Raises
    ------
    PolarError
        If a file cannot be read or is wrong, a Reynolds number comes twice, or one of several files
        is of a format that holds a whole section.
    """
    readers = [POLAR_READERS.get(Path(path).suffix.lower(), POLAR_READERS[""]) for path in paths]
    for path, reader in zip(paths, readers, strict=True):
        if len(paths) > 1 and not reader.several:
            others = ", ".join(str(other) for other in paths if other is not path)
            raise PolarError(f"{path}: a {reader.contents} stands alone; there is also {others}")
    table: PolarTable = readers[0](*paths) if paths else table_from_polars([])
    return table


def read_polar(path: str | os.PathLike[str]) -> Polar:
    """Read a polar as XFOIL's PACC and XFLR5 write it.

    Parameters
    ----------
    path : path
        Text file: a header with ``Mach``, ``Re = 0.100 e 6`` and ``Ncrit``, a line that names the
        columns, rows with alpha in degrees.

    Returns
    -------
    Polar
        The polar, sorted by angle.

    Raises
    ------
    PolarError
        If the file cannot be read, lacks Re or a column, holds something that is not a number, or
        its values cannot be right; the message begins with the file and names line and column.
    """
    lines = _lines(path)
    starts = (k for k, line in enumerate(lines) if "alpha" in line.lower().split())
    start = next(starts, None)
    if start is None:
        raise PolarError(f"{path}: no line names the columns alpha, CL, CD, CM")
    header = "\n".join(lines[:start])
    reynolds = re.search(rf"\bRe\s*=\s*{_NUMBER}(?:\s+e\s+(\d+))?", header)
    if reynolds is None:
        raise PolarError(f"{path}: the header has no 'Re = ...'")
    names = lines[start].lower().split()
    missing = [name for name in _COLUMNS if name not in names]
    if missing:
        raise PolarError(
            f"{path}: line {start + 1}: missing column '{missing[0]}'; found: {' '.join(names)}"
        )
    columns = [names.index(name) for name in _COLUMNS]
    rows = []
    for number, line in enumerate(lines[start + 1 :], start + 2):
        words = line.split()
        if not words or set(line) <= set("- \t"):
            continue
        if len(words) <= max(columns):
            raise PolarError(f"{path}: line {number}: {len(words)} values, too few for its columns")
        where = f"{path}: line {number}, column"
        rows.append([_number(words[k], f"{where} '{names[k]}'") for k in columns])
    table = np.array(sorted(rows)).reshape(-1, len(columns)).T
    name = re.search(r"Calculated polar for:\s*(.*)", header)
    mach, n_crit = (re.search(rf"\b{key}\s*=\s*{_NUMBER}", header) for key in ("Mach", "Ncrit"))
    reynolds_number = _number(reynolds[1], f"{path}: Re") * 10.0 ** int(reynolds[2] or 0)
    mach_number = _number(mach[1], f"{path}: Mach") if mach else 0.0
    amplification = _number(n_crit[1], f"{path}: Ncrit") if n_crit else None
    try:
        return Polar(
            name=name[1].strip() if name else Path(path).stem,
            alpha=np.radians(table[0]),
            cl=table[1],
            cd=table[2],
            cm=table[3],
            re=reynolds_number,
            mach=mach_number,
            n_crit=amplification,
        )
    except PolarError as error:
        raise (
            error if str(error).startswith(str(path)) else PolarError(f"{path}: {error}")
        ) from None


def read_polars(*paths: str | os.PathLike[str]) -> PolarTable:
    """Read the polars of one section at several Reynolds numbers into a table.

    Parameters
    ----------
    *paths : path
        Files that `read_polar` can read.

    Returns
    -------
    PolarTable
        The table of one section.

    Raises
    ------
    PolarError
        If a file is wrong, as `read_polar` finds, or if a Reynolds number comes twice.
    """
    return table_from_polars([read_polar(path) for path in paths])


def read_c81(path: str | os.PathLike[str]) -> PolarTable:
    """Read a C81 file: lift, drag and moment over angle and Mach number.

    Parameters
    ----------
    path : path
        Fixed columns: a name of 30 characters and six counts of two characters (Mach numbers and
        angles of lift, drag, moment), then per coefficient the Mach numbers and a row per angle
        [deg], fields of 7 characters, ten a line.

    Returns
    -------
    PolarTable
        The table of one section at the file's lowest Mach number, which `section_coefficients`
        corrects, and the same at all Reynolds numbers, which the format does not hold.

    Raises
    ------
    PolarError
        If the file cannot be read, ends early or holds something that is not a number; the message
        begins with the file and names line and column.
    """
    lines = _lines(path)
    counts = re.findall(r"..", lines[0][30:42]) if lines else []
    if len(counts) != 6 or not all(re.fullmatch(r" ?0?[1-9]|[1-9]\d", count) for count in counts):
        raise PolarError(f"{path}: line 1: columns 31-42 must hold six counts, two characters each")
    start, tables = 1, []
    for k, name in enumerate(("lift", "drag", "moment")):
        n_mach, n_alpha = int(counts[2 * k]), int(counts[2 * k + 1])
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
        tables.append((rows[0][0], np.array([[row[0], row[1]] for row in rows[1:]])))
        start = stop
    low = max(table[0, 0] for _, table in tables)
    high = min(table[-1, 0] for _, table in tables)
    angles = np.unique(np.concatenate([table[:, 0] for _, table in tables]))
    angles = angles[(angles >= low) & (angles <= high)]
    cl, cd, cm = (np.interp(angles, table[:, 0], table[:, 1]) for _, table in tables)
    name, mach = lines[0][:30].strip(), float(tables[0][0])
    try:
        # The format has no Reynolds number; that of a single polar only has to be possible.
        return table_from_polars([Polar(name, 1e6, mach, np.radians(angles), cl, cd, cm)])
    except PolarError as error:
        raise PolarError(f"{path}: {error}") from None


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
            values.append(_number(text.strip(), where))
    return np.array(values)


def _lines(path: str | os.PathLike[str]) -> list[str]:
    """Lines of a text file, whose names of sections may be in any encoding."""
    return read_text(path, PolarError, undecodable="replace").splitlines()


def _number(text: str, where: str) -> float:
    """One number of a file."""
    try:
        value = float(text)
    except ValueError:
        raise PolarError(f"{where}: '{text}' is no number") from None
    if not np.isfinite(value):
        raise PolarError(f"{where}: '{text}' is not finite")
    return value

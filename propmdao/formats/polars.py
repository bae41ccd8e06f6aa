"""Polars from files: the text polars of XFOIL and XFLR5, and what a format's ending says."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import Polar, table_from_polars
from propmdao.formats.endings import POLAR_READERS
from propmdao.runtime.input_files import read_text

_COLUMNS = ("alpha", "cl", "cd", "cm")
_NUMBER = r"([-+]?[\d.]+(?:[eE][-+]?\d+)?)"


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

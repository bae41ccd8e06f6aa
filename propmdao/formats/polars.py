"""Polars from files: the text polars of XFOIL and XFLR5, and what a format's ending says."""

from __future__ import annotations

import os
import re
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import FloatArray
from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import Polar, table_from_polars
from propmdao.formats.endings import POLAR_READERS
from propmdao.runtime.input_files import clipped, finite_number, is_number, read_text

_COLUMNS = ("alpha", "cl", "cd", "cm")
_REYNOLDS = re.compile(r"\bRe\s*=\s*([^\s,;]+)(?:\s*e\s*([-+]?\d+))?|^Reynolds number,(.+)")
_MACH = re.compile(r"\bMach\s*=\s*([^\s,;]+)|^Mach,(.+)")
_N_CRIT = re.compile(r"\bNcrit\s*=\s*([^\s,;]+)|^Ncrit,(.+)")
_NAME = re.compile(r"Calculated polar for:(.*)|^Airfoil,(.*)")
#: Laws of Reynolds and Mach number as XFOIL names them: "2 2 Reynolds number ~ 1/sqrt(CL) ...".
_TYPE = re.compile(r"^\s*([1-4])\s+([1-3])\s+Reynolds")
_WITH_LIFT = re.compile(r"(Reynolds|Mach) *number *~ *\S+")
#: Lift and moment of a symmetric section at no angle of attack are below this.
_NO_LIFT = 1e-3


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
    """Read a polar as XFOIL's PACC, XFLR5 and Airfoil Tools write it.

    Parameters
    ----------
    path : path
        Text file: a header with ``Mach``, ``Re = 0.100 e 6`` and ``Ncrit``, a line that names the
        columns, rows with alpha in degrees; or the same separated by commas or semicolons.

    Returns
    -------
    Polar
        The polar, sorted by angle. One that begins at no angle of attack, with neither lift nor
        moment there, is that of a symmetric section and goes on below.

    Raises
    ------
    PolarError
        If the file cannot be read, lacks Re or a column, holds something that is not a number, its
        Reynolds number varies from row to row (types 2 to 4), or its values cannot be right; the
        message begins with the file and names line and column.
    """
    lines = read_text(path, PolarError, undecodable="replace").splitlines()
    start = next((k for k, line in enumerate(lines) if {"alpha", "cl"} <= set(_words(line))), None)
    if start is None:
        raise PolarError(f"{path}: no line names the columns alpha, CL, CD, CM")
    header = lines[:start]
    _require_fixed(path, header)
    reynolds = _header_number(path, header, _REYNOLDS)
    if reynolds is None:
        raise PolarError(f"{path}: the header has no 'Re = ...'")
    alpha, cl, cd, cm = _columns(path, lines, start)
    if alpha.size and alpha[0] == 0.0 and max(abs(cl[0]), abs(cm[0])) < _NO_LIFT:
        alpha = np.concatenate([-alpha[:0:-1], alpha])
        cl, cm = (np.concatenate([-values[:0:-1], values]) for values in (cl, cm))
        cd = np.concatenate([cd[:0:-1], cd])
    names = [match[1] or match[2] or "" for line in header if (match := _NAME.search(line))]
    try:
        return Polar(
            name=names[0].strip() if names else Path(path).stem,
            alpha=np.radians(alpha),
            cl=cl,
            cd=cd,
            cm=cm,
            re=reynolds,
            mach=_header_number(path, header, _MACH) or 0.0,
            n_crit=_header_number(path, header, _N_CRIT),
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


def _words(line: str, separator: str | None = None) -> list[str]:
    """Words of a line in small letters, by its own separator where there is none."""
    if separator is None:
        separator = next((sign for sign in ";," if sign in line), " ")
    parts = line.split() if separator == " " else line.split(separator)
    return [part.strip().lower() for part in parts]


def _require_fixed(path: str | os.PathLike[str], header: list[str]) -> None:
    """Refuse a polar each row of which has its own Reynolds or Mach number."""
    for number, line in enumerate(header, start=1):
        kind, law = _TYPE.match(line), _WITH_LIFT.search(line)
        if kind and kind[1] == "4":
            raise PolarError(
                f"{path}: line {number}: a polar of type 4, one angle at many Reynolds numbers; "
                "polars of type 1 are read, at one Reynolds number each"
            )
        if law or (kind and (kind[1] != "1" or kind[2] != "1")):
            what = law[0] if law else line.strip()
            raise PolarError(
                f"{path}: line {number}: '{clipped(what)}': Reynolds or Mach number varies with "
                "lift (type 2 or 3); polars of type 1 are read, at one Reynolds number each"
            )


def _header_number(
    path: str | os.PathLike[str], header: list[str], pattern: re.Pattern[str]
) -> float | None:
    """First number of a kind in the header, None where there is none."""
    for number, line in enumerate(header, start=1):
        match = pattern.search(line)
        if match is not None:
            name, parts = match[0].split("=")[0].split(",")[0].strip(), match.groups("")
            text = f"{parts[0]}e{parts[1]}" if len(parts) == 3 and parts[1] else parts[0]
            return finite_number(text or parts[-1], PolarError, f"{path}: line {number}: {name}")
    return None


def _columns(path: str | os.PathLike[str], lines: list[str], start: int) -> FloatArray:
    """Values of alpha, cl, cd, cm, a row each, sorted by angle; `start` is the line of names."""
    separator = next((sign for sign in ";," if sign in lines[start]), " ")
    words = _words(lines[start], separator)
    # A first row may follow the names in their line.
    n_names = next((k for k, word in enumerate(words) if is_number(word)), len(words))
    names = words[:n_names]
    where = f"{path}: line {start + 1}"
    for name in _COLUMNS:
        if names.count(name) != 1:
            raise PolarError(
                f"{where}: {'missing' if name not in names else 'more than one'} column '{name}'; "
                f"found: {clipped(' '.join(names))}"
            )
    columns = [names.index(name) for name in _COLUMNS]
    numbered = [(start + 1, words[n_names:])]
    numbered += [
        (k, _words(line, separator)) for k, line in enumerate(lines[start + 1 :], start + 2)
    ]
    if separator == " ":  # lines of dashes separate names and rows
        numbered = [(k, [word for word in row if set(word) - {"-"}]) for k, row in numbered]
    numbered = [(k, row) for k, row in numbered if any(row)]
    usual = int(np.median([len(row) for _, row in numbered])) if numbered else 0
    rows = []
    for number, row in numbered:
        few = len(row) <= max(columns)
        if few or len(row) >= 2 * max(usual, len(_COLUMNS)):
            raise PolarError(
                f"{path}: line {number}: {len(row)} values, too {'few' if few else 'many'} for its "
                "columns"
            )
        where = f"{path}: line {number}, column"
        texts = [row[k].replace(",", ".") if separator == ";" else row[k] for k in columns]
        rows.append(
            [
                finite_number(text, PolarError, f"{where} '{name}'")
                for text, name in zip(texts, _COLUMNS, strict=True)
            ]
        )
    table: FloatArray = np.array(sorted(rows)).reshape(-1, len(columns)).T
    return table

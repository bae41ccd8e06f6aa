"""Columns of a table of numbers: what their heads say, and their values in SI units."""

from __future__ import annotations

import csv
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from propmdao.propeller.checks import PropellerError
from propmdao.runtime.input_files import clipped, finite_number, read_text

FloatArray = npt.NDArray[np.float64]

#: Units by what heads call them; an angle's is in degrees.
_LENGTHS = {
    "m": 1.0, "meter": 1.0, "meters": 1.0, "metre": 1.0, "metres": 1.0, "cm": 0.01, "mm": 0.001,
    "in": 0.0254, "inch": 0.0254, "inches": 0.0254, '"': 0.0254, "ft": 0.3048,
}  # fmt: skip
_ANGLES = {"deg": 1.0, "degree": 1.0, "degrees": 1.0, "°": 1.0, "rad": 180.0 / np.pi}
_ANGLES["radians"] = _ANGLES["radian"] = _ANGLES["rad"]
#: Quantities by what heads call them; "r" has many names, and "pitch" is an angle or a length.
NAMES = {
    "r/R": "r/R r_over_R radius/R radius_over_R",
    "c/R": "c/R c_over_R chord/R chord_over_R",
    "c/D": "c/D c_over_D chord/D chord_over_D",
    "sweep/R": "sweep_over_R",
    "rake/R": "rake_over_R",
    "radius": "r radius station radial_position",
    "chord": "c chord chord_length",
    "angle": "beta twist theta blade_angle pitch_angle twist_angle",
    "angle of parting line": "beta_LE_TE twist_LE_TE",
    "pitch": "pitch geometric_pitch",
    "t/c": "t/c t_over_c thickness_over_chord thickness/chord thickness_ratio",
    "f/c": "f/c f_over_c camber_over_chord camber/chord camber_ratio",
    "airfoil": "airfoil airfoils section profile",
    "blades": "blades n_blades number_of_blades",
}
_QUANTITY = {name.lower(): key for key, names in NAMES.items() for name in names.split()}
_BRACKETS = re.compile(r"[(\[]([^)\]]*)[)\]]")
_DECIMAL_COMMA = re.compile(r"(?<=\d),(?=\d)")


@dataclass(frozen=True, eq=False)
class Column:
    """A column of a table.

    Attributes
    ----------
    head : str
        Head as the table has it.
    quantity : str
        Quantity by its key in `NAMES`; empty where the head names none.
    length, angle : float or None
        Unit [m] or [deg], where the head says one of that kind.
    cells : list of str
        Words below the head.
    where : list of str
        File and line of each.
    """

    head: str
    quantity: str
    length: float | None
    angle: float | None
    cells: list[str]
    where: list[str]

    def numbers(self) -> FloatArray:
        """Numbers of the column as they stand in the file."""
        pairs = zip(self.cells, self.where, strict=True)
        column = f"column '{clipped(self.head)}'"
        return np.array([finite_number(c, PropellerError, f"{w}, {column}") for c, w in pairs])


def read_columns(path: Path) -> list[Column]:
    """Read a table with a line of heads.

    Parameters
    ----------
    path : Path
        Text file: a line of heads, then rows; separated by semicolons, tabs or commas, whichever
        the heads are. Empty lines and lines that begin with # are skipped. Between semicolons and
        tabs a comma is a decimal point.

    Returns
    -------
    list of Column
        The columns.

    Raises
    ------
    PropellerError
        If the file cannot be read, has no heads or no rows, a row of another length, or two columns
        of one head.
    """
    text = read_text(path, PropellerError)
    lines = [
        (f"{path}, line {number}", line)
        for number, line in enumerate(text.splitlines(), start=1)
        if line.strip() and not line.lstrip().startswith("#")
    ]
    if len(lines) < 2:
        raise PropellerError(f"{path}: a line of heads and rows of numbers expected")
    separator = next((mark for mark in ";\t" if mark in lines[0][1]), ",")
    rows = [_cells(line, separator) for _, line in lines]
    heads, rows = rows[0], rows[1:]
    where = [place for place, _ in lines[1:]]
    for place, row in zip(where, rows, strict=True):
        if len(row) != len(heads):
            raise PropellerError(f"{place}: {len(heads)} columns expected; the row has {len(row)}")
    if len(set(heads)) != len(heads):
        raise PropellerError(f"{lines[0][0]}: two columns have the same head")
    if all(re.fullmatch(r"[-+.\deE]+", head) for head in heads):
        raise PropellerError(
            f"{lines[0][0]}: a line of heads expected, not '{clipped(lines[0][1])}'"
        )
    return [
        Column(head, *_meaning(head), [row[k] for row in rows], where)
        for k, head in enumerate(heads)
    ]


def _cells(line: str, separator: str) -> list[str]:
    """Words of a line."""
    if separator != ",":
        line = _DECIMAL_COMMA.sub(".", line)
    (row,) = csv.reader([line], delimiter=separator, skipinitialspace=True)
    return [cell.strip() for cell in row]


def _meaning(head: str) -> tuple[str, float | None, float | None]:
    """Quantity of a head, empty where it names none; its unit as a length, as an angle."""
    bracketed = _BRACKETS.search(head)
    name = "_".join(_BRACKETS.sub("", head).replace("-", "_").split()).lower()
    unit = bracketed[1].strip().lower() if bracketed else ""
    if name not in _QUANTITY and not unit:
        words = name.split("_")
        unit = next((word for word in words[1:] if word in _LENGTHS or word in _ANGLES), "")
        name = "_".join(word for word in words if word != unit)
    return _QUANTITY.get(name, ""), _LENGTHS.get(unit), _ANGLES.get(unit)

"""Polar files of QBlade, in and out: one section at all angles and several Reynolds numbers.

Heads and keywords, each behind its value; a line of Reynolds numbers; a line of heads that begins
with AOA; rows of the angle and, for each Reynolds number, cl, cd, cm, and three more where the
polar is decomposed for dynamic stall (QBlade documentation 2.0, Polar Extrapolation).
"""

from __future__ import annotations

import dataclasses
import os
import re
from pathlib import Path

import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.sections.polars.table import PolarError, PolarTable
from propmdao.aerodynamics.sections.polars.user_table import Polar, table_from_polars
from propmdao.runtime.input_files import clipped, fields_of, finite_number, is_number, read_text

FloatArray = npt.NDArray[np.float64]

_TITLE = "QBlade Multi RE Polar File"
#: Columns of a Reynolds number: cl, cd, cm, and with those of dynamic stall.
_COLUMNS, _DECOMPOSED = 3, 6
#: Angles of attack among which lift goes through zero [rad].
_SEARCHED = np.radians(20.0)


@dataclasses.dataclass(frozen=True, eq=False)
class QBladePolar:
    """A polar file.

    Attributes
    ----------
    name, airfoil : str
        Name of the polar, and name or file of the section.
    thickness : float
        Maximum thickness over chord.
    reynolds : (n_re,) array
        Reynolds numbers.
    alpha : (n_alpha,) array
        Angles of attack [rad].
    values : (n_re, 3, n_alpha) array
        Coefficients of lift, drag and moment about the quarter chord.
    """

    name: str
    airfoil: str
    thickness: float
    reynolds: FloatArray
    alpha: FloatArray
    values: FloatArray

    def upside_down(self) -> QBladePolar:
        """Turn the section over: lift and moment change sign, and so does the angle."""
        values = self.values[..., ::-1] * np.array([-1.0, 1.0, -1.0])[:, None]
        return dataclasses.replace(self, alpha=-self.alpha[::-1], values=values)

    def zero_lift_angle(self) -> float:
        """Angle of attack without lift at the middle one of the Reynolds numbers [rad]."""
        lift, alpha = self.values[len(self.reynolds) // 2, 0], self.alpha
        near = np.flatnonzero((lift[:-1] <= 0.0) & (lift[1:] > 0.0))
        near = near[np.abs(alpha[near]) < _SEARCHED]
        if not near.size:
            raise PolarError(
                "lift does not rise through 0 within -20 ... 20 deg, so there is no zero-lift angle"
            )
        k = near[np.argmin(np.abs(alpha[near]))]
        return float(alpha[k] - lift[k] * (alpha[k + 1] - alpha[k]) / (lift[k + 1] - lift[k]))

    def text(self) -> str:
        """Contents of the file."""
        heads = ["AOA", *["CL", "CD", "CM"] * len(self.reynolds)]
        rows = np.stack([np.degrees(self.alpha), *self.values.reshape(-1, self.alpha.size)], axis=1)
        lines = [
            section_line(_TITLE),
            "Generated with : propmdao",
            "",
            section_line("Object Names"),
            keyword_line(self.name, "POLARNAME", "the polar name"),
            keyword_line(self.airfoil, "FOILNAME", "the airfoil to which the polars belong"),
            "",
            section_line("Parameters"),
            keyword_line(f"{100.0 * self.thickness:.4f}", "THICKNESS", "of the airfoil, % chord"),
            keyword_line("0", "ISDECOMPOSED", "is the polar decomposed"),
            _row(["REYNOLDS", *[f"{re:.4E}" for re in self.reynolds]])
            + "- the list of Reynolds numbers",
            "",
            section_line("Polar Data"),
            _row(heads),
            *[_row([f"{value + 0.0:.6f}" for value in row]) for row in rows],
        ]
        return "\n".join(lines) + "\n"


def read_qblade_polar(path: str | os.PathLike[str]) -> QBladePolar:
    """Read a polar file of QBlade.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    QBladePolar
        Contents of the file.

    Raises
    ------
    PolarError
        If the file cannot be read or is no polar file of QBlade, an entry is missing, or a row does
        not hold the numbers that it should; the message begins with the file.
    """
    lines = read_text(path, PolarError, undecodable="replace").splitlines()
    if not any(_TITLE in line for line in lines[:1]):
        raise PolarError(f"{path}: no polar file of QBlade: its first line has '{_TITLE}'")
    start = next((k for k, line in enumerate(lines) if line.split()[:1] == ["AOA"]), len(lines))
    header = "\n".join(lines[:start])
    listed = re.search(r"^\s*REYNOLDS\S*\s+(.*)", header, re.M)
    words = listed[1].split() if listed else []
    n_re = next((k for k, word in enumerate(words) if not is_number(word)), len(words))
    if n_re == 0:
        raise PolarError(f"{path}: entry 'REYNOLDS ...' is missing")
    where = f"{path}: REYNOLDS"
    reynolds = np.array([finite_number(word, PolarError, where) for word in words[:n_re]])
    decomposed = value_of(header, "ISDECOMPOSED") in ("1", "true")
    per_re = _DECOMPOSED if decomposed else _COLUMNS
    rows = []
    for number, line in enumerate(lines[start + 1 :], start=start + 2):
        if not line.strip():
            continue
        fields, where = fields_of(line), f"{path}, line {number}"
        if fields is None or len(fields) != 1 + per_re * n_re:
            raise PolarError(
                f"{where}: {1 + per_re * n_re} numbers of a row expected, not '{clipped(line)}'"
            )
        rows.append([finite_number(field, PolarError, where) for field in fields])
    if len(rows) < 2:
        raise PolarError(f"{path}: a line of heads AOA ... and two rows of numbers expected")
    table = np.transpose(sorted(rows))
    thickness = value_of(header, "THICKNESS")
    if thickness is None:
        raise PolarError(f"{path}: entry '... THICKNESS' is missing")
    return QBladePolar(
        name=value_of(header, "POLARNAME") or Path(path).stem,
        airfoil=value_of(header, "FOILNAME") or "",
        thickness=0.01 * finite_number(thickness, PolarError, f"{path}: THICKNESS"),
        reynolds=reynolds,
        alpha=np.radians(table[0]),
        values=table[1:].reshape(n_re, per_re, -1)[:, :_COLUMNS],
    )


def read_plr(path: str | os.PathLike[str]) -> PolarTable:
    """Read a polar file of QBlade as the polars of a section.

    Parameters
    ----------
    path : path
        The file, whose section is the right way up.

    Returns
    -------
    PolarTable
        The table of one section.

    Raises
    ------
    PolarError
        If the file is wrong, as `read_qblade_polar` finds, a value cannot be right, or a Reynolds
        number comes twice; the message begins with the file.
    """
    polar = read_qblade_polar(path)
    try:
        return table_from_polars(
            [
                Polar(polar.name, float(re), 0.0, polar.alpha, *values)
                for re, values in zip(polar.reynolds, polar.values, strict=True)
            ]
        )
    except PolarError as error:
        raise PolarError(f"{path}: {error}") from None


def value_of(text: str, keyword: str) -> str | None:
    """Take the value of a keyword out of a file of QBlade.

    Parameters
    ----------
    text : str
        Lines ``value KEYWORD - meaning``.
    keyword : str
        The keyword.

    Returns
    -------
    str or None
        The value; None where the keyword is missing.
    """
    entry = re.search(rf"^\s*(\S.*?)\s+{keyword}(?=\s|$)", text, re.M)
    return entry[1] if entry else None


def section_line(name: str) -> str:
    """Line with the name of a part of a file, as QBlade writes it."""
    return ("-" * 40 + name).ljust(116, "-")


def keyword_line(value: str, keyword: str, meaning: str) -> str:
    """Line with a value, its keyword and what it means."""
    return f"{value:<40} {keyword:<19}- {meaning}"


def _row(words: list[str]) -> str:
    """Line of a table: columns of twenty characters."""
    return "".join(f"{word:<19} " for word in words)

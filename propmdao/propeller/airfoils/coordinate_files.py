"""Files of airfoil coordinates."""

from __future__ import annotations

import re
from pathlib import Path

import numpy as np

from propmdao.propeller.airfoils.airfoil import Airfoil, AirfoilError, FloatArray
from propmdao.propeller.airfoils.contours import LARGEST
from propmdao.propeller.airfoils.coordinates import airfoil_from_coordinates
from propmdao.runtime.input_files import clipped, fields_of, finite_number, read_text

#: Two words that begin like numbers are a damaged point; it is not read over as text.
_LIKE_A_POINT = re.compile(r"\s*[-+.]?\d[^\s,;%]*[\s,;]+[-+]?\.?\d\S*\s*")
#: Pair of numbers between the elements of an airfoil with flaps, as MSES takes them.
_NEXT_ELEMENT = [999.0, 999.0]
_FEWEST_OF_A_SIDE = 5


def read_coordinates(path: Path) -> Airfoil:
    """Read a coordinate file.

    Parameters
    ----------
    path : Path
        Text file: title lines, which may be missing, then x and z over chord or in per cent, then
        text, which may be missing. Selig: trailing edge, upper side, leading edge, lower side.
        Lednicer: the number of points of each side, then each side from the leading edge. Other
        orders are understood where they are certain.

    Returns
    -------
    Airfoil
        The section, named after the file.

    Raises
    ------
    AirfoilError
        If the file cannot be read or holds no airfoil.

    Warns
    -----
    AirfoilFrameWarning
        If the contour was closed at its trailing edge, or turned or scaled onto its chord line.
    """
    label = f"airfoil file '{path}'"
    # Titles may be in any encoding, the numbers are ASCII.
    text = read_text(path, AirfoilError, complaint=f"{label} cannot be read", undecodable="replace")
    points = _without_counts(*_points(text, label))
    return airfoil_from_coordinates(path.stem, points[:, 0], points[:, 1], str(path))


def _points(text: str, label: str) -> tuple[FloatArray, str]:
    """Take the points out of a file, (n, 2), and where the first of them stands."""
    blocks: list[list[list[float]]] = []
    first = between = ""
    inside = False
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        fields, where = fields_of(line), f"{label}, line {number}"
        if fields is not None and len(fields) == 2:
            row = [finite_number(field, AirfoilError, where, LARGEST) for field in fields]
            if row == _NEXT_ELEMENT:
                raise AirfoilError(f"{where}: another element begins; a section has one contour")
            if not inside:
                blocks.append([])
            blocks[-1].append(row)
            first, inside = first or where, True
            continue
        complaint = f"{where}: two numbers x z expected, not '{clipped(line)}'"
        if not _is_text(line, fields, bool(blocks)):
            raise AirfoilError(complaint)
        between = complaint if inside else between
        inside = False
    # A heading may stand between the sides, and each of these has a nose and a tail.
    if len(blocks) > 2 or (len(blocks) == 2 and min(map(len, blocks)) < _FEWEST_OF_A_SIDE):
        raise AirfoilError(f"{between}; points stand before it and behind it")
    return np.array([row for block in blocks for row in block]).reshape(-1, 2), first


def _is_text(line: str, fields: list[str] | None, behind: bool) -> bool:
    """Tell a title, a heading or a note, behind points or ahead of them, from a damaged point."""
    if fields is None:
        return _LIKE_A_POINT.fullmatch(line) is None
    # Ahead of the points there may be their number, or the corners of the grid of MSES.
    return not behind and len(fields) in (1, 4)


def _without_counts(points: FloatArray, first: str) -> FloatArray:
    """Points without the first row, where this counts those of each side (Lednicer)."""
    if len(points) < 2 or points[0].min() < 2.0:
        return points
    counted, there = points[0].sum(), len(points) - 1
    if counted != there and np.abs(points[1:, 0]).max() < 2.0:
        raise AirfoilError(
            f"{first}: {points[0, 0]:g} and {points[0, 1]:g} are no point over chord, and as "
            f"numbers of points of the sides they do not add up to {there}, the points that follow"
        )
    return points[1:] if counted == there else points

"""PE0 files of the maker of the APC propellers as they are: every column, in SI units."""

from __future__ import annotations

import os
import re
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import numpy.typing as npt

from propmdao.propeller.checks import PropellerError
from propmdao.runtime.input_files import clipped, finite_number, read_text

FloatArray = npt.NDArray[np.float64]

_INCH = 0.0254  # m
_PSI = 6894.757293168361  # Pa
_WATER = 1000.0  # kg/m3, to which specific gravity refers
#: Column of the file, as its two lines of heads name it: field, unit in SI.
_COLUMNS = {
    "STATION (IN)": ("radius", _INCH),
    "CHORD (IN)": ("chord", _INCH),
    "PITCH (QUOTED)": ("pitch_quoted", _INCH),
    "PITCH (LE-TE)": ("pitch_le_te", _INCH),
    "PITCH (PRATHER)": ("pitch_prather", _INCH),
    "SWEEP (IN)": ("sweep", _INCH),
    "THICKNESS RATIO": ("thickness_ratio", 1.0),
    "TWIST (DEG)": ("twist_deg", 1.0),
    "MAX-THICK (IN)": ("max_thickness", _INCH),
    "CROSS-SECTION (IN**2)": ("cross_section", _INCH**2),
    "ZHIGH (IN)": ("z_high", _INCH),
    "CGY (IN)": ("cg_y", _INCH),
    "CGZ (IN)": ("cg_z", _INCH),
}
_AIRFOIL = r"^\s*AIRFOIL{}:\s*(\S+?),\s*(\S+)"
#: Largest difference between the last station and the radius that the file states with two digits.
_ROUNDED = 0.0051  # inches
_MOST_BLADES = 99


@dataclass(frozen=True, eq=False)
class Pe0Table:
    """Contents of a PE0 file; a height counts along the shaft, fore and aft in the rotor's plane.

    Attributes
    ----------
    title : str
        Name of the propeller and version of the maker's program.
    n_blades : int
        Number of blades.
    airfoils : tuple of (float, str)
        Radius [m] where the first airfoil ends to be alone, and where the second begins to be,
        with the maker's names.
    radius, chord : (n,) arrays
        Radius of the stations; length between the mould's parting lines [m].
    pitch_quoted, pitch_le_te, pitch_prather : (n,) arrays
        Geometric pitch as it is sold, between the parting lines, and of a gauge that rests against
        the lower side [m].
    sweep : (n,) array
        Distance of the leading parting line ahead of the radial line [m].
    thickness_ratio, max_thickness : (n,) arrays
        Maximum thickness, over chord and [m].
    twist_deg : (n,) array
        Angle of the line between the parting lines from the rotor plane [deg].
    cross_section : (n,) array
        Area of the section [m2]; 0 in the last row of the files, which only closes the tip.
    z_high, cg_y, cg_z : (n,) arrays
        Highest point of the upper side; centre of the area, ahead of the radial line and in height
        [m].
    density, modulus : float or None
        Density [kg/m3] and modulus of elasticity [Pa] of the material, where the file says them.
    """

    title: str
    n_blades: int
    airfoils: tuple[tuple[float, str], tuple[float, str]]
    radius: FloatArray
    chord: FloatArray
    pitch_quoted: FloatArray
    pitch_le_te: FloatArray
    pitch_prather: FloatArray
    sweep: FloatArray
    thickness_ratio: FloatArray
    twist_deg: FloatArray
    max_thickness: FloatArray
    cross_section: FloatArray
    z_high: FloatArray
    cg_y: FloatArray
    cg_z: FloatArray
    density: float | None
    modulus: float | None


def read_pe0_table(path: str | os.PathLike[str]) -> Pe0Table:
    """Read every column of a PE0 file.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    Pe0Table
        Contents of the file.

    Raises
    ------
    PropellerError
        If the file cannot be read, lacks a column, the blades or the airfoils, has a row that is
        not complete, stations that do not rise, or ends before its radius; the message begins with
        the file, and the line where there is one.
    """
    path = Path(path)
    text = read_text(path, PropellerError, undecodable="replace")
    lines = text.splitlines()
    names, first = _heads(path, lines)
    table = _rows(path, lines, names, first)
    stated = _number(path, text, r"^\s*RADIUS:\s*(\S+)", "RADIUS")
    last = table[-1, names.index("STATION (IN)")]
    if abs(last - stated) > _ROUNDED:
        raise PropellerError(
            f"{path}: the last station must be the tip, RADIUS {stated:g} in; it is at {last:g} in"
        )
    blades = _number(path, text, r"^\s*BLADES:\s*(\S+)", "BLADES")
    if not (blades == int(blades) and 1 <= blades <= _MOST_BLADES):
        raise PropellerError(f"{path}: BLADES must be a whole number; it is {blades:g}")
    columns = {
        field: unit * table[:, names.index(column)] for column, (field, unit) in _COLUMNS.items()
    }
    gravity = _stated(path, text, r"DENSITY \(SPECIFIC GRAVITY, INPUT FILE\)\s*=\s*(\S+)")
    modulus = _stated(path, text, r"BASED ON MODULUS \(MILLION\)\s*=\s*(\S+)")
    return Pe0Table(
        title=" ".join(f"{lines[0].split()[0]} {lines[1].strip()}".split()),
        n_blades=int(blades),
        airfoils=(_airfoil(path, text, 1), _airfoil(path, text, 2)),
        **columns,
        density=None if gravity is None else _WATER * gravity,
        modulus=None if modulus is None else 1e6 * _PSI * modulus,
    )


def _heads(path: Path, lines: list[str]) -> tuple[list[str], int]:
    """Names of the columns, of two lines, and the number of the line after them."""
    for number, line in enumerate(lines[:-1]):
        words, units = line.split(), lines[number + 1].split()
        if words[:2] == ["STATION", "CHORD"] and len(words) == len(units):
            names = [" ".join(pair) for pair in zip(words, units, strict=True)]
            missing = [column for column in _COLUMNS if column not in names]
            if missing:
                raise PropellerError(
                    f"{path}, line {number + 1}: column '{missing[0]}' is missing; there are "
                    f"{', '.join(names)}"
                )
            return names, number + 2
    raise PropellerError(
        f"{path}: is no PE0 file: the table's heads, STATION CHORD PITCH ... over (IN) (IN) "
        "(QUOTED) ..., are missing"
    )


def _rows(path: Path, lines: list[str], names: list[str], first: int) -> FloatArray:
    """Rows of the table, which ends at the first empty line after it has begun."""
    rows: list[list[float]] = []
    for number, line in enumerate(lines[first:], start=first + 1):
        words = line.split()
        if not words:
            if rows:
                break
            continue
        where = f"{path}, line {number}"
        if len(words) != len(names):
            raise PropellerError(
                f"{where}: {len(names)} numbers expected, not {len(words)}: '{clipped(line)}'"
            )
        rows.append([finite_number(word, PropellerError, where) for word in words])
    table = np.array(rows).reshape(-1, len(names))
    radius = table[:, names.index("STATION (IN)")]
    if radius.size < 3 or not (radius[0] > 0.0 and np.all(np.diff(radius) > 0.0)):
        raise PropellerError(f"{path}: the table must hold three stations or more that rise from 0")
    return table


def _stated(path: Path, text: str, pattern: str) -> float | None:
    """A positive number of the file's text, None where it is not said."""
    stated = re.search(pattern, text, re.M)
    if stated is None:
        return None
    value = finite_number(stated[1], PropellerError, f"{path}: {clipped(stated[0])}")
    if not value > 0.0:
        raise PropellerError(f"{path}: '{clipped(stated[0])}' must be positive")
    return value


def _number(path: Path, text: str, pattern: str, name: str) -> float:
    """A positive number that the file must hold."""
    value = _stated(path, text, pattern)
    if value is None:
        raise PropellerError(f"{path}: '{name}:' is missing")
    return value


def _airfoil(path: Path, text: str, number: int) -> tuple[float, str]:
    """Radius [m] and name of an end of the airfoils' transition."""
    stated = re.search(_AIRFOIL.format(number), text, re.M)
    if stated is None:
        raise PropellerError(f"{path}: 'AIRFOIL{number}: radius, name' is missing")
    where = f"{path}: AIRFOIL{number}"
    return _INCH * finite_number(stated[1], PropellerError, where), stated[2]

"""Blades as plain tables (CSV) with heads: radius, chord, angle or pitch, thickness, airfoil."""

from __future__ import annotations

import os
import warnings
from pathlib import Path
from typing import Any

import numpy as np

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.blade_tables.columns import Column, FloatArray, read_columns
from propmdao.formats.blade_tables.names import blades_of_name, inches_of_name
from propmdao.formats.blade_tables.rotor_folder import is_rotor_folder, read_rotor_folder
from propmdao.formats.blade_tables.stated_units import to_chord_line
from propmdao.propeller import checks
from propmdao.propeller.airfoils.library import COORDINATE_ENDINGS
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

_INCH = 0.0254  # m
_OF_PARTING_LINE = "angle of parting line"
_ANGLES = {"angle", _OF_PARTING_LINE}
_AIRFOIL, _N_BLADES = "naca4412", 2
#: Largest difference between two columns of one thing, relative: both are rounded.
_ROUNDED = 0.01
#: The maker's and the textbooks' names of airfoils of the catalogue, without blanks and hyphens.
_SAME_NAMES = {"apc12": "naca4412", "clarky": "clarky", "e63": "e63", "eppler63": "e63"}


def read_csv(path: str | os.PathLike[str]) -> Propeller:
    """Read a blade from a table with heads.

    Parameters
    ----------
    path : path
        Table as `propmdao.formats.blade_tables.columns.read_columns` takes it, or the file of a
        rotor whose distributions stand in files of their own, as
        `propmdao.formats.blade_tables.rotor_folder.read_rotor_folder` takes it. A table needs
        radius (``r/R``, or ``radius`` with a unit), chord (``c/R``, ``c/D``, or ``chord`` with a
        unit) and blade angle (``beta`` or ``twist``, or ``pitch`` with a unit of length). It may
        have thickness and camber over chord, an airfoil for each station, and the number of blades.
        Units stand in brackets or after an underscore. An angle named ``twist_LE_TE`` is of the
        line between the ends. Without radii in a unit of length the name of the file says the
        diameter, as ``gwsdd_9x5.csv`` does in inches.

    Returns
    -------
    Propeller
        The propeller, named after the file. An `AssumedBladeWarning` says what was assumed, and
        which columns were not used.

    Raises
    ------
    PropellerError
        If the file cannot be read, a column is missing, or its unit is not certain, two columns
        contradict each other, or a value is out of range; the message begins with the file.
    """
    path = Path(path)
    columns = read_columns(path)
    if is_rotor_folder(columns):
        return read_rotor_folder(path, columns)
    named = {column.quantity: column for column in columns if column.quantity}
    if len(named) < sum(bool(column.quantity) for column in columns):
        raise PropellerError(f"{path}: two columns hold the same quantity; leave one of them")
    try:
        return _propeller(path, columns, named)
    except PropellerError as error:
        message = str(error)
        raise PropellerError(
            message if message.startswith(str(path)) else f"{path}: {message}"
        ) from error


def _propeller(path: Path, columns: list[Column], named: dict[str, Column]) -> Propeller:
    """Put the columns together; what is missing is assumed or refused."""
    radius, r_over_R = _radii(path, named)
    chord = _one_of(named, {"c/R": 1.0, "c/D": 2.0}, "chord", radius)
    angle, used_angle = _blade_angle(named, radius * r_over_R)
    used = {"r/R", "radius", "c/R", "c/D", "chord", used_angle, "airfoil", "blades"}
    optional = {"t/c": "thickness_over_chord", "f/c": "camber_over_chord"}
    optional |= {"sweep/R": "sweep_over_R", "rake/R": "rake_over_R"}
    described: dict[str, Any] = {
        key: named[q].numbers() for q, key in optional.items() if q in named
    }
    n_blades, assumed = _blades(path, named)
    airfoils: list[tuple[float, str]] = [(1.0, _AIRFOIL)]
    if "airfoil" in named:
        airfoils = _airfoils(path, named["airfoil"], r_over_R)
    else:
        assumed.insert(0, "NACA 4412 sections from root to tip" if "t/c" not in named else
                       "NACA 4412 sections of the table's thickness")  # fmt: skip
    propeller = Propeller(
        name=path.stem,
        diameter=2.0 * radius,
        n_blades=n_blades,
        r_over_R=r_over_R,
        c_over_R=chord,
        beta_deg=angle,
        airfoils=airfoils,
        source=f"{path.name}",
        **described,
    )
    if used_angle == _OF_PARTING_LINE:
        propeller = to_chord_line(propeller, "parting_line")
    unused = [c.head for c in columns if c.quantity not in {*used, *optional}]
    notes = [f"assumed, for the table does not say: {' and '.join(assumed)}"] if assumed else []
    notes += [f"not used: {', '.join(unused)}"] if unused else []
    if notes:
        warnings.warn(f"{path}: {'; '.join(notes)}", AssumedBladeWarning, stacklevel=5)
    return propeller


def _radii(path: Path, named: dict[str, Column]) -> tuple[float, FloatArray]:
    """Tip radius [m] and r/R of the stations."""
    column = named.get("radius")
    stations = named["r/R"].numbers() if "r/R" in named else None
    if column is None and stations is None:
        raise PropellerError("a column of radii is missing: 'r/R', or 'radius' with a unit")
    if column is not None and column.length is not None:
        lengths = column.length * column.numbers()
        tip = float(lengths[-1])
        checks.require("radius", "be positive", lengths > 0.0, lengths)
        if stations is not None and not np.allclose(lengths, stations * tip, rtol=_ROUNDED):
            raise PropellerError("columns 'r/R' and 'radius' contradict each other")
        return tip, lengths / tip if stations is None else stations
    if stations is None:
        assert column is not None
        raise PropellerError(
            f"column '{column.head}' needs a unit, as 'radius [mm]' or 'radius_in', or to be 'r/R'"
        )
    inches = inches_of_name(path.stem)
    if inches is None:
        raise PropellerError(
            "the diameter is missing: give a column of radii with a unit, as 'radius [mm]', or "
            "name the file like gwsdd_9x5.csv, in inches"
        )
    return 0.5 * inches * _INCH, stations


def _one_of(
    named: dict[str, Column], relative: dict[str, float], absolute: str, radius: float
) -> FloatArray:
    """A length over the tip radius, from whichever columns there are."""
    forms = {key: unit * named[key].numbers() for key, unit in relative.items() if key in named}
    column = named.get(absolute)
    if column is not None and column.length is not None:
        forms[absolute] = column.length / radius * column.numbers()
    elif column is not None and not forms:
        raise PropellerError(
            f"column '{column.head}' needs a unit, as '{absolute} [mm]' or '{absolute}_in', or to "
            f"be '{next(iter(relative))}'"
        )
    if not forms:
        raise PropellerError(
            f"a column is missing: {', '.join(map(repr, relative))} or '{absolute}' with a unit"
        )
    first, *others = forms.values()
    if not all(np.allclose(first, other, rtol=_ROUNDED) for other in others):
        raise PropellerError(f"columns of {' and '.join(forms)} contradict each other")
    return first


def _blade_angle(named: dict[str, Column], radius: FloatArray) -> tuple[FloatArray, str]:
    """Blade angle [deg], and the quantity that it was taken from."""
    pitch = named.get("pitch")
    if pitch is not None and pitch.length is not None and not named.keys() & _ANGLES:
        advance = pitch.length * pitch.numbers()
        return np.degrees(np.arctan2(advance, 2.0 * np.pi * radius)), "pitch"
    column = named.get("angle", named.get(_OF_PARTING_LINE, pitch))
    if column is None:
        raise PropellerError(
            "a column of the blade angle is missing: 'beta' or 'twist', or 'pitch' with a unit"
        )
    if column is pitch and column.angle is None:
        raise PropellerError(
            f"column '{column.head}' needs a unit: 'pitch [deg]' is an angle, 'pitch [in]' an "
            "advance"
        )
    values = column.numbers()
    if column.angle is None and np.abs(values).max() <= 0.5 * np.pi:
        raise PropellerError(f"column '{column.head}' may be in degrees or radians; say which")
    return values * (column.angle or 1.0), column.quantity


def _blades(path: Path, named: dict[str, Column]) -> tuple[int, list[str]]:
    """Number of blades, and the words for it where it had to be assumed."""
    if "blades" in named:
        numbers = set(named["blades"].numbers())
        if len(numbers) != 1 or not (number := numbers.pop()).is_integer():
            raise PropellerError("the number of blades must be one whole number in every row")
        return int(number), []
    of_name = blades_of_name(path.stem)
    return (of_name, []) if of_name else (_N_BLADES, [f"{_N_BLADES} blades"])


def _airfoils(path: Path, column: Column, r_over_R: FloatArray) -> list[tuple[float, str]]:
    """Pairs of r/R and airfoil; of a run of equal ones its first and last station."""
    names = []
    for cell in column.cells:
        plain = "".join(cell.lower().replace("-", " ").split())
        if cell.lower().endswith(COORDINATE_ENDINGS):
            names.append(str(path.parent / cell))
        else:
            names.append(_SAME_NAMES.get(plain, plain))
    last = len(names) - 1
    return [
        (float(r), name)
        for k, (r, name) in enumerate(zip(r_over_R, names, strict=True))
        if k in (0, last) or name != names[k - 1] or name != names[k + 1]
    ]

"""Rotors in a folder of small tables, as the open database of FLOWUnsteady keeps them.

One file names tip and hub radius, blades and a file of the blade; that one names a file for each of
chord, pitch, sweep, height and airfoils, all of them by r/R. Sweep and height are of the leading
edge, ahead of the radial line and along the shaft; the airfoils' positions run from 0 at the hub to
1 at the tip. Between their rows the database's own program is linear.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.blade_tables.columns import Column, FloatArray, read_columns
from propmdao.propeller.airfoils.airfoil import AirfoilError
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import finite_number

_PROPERTY, _FILE = "property", "file"
_QUARTER = 0.25


def is_rotor_folder(columns: list[Column]) -> bool:
    """Tell the file of a rotor whose distributions stand in other files.

    Parameters
    ----------
    columns : list of Column
        Columns of the file.

    Returns
    -------
    bool
        True if it is such a file.
    """
    return [column.head for column in columns[:2]] == [_PROPERTY, _FILE]


def read_rotor_folder(path: Path, columns: list[Column]) -> Propeller:
    """Read a rotor whose distributions stand in other files.

    Parameters
    ----------
    path : Path
        File of the rotor: Rtip and Rhub [m], B, blade. Files that it names stand beside it;
        contours of airfoils beside it, or in the folder ``airfoils`` beside its own.
    columns : list of Column
        Columns of that file.

    Returns
    -------
    Propeller
        The propeller, named after the file, at every radius of its distributions from where all of
        them have begun.

    Raises
    ------
    PropellerError
        If an entry or a file is missing, a distribution does not reach the tip, or a value is out
        of range; the message begins with the file.
    """
    rotor = _entries(columns)
    tip, hub, blades = (_number(path, rotor, key) for key in ("Rtip", "Rhub", "B"))
    if not 0.0 < hub < tip:
        raise PropellerError(f"{path}: Rhub must be between 0 and Rtip, {tip:g}; it is {hub:g}")
    if not blades.is_integer():
        raise PropellerError(f"{path}: B must be a whole number; it is {blades:g}")
    blade_file = path.parent / _entry(path, rotor, "blade")
    blade = _entries(read_columns(blade_file))
    chord = _distribution(blade_file, blade, "chorddist")
    pitch = _distribution(blade_file, blade, "pitchdist")
    lines = [chord, pitch]
    lines += [_distribution(blade_file, blade, key) for key in ("sweepdist", "heightdist")
              if key in blade]  # fmt: skip
    root = max(hub / tip, *(line[0, 0] for line in lines))
    stations = np.unique(np.concatenate([[root], *(line[:, 0] for line in lines)]))
    stations = stations[stations >= root]
    c, beta, *leading = (np.interp(stations, line[:, 0], line[:, 1]) for line in lines)
    ahead, height = leading if len(leading) == 2 else (np.zeros_like(c), np.zeros_like(c))
    if leading:
        ahead = ahead - _QUARTER * c * np.cos(np.radians(beta))
        height = height - _QUARTER * c * np.sin(np.radians(beta))
    airfoils = _airfoils(blade_file, _entry(blade_file, blade, "airfoil_files"), hub / tip)
    try:
        propeller = Propeller(
            name=path.stem,
            diameter=2.0 * tip,
            n_blades=int(blades),
            r_over_R=stations,
            c_over_R=c,
            beta_deg=beta,
            airfoils=airfoils,
            sweep_over_R=-ahead,
            rake_over_R=height,
            source=f"{path.name} and the distributions that it names",
        )
    except PropellerError as error:
        raise PropellerError(f"{path}: {error}") from error
    warnings.warn(
        f"{path}: assumed, for the files do not say: the blade begins at r/R {root:.3g}, where all "
        "distributions have begun; angles are of the chord line",
        AssumedBladeWarning,
        stacklevel=5,
    )
    return propeller


def _entries(columns: list[Column]) -> dict[str, str]:
    """Values by property."""
    return dict(zip(columns[0].cells, columns[1].cells, strict=True))


def _entry(path: Path, entries: dict[str, str], key: str) -> str:
    """Value of a property that must be there."""
    if key not in entries:
        raise PropellerError(f"{path}: property '{key}' is missing")
    return entries[key]


def _number(path: Path, entries: dict[str, str], key: str) -> float:
    """Number of a property that must be there."""
    return finite_number(_entry(path, entries, key), PropellerError, f"{path}: {key}")


def _distribution(path: Path, entries: dict[str, str], key: str) -> FloatArray:
    """Rows r/R, value of a distribution."""
    file = path.parent / _entry(path, entries, key)
    columns = read_columns(file)
    if len(columns) != 2 or columns[0].quantity != "r/R":
        raise PropellerError(f"{file}: two columns expected, r/R and the distribution")
    if key == "pitchdist" and columns[1].angle is None:
        raise PropellerError(f"{file}: column '{columns[1].head}' needs a unit, deg or rad")
    if key != "pitchdist" and not columns[1].head.lower().split()[0].endswith("/r"):
        raise PropellerError(f"{file}: column '{columns[1].head}' must be over R")
    rows = np.stack(
        [columns[0].numbers(), (columns[1].angle or 1.0) * columns[1].numbers()], axis=1
    )
    if np.any(np.diff(rows[:, 0]) <= 0.0) or rows[-1, 0] != 1.0:
        raise PropellerError(f"{file}: r/R must rise to the tip, 1")
    return rows


def _airfoils(path: Path, name: str, hub: float) -> list[tuple[float, str]]:
    """Pairs of r/R and airfoil; the file's positions run from the hub to the tip."""
    file = path.parent / name
    position, contour = (column for column in read_columns(file)[:2])
    pairs = []
    for place, cell in zip(position.numbers(), contour.cells, strict=True):
        if not 0.0 <= place <= 1.0:
            raise PropellerError(f"{file}: positions must be within 0 ... 1; one is {place:g}")
        pairs.append((min(float(hub + place * (1.0 - hub)), 1.0), _airfoil(path.parent, cell)))
    return pairs


def _airfoil(folder: Path, contour: str) -> str:
    """The catalogue's name of a contour file, or the path of the file."""
    try:
        return find_airfoil(Path(contour).stem).name
    except AirfoilError:
        beside = [folder / contour, folder.parent / "airfoils" / contour]
        path = next((file for file in beside if file.is_file()), None)
    if path is None:
        raise PropellerError(f"{folder}: there is no contour file '{contour}', nor beside it")
    return str(path)

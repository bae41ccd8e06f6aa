"""Propeller files (TOML), read and written."""

from __future__ import annotations

import dataclasses
import difflib
import os
import re
import reprlib
import tomllib
from pathlib import Path
from typing import Any

import tomli_w

from propmdao.formats.blade_tables.stated_units import (
    BETA_FROM,
    FORMS,
    in_own_units,
    to_chord_line,
)
from propmdao.propeller.airfoils.library import COORDINATE_ENDINGS
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import DISTRIBUTIONS, MATERIAL, TRANSITION, Propeller
from propmdao.runtime.input_files import read_text
from propmdao.runtime.output_files import replacing

#: Containers that open within one another in a line, and a number of more digits than `int` takes.
_DEEP = re.compile(r"(?:[\[{][^\[\]{}]*){50}")
_LONG = re.compile(r"\d{4301}")


def read_toml(path: str | os.PathLike[str]) -> Propeller:
    """Read a propeller file.

    Parameters
    ----------
    path : path
        TOML file; paths of airfoils in it are relative to its folder. Lengths may be in millimetres
        or inches, as `propmdao.formats.blade_tables.stated_units.in_own_units` takes them;
        ``beta_from`` names the line that the blade angle is measured to, as `to_chord_line` there
        takes it.

    Returns
    -------
    Propeller
        The propeller.

    Raises
    ------
    PropellerError
        If the file cannot be read, is not TOML, lacks a key, has an unknown one or holds a value
        out of range; the message begins with the file.
    """
    path = Path(path)
    text = read_text(path, PropellerError)
    return propeller_from_text(text, str(path), path.parent)


def write_toml(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a propeller file that `read_toml` reads back to the same propeller.

    Parameters
    ----------
    path : path
        File to write; coordinate files in its folder or below are named relative to it.
    propeller : Propeller
        Propeller to write.

    Returns
    -------
    int
        Number of stations.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    with replacing(path) as file:
        file.write_text(toml_text(propeller, Path(path).absolute().parent), encoding="utf-8")
    return propeller.r_over_R.size


def toml_text(propeller: Propeller, folder: Path | None = None) -> str:
    """Text of a propeller file.

    Parameters
    ----------
    propeller : Propeller
        Propeller to write.
    folder : Path, optional
        Folder of the file, absolute; coordinate files in it or below are named relative to it, all
        others, and by default all, by their whole path.

    Returns
    -------
    str
        Text from which `propeller_from_text` builds the same propeller.
    """
    lines = [tomli_w.dumps({"name": propeller.name, "diameter": propeller.diameter}).rstrip()]
    lines.append(f"n_blades = {propeller.n_blades}")
    for key in DISTRIBUTIONS:
        values = getattr(propeller, key)
        if values is None or (key in ("sweep_over_R", "rake_over_R") and not values.any()):
            continue
        lines.append(f"{key} = [{', '.join(repr(float(value)) for value in values)}]")
    for key in (*TRANSITION, *MATERIAL):
        if (value := getattr(propeller, key)) is not None:
            lines.append(f"{key} = {value!r}")
    for key in ("tip", "trip"):
        if (value := getattr(propeller, key)) is not None:
            lines.append(tomli_w.dumps({key: value}).rstrip())
    tables = []
    for position, name in propeller.airfoils:
        if name.endswith(COORDINATE_ENDINGS):
            absolute = Path(name).absolute()
            if folder is not None and absolute.is_relative_to(folder):
                absolute = absolute.relative_to(folder)
            name = str(absolute)
        entry = tomli_w.dumps({"airfoil": name}).rstrip()
        tables.append(f"{{ r_over_R = {position}, {entry} }}")
    lines.append(f"airfoils = [ {', '.join(tables)} ]")
    lines.append(tomli_w.dumps({"source": propeller.source}))
    return "\n".join(lines)


def propeller_from_text(text: str, label: str, folder: Path | None) -> Propeller:
    """Build a propeller from the text of a propeller file.

    Parameters
    ----------
    text : str
        Text of the file (TOML).
    label : str
        Name of the file, with which messages begin.
    folder : Path or None
        Folder that paths of airfoils are relative to; None leaves them as they are.

    Returns
    -------
    Propeller
        The propeller.

    Raises
    ------
    PropellerError
        If the text is wrong in any of the ways that `read_toml` lists.
    """
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise PropellerError(f"{label}: is not valid TOML: {error}") from error
    except RecursionError:
        where = _line_of(text, _DEEP)
        raise PropellerError(f"{label}{where}: lists and tables are nested too deeply") from None
    except ValueError:  # what int() refuses
        where = _line_of(text, _LONG)
        raise PropellerError(f"{label}{where}: a number has too many digits") from None
    keys = [field.name for field in dataclasses.fields(Propeller)]
    keys += ["beta_from", *(form for forms in FORMS.values() for form in forms[1:])]
    for key in data:
        if key not in keys:
            near = difflib.get_close_matches(key, keys, n=1)
            hint = f"did you mean '{near[0]}'? " if near else ""
            raise PropellerError(f"{label}: unknown key '{key}'; {hint}known: {', '.join(keys)}")
    beta_from = data.pop("beta_from", BETA_FROM[0])
    try:
        data = in_own_units(data)
    except PropellerError as error:
        raise PropellerError(f"{label}: {error}") from error
    for key in ("name", "diameter", "n_blades", "r_over_R", "c_over_R", "beta_deg", "airfoils"):
        if key not in data:
            raise PropellerError(f"{label}: missing key '{key}'")
    data["airfoils"] = _airfoil_tables(label, data["airfoils"], folder)
    try:
        return to_chord_line(Propeller(**data), beta_from)
    except PropellerError as error:
        raise PropellerError(f"{label}: {error}") from error


def _line_of(text: str, what: re.Pattern[str]) -> str:
    """Line of a text in which a pattern stands, in words; nothing where it is in none."""
    lines = enumerate(text.splitlines(), start=1)
    return next((f", line {number}" for number, line in lines if what.search(line)), "")


def _airfoil_tables(label: str, tables: Any, folder: Path | None) -> list[tuple[float, str]]:
    """Read airfoils = [{r_over_R, airfoil}, ...]; paths become relative to the folder."""
    pairs = []
    for table in tables if isinstance(tables, list) else [tables]:
        if not isinstance(table, dict) or set(table) != {"r_over_R", "airfoil"}:
            raise PropellerError(
                f'{label}: airfoils must be a list of {{ r_over_R = 0.15, airfoil = "e63" }}; '
                f"got {reprlib.repr(table)}"
            )
        name = table["airfoil"]
        if folder is not None and isinstance(name, str) and name.endswith(COORDINATE_ENDINGS):
            name = str(folder / name)
        pairs.append((table["r_over_R"], name))
    return pairs

"""BEM files of OpenVSP: the propeller component as a table, in and out.

A title, eight lines ``name: value``, a line of heads and a line for each section; behind them, in
files of OpenVSP itself, the contour of each section over unit chord, which it writes and does not
read (``PropGeom::ReadBEM`` and ``Results::WriteBEMFile`` of OpenVSP 3.4x). Lengths have the unit of
the model.
"""

from __future__ import annotations

import dataclasses
import os
import re
from pathlib import Path

import numpy as np

from propmdao.formats.blade_tables.assumptions import assumed_propeller
from propmdao.formats.exchange.naca_sections import (
    AIRFOIL,
    camber_of_design_lift,
    section_of_contour,
)
from propmdao.formats.exchange.vsp_blade import (
    VspBlade,
    contours,
    quarter_chord,
    vsp_blade,
)
from propmdao.propeller.airfoils.coordinates import airfoil_from_coordinates
from propmdao.propeller.checks import MOST_STATIONS, PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import clipped, fields_of, finite_number, read_text
from propmdao.runtime.output_files import replacing

_TITLE = "...BEM Propeller..."
_HEADS = "Radius/R, Chord/R, Twist (deg), Rake/R, Skew/R, Sweep, t/c, CLi, Axial, Tangential"
_COLUMNS = tuple(field.name for field in dataclasses.fields(VspBlade))
_SECTIONS, _BLADES, _DIAMETER = "Num_Sections", "Num_Blade", "Diameter"
_BETA, _FEATHER, _CONE = "Beta 3/4 (deg)", "Feather (deg)", "Pre_Cone (deg)"
_CONTOUR = re.compile(r"Section \d+ X, Y")


def write_bem(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a BEM file, which OpenVSP imports as a propeller, with a section at each station.

    Parameters
    ----------
    path : path
        File to write; its unit of length is the metre.
    propeller : Propeller
        Propeller to write. OpenVSP makes NACA 16-series sections of thickness and design lift; the
        contours behind the table are for other readers. It sets sections across a raked blade
        where here they are across the radius.

    Returns
    -------
    int
        Number of sections.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    r = propeller.r_over_R
    blade = vsp_blade(propeller, r)
    beta = float(vsp_blade(propeller, [max(0.75, r[0])]).twist[0])
    lines = [
        _TITLE,
        f"{_SECTIONS}: {r.size}",
        f"{_BLADES}: {propeller.n_blades}",
        f"{_DIAMETER}: {propeller.diameter:.8f}",
        f"{_BETA}: {beta:.8f}",
        f"{_FEATHER}: {0.0:.8f}",
        f"{_CONE}: {0.0:.8f}",
        "Center: 0.00000000, 0.00000000, 0.00000000",
        "Normal: -1.00000000, 0.00000000, 0.00000000",
        "",
        _HEADS,
    ]
    table = np.stack([getattr(blade, column) for column in _COLUMNS], axis=1)
    lines += [", ".join(f"{value + 0.0:.8f}" for value in row) for row in table]
    x, z = contours(propeller, r)
    for number, section in enumerate(z):
        lines += ["", f"Section {number} X, Y"]
        lines += [f"{a:.8f}, {b:.8f}" for a, b in zip(x, section + 0.0, strict=True)]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return int(r.size)


def read_bem(path: str | os.PathLike[str]) -> Propeller:
    """Read a BEM file of OpenVSP.

    Parameters
    ----------
    path : path
        The file, whose unit of length is taken to be the metre.

    Returns
    -------
    Propeller
        The propeller, named after the file, its quarter chord and blade angle where OpenVSP puts
        them with rake, skew, sweep, feather and cone. Its sections have the thickness of the table.
        Contours that are sections of the catalogue become these; others, and files without
        contours, NACA 4-digit sections of the camber that has the zero-lift angle of the contour
        by thin-airfoil theory, or the design lift of the table. An `AssumedBladeWarning` says so.

    Raises
    ------
    PropellerError
        If the file cannot be read or is no BEM file, an entry is missing or no number, or a value
        is out of range; the message begins with the file.
    """
    path = Path(path)
    lines = [line.strip() for line in read_text(path, PropellerError).splitlines()]
    start = next((k for k, line in enumerate(lines) if line.startswith("Radius/R")), None)
    if start is None:
        raise PropellerError(f"{path}: no BEM file of OpenVSP: there is no line of heads Radius/R")
    header = _header(path, lines[:start])
    n_sections, n_blades = (_whole(path, header, key) for key in (_SECTIONS, _BLADES))
    if not 2 <= n_sections <= MOST_STATIONS:
        raise PropellerError(
            f"{path}: {_SECTIONS} must be 2 ... {MOST_STATIONS}; it is {n_sections}"
        )
    end = start + 1 + n_sections
    rows = [_row(path, number + 1, lines) for number in range(start + 1, end)]
    blade = VspBlade(*np.transpose(rows))
    feather = _angle(path, header, _FEATHER)
    radius, aft, up = quarter_chord(blade, feather, _angle(path, header, _CONE))
    if not radius[-1] > 0.0:
        raise PropellerError(f"{path}: Radius/R must end above 0; it ends at {radius[-1]:g}")
    sections = _sections(path, lines[end:], n_sections)
    airfoils, camber, camber_of = [AIRFOIL], camber_of_design_lift(blade.design_lift), "design lift"
    if sections is not None:
        airfoils, camber = [name for name, _ in sections], np.array([c for _, c in sections])
        camber_of = "zero-lift angle"
    tip = float(radius[-1])
    n_naca = n_sections if sections is None else airfoils.count(AIRFOIL)
    naca = f"; NACA 4-digit sections of the file's thickness and {camber_of} at {n_naca} of "
    naca += f"{n_sections} stations"
    return assumed_propeller(
        path,
        f"lengths in metres{naca if n_naca else ''}",
        diameter=tip * _number(path, header, _DIAMETER),
        n_blades=n_blades,
        r_over_R=radius / tip,
        c_over_R=blade.chord / tip,
        beta_deg=blade.twist + feather,
        airfoils=list(zip(radius[-len(airfoils) :] / tip, airfoils, strict=True)),
        thickness_over_chord=blade.thickness,
        camber_over_chord=camber,
        sweep_over_R=aft / tip,
        rake_over_R=up / tip,
        source=f"OpenVSP, {path.name}",
    )


def _header(path: Path, lines: list[str]) -> dict[str, str]:
    """Entries of the lines ``name: value`` that are needed."""
    entries = dict(line.split(":", 1) for line in lines if ":" in line)
    # Feather and cone came to the format late.
    entries = {_FEATHER: "0", _CONE: "0", **entries}
    for key in (_SECTIONS, _BLADES, _DIAMETER):
        if key not in entries:
            raise PropellerError(f"{path}: entry '{key}: ...' is missing")
    return entries


def _number(path: Path, header: dict[str, str], key: str) -> float:
    """Number of an entry."""
    return finite_number(header[key].strip(), PropellerError, f"{path}: {key}")


def _whole(path: Path, header: dict[str, str], key: str) -> int:
    """Whole number of an entry."""
    value = _number(path, header, key)
    if not value.is_integer():
        raise PropellerError(f"{path}: {key} must be a whole number; it is {value:g}")
    return int(value)


def _angle(path: Path, header: dict[str, str], key: str) -> float:
    """Angle of an entry [deg]."""
    value = _number(path, header, key)
    if abs(value) > 90.0:
        raise PropellerError(f"{path}: {key} must be within -90 ... 90; it is {value:g}")
    return value


def _row(path: Path, number: int, lines: list[str]) -> list[float]:
    """Numbers of a section's line, which counts from 1."""
    line = lines[number - 1] if number <= len(lines) else ""
    fields = fields_of(line)
    where = f"{path}, line {number}"
    if fields is None or len(fields) != len(_COLUMNS):
        raise PropellerError(
            f"{where}: {len(_COLUMNS)} numbers of a section expected, not '{clipped(line)}'"
        )
    return [finite_number(field, PropellerError, where) for field in fields]


def _sections(path: Path, lines: list[str], n_sections: int) -> list[tuple[str, float]] | None:
    """Airfoil and camber of each section by its contour; None where there are no contours."""
    points: list[list[list[float]]] = []
    for line in lines:
        if _CONTOUR.fullmatch(line):
            points.append([])
        elif line:
            fields = fields_of(line)
            if fields is None or len(fields) != 2 or not points:
                raise PropellerError(f"{path}: a point of a section expected: '{clipped(line)}'")
            points[-1].append([finite_number(f, PropellerError, str(path)) for f in fields])
    if not points:
        return None
    if len(points) != n_sections:
        raise PropellerError(f"{path}: {n_sections} sections expected; {len(points)} have contours")
    try:
        return [
            section_of_contour(airfoil_from_coordinates(f"section {k}", *np.transpose(contour)))
            for k, contour in enumerate(points)
        ]
    except ValueError as error:
        raise PropellerError(f"{path}: {error}") from error

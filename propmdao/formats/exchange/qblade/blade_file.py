"""Blade files of QBlade, in and out.

Keywords, each behind its value, a line of heads that begins with POS, and a line for each station:
radius, chord, twist, offsets of the thread axis in and out of the plane of rotation, place of that
axis over chord, and a polar file, which names a file of the contour (QBlade documentation 2.0,
Blade Design Overview). Positive twist turns the trailing edge toward +OFFSET_Y: the documentation's
blade of 5 MW has its pitch axis on a straight line with these signs. A propeller's blade angle is
such a twist, so +OFFSET_Y is against thrust.

QBlade draws sections with their upper side toward +OFFSET_Y, as turbines have it. Its propeller
analysis takes minus the lift of the polar at minus the angle of attack (`BData::OnPropBEM`). So
contours and polars of a propeller stand upside down in its files.
"""

from __future__ import annotations

import dataclasses
import os
import re
from pathlib import Path

import numpy as np

from propmdao.aerodynamics.sections.polars.high_angle import ALPHA
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import PolarError
from propmdao.formats.blade_tables.assumptions import assumed_propeller
from propmdao.formats.exchange.naca_sections import (
    AIRFOIL,
    camber_of_zero_lift,
    section_of_contour,
)
from propmdao.formats.exchange.qblade.polar_file import (
    QBladePolar,
    keyword_line,
    read_qblade_polar,
    section_line,
    value_of,
)
from propmdao.formats.exchange.section_fits import curves_of_sections
from propmdao.formats.exchange.vsp_blade import contours
from propmdao.geometry.blade import Blade
from propmdao.propeller.airfoils.airfoil import Airfoil
from propmdao.propeller.airfoils.coordinate_files import read_coordinates
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import MOST_STATIONS, PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import clipped, finite_number, is_number, read_text
from propmdao.runtime.output_files import replacing, replacing_in
from propmdao.runtime.terminal import printable

_TITLE = "QBlade Blade Definition File"
_HEADS = ("POS [m]", "CHORD [m]", "TWIST [deg]", "OFFSET_X [m]", "OFFSET_Y [m]", "TAXIS [-]")
#: Place of the thread axis in written files: sweep and rake are those of the quarter chord.
_QUARTER = 0.25


def write_bld(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a blade file of QBlade, and beside it a folder with polars and contours.

    Parameters
    ----------
    path : path
        File to write; ``NAME_polars`` beside it gets a polar file and a contour for each station.
    propeller : Propeller
        Propeller to write. The polars are those of the analysis, in incompressible flow, at all
        angles and at the Reynolds numbers of their table. Sections are upside down, as QBlade takes
        them for a propeller.

    Returns
    -------
    int
        Number of stations.

    Raises
    ------
    PolarError
        If the transition of the propeller takes NeuralFoil and it is not installed.
    OutputError
        If a file cannot be written.
    """
    path = Path(path)
    # QBlade separates columns by blanks.
    stem = re.sub(r"\s+", "_", printable(path.stem))
    folder = f"{stem}_polars"
    radius, r = 0.5 * propeller.diameter, propeller.r_over_R
    names = [f"{stem}_{k:02d}" for k in range(r.size)]
    x, z = contours(propeller, r)
    with replacing_in(path.parent / folder) as place:
        for name, polar, section in zip(names, _polars(propeller, names), z, strict=True):
            (place / f"{name}.plr").write_text(polar.upside_down().text(), encoding="utf-8")
            # The round of `contours` begins at the lower side, which is the upper one of this.
            points = [f"{a:.8f} {b:.8f}" for a, b in zip(x, -section + 0.0, strict=True)]
            (place / f"{name}.afl").write_text("\n".join([name, *points, ""]), encoding="utf-8")
    columns = (radius * r, radius * propeller.c_over_R, propeller.beta_deg,
               radius * propeller.sweep_over_R, -radius * propeller.rake_over_R,
               np.full(r.size, _QUARTER))  # fmt: skip
    rows = [
        [*[f"{value + 0.0:.8f}" for value in numbers], f"{folder}/{name}.plr"]
        for *numbers, name in zip(*columns, names, strict=True)
    ]
    lines = [
        section_line(_TITLE),
        "Generated with : propmdao",
        "",
        section_line("Object Name"),
        keyword_line(stem, "OBJECTNAME", "the name of the blade object"),
        "",
        section_line("Parameters"),
        keyword_line("HAWT", "ROTORTYPE", "the rotor type"),
        keyword_line(str(propeller.n_blades), "NUMBLADES", "number of blades"),
        "",
        section_line("Blade Data"),
        *["".join(f"{word:<20}" for word in row) for row in [[*_HEADS, "POLAR_FILE"], *rows]],
    ]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return int(r.size)


def _polars(propeller: Propeller, names: list[str]) -> list[QBladePolar]:
    """Polar of each station."""
    polars = polars_for(propeller)
    reynolds = np.exp(np.asarray(polars.log_re))
    r = propeller.r_over_R
    curves = curves_of_sections(
        propeller, polars, np.repeat(r, reynolds.size), np.tile(reynolds, r.size)
    ).reshape(3, r.size, reynolds.size, -1)
    thickness = np.asarray(Blade.from_propeller(propeller).thickness_over_chord)
    return [
        QBladePolar(f"{name}_Polar", f"{name}.afl", t, reynolds, ALPHA, values)
        for name, t, values in zip(names, thickness, curves.transpose(1, 2, 0, 3), strict=True)
    ]


@dataclasses.dataclass(frozen=True)
class _Section:
    """Section of a station: name in the catalogue, thickness and camber over chord, origin."""

    name: str
    thickness: float
    camber: float
    origin: str


def read_bld(path: str | os.PathLike[str]) -> Propeller:
    """Read a blade file of QBlade as a propeller.

    Parameters
    ----------
    path : path
        The file; its polar files, and the contours that these name, are looked for where it says.

    Returns
    -------
    Propeller
        The propeller, named after the file. Each section is cambered toward thrust, whichever way
        up it stands in the file. Contours that are sections of the catalogue become these; others
        NACA 4-digit sections of the contour's thickness and zero-lift angle (thin-airfoil theory);
        without a contour those of the polar; without both, NACA 4412. An `AssumedBladeWarning` says
        so.

    Raises
    ------
    PropellerError
        If the file, or one that it names, cannot be read or is wrong, it is of a turbine with a
        vertical axis, an entry is missing, or a value is out of range; the message begins with the
        file.
    """
    path = Path(path)
    lines = read_text(path, PropellerError, undecodable="replace").splitlines()
    if not any(_TITLE in line for line in lines[:1]):
        raise PropellerError(f"{path}: no blade file of QBlade: its first line has '{_TITLE}'")
    start = next((k for k, line in enumerate(lines) if line.strip().startswith("POS")), len(lines))
    header = "\n".join(lines[:start])
    if (kind := value_of(header, "ROTORTYPE")) == "VAWT":
        raise PropellerError(f"{path}: ROTORTYPE is {kind}; a propeller is read, not that")
    if (counted := value_of(header, "NUMBLADES")) is None:
        raise PropellerError(f"{path}: entry '... NUMBLADES' is missing")
    blades = finite_number(counted, PropellerError, f"{path}: NUMBLADES")
    if not blades.is_integer():
        raise PropellerError(f"{path}: NUMBLADES must be a whole number; it is {blades:g}")
    rows, files = _stations(path, lines, start + 1)
    radius, chord, beta, across, along, axis = np.transpose(rows)
    if not radius[-1] > 0.0:
        raise PropellerError(f"{path}: POS must end above 0; it ends at {radius[-1]:g}")
    tip = float(radius[-1])
    behind, angle = (_QUARTER - axis) * chord, np.radians(beta)
    sections = [_section(path, file) for file in files]
    assumed = "sections cambered toward thrust"
    for origin, meaning in _ORIGINS.items():
        if any(section.origin == origin for section in sections):
            n_stations = sum(section.origin == origin for section in sections)
            assumed += f"; {meaning} at {n_stations} of {len(sections)} stations"
    return assumed_propeller(
        path,
        assumed,
        diameter=2.0 * tip,
        n_blades=int(blades),
        r_over_R=radius / tip,
        c_over_R=chord / tip,
        beta_deg=beta,
        airfoils=[(r, s.name) for r, s in zip(radius / tip, sections, strict=True)],
        thickness_over_chord=[section.thickness for section in sections],
        camber_over_chord=[section.camber for section in sections],
        sweep_over_R=(across + behind * np.cos(angle)) / tip,
        rake_over_R=-(along + behind * np.sin(angle)) / tip,
        source=f"QBlade, {path.name}",
    )


#: What the sections of a blade have come from, where it is not a section of the catalogue.
_ORIGINS = {
    "contour": "NACA 4-digit sections of the contour's thickness and zero-lift angle",
    "polar": "NACA 4-digit sections of the polar's thickness and zero-lift angle",
    "nothing": f"{AIRFOIL}, for there is no polar file,",
}


def _stations(path: Path, lines: list[str], start: int) -> tuple[list[list[float]], list[str]]:
    """Six numbers and the polar file of each station."""
    rows, files = [], []
    for number, line in enumerate(lines[start:], start=start + 1):
        *words, file = [*line.split(None, len(_HEADS)), ""][: len(_HEADS) + 1]
        if not words or not is_number(words[0]):
            break
        where = f"{path}, line {number}"
        if len(words) < len(_HEADS):
            raise PropellerError(f"{where}: six numbers of a station expected: '{clipped(line)}'")
        rows.append([finite_number(word, PropellerError, where) for word in words])
        files.append(file.strip())
    if not 2 <= len(rows) <= MOST_STATIONS:
        raise PropellerError(
            f"{path}: 2 ... {MOST_STATIONS} stations expected below the heads POS CHORD TWIST; "
            f"there are {len(rows)}"
        )
    return rows, files


def _section(path: Path, file: str) -> _Section:
    """Section that the polar file of a station, or the contour it names, describes."""
    polar_path = path.parent / file.replace("\\", "/")
    if not file or not polar_path.is_file():
        assumed = find_airfoil(AIRFOIL)
        return _Section(AIRFOIL, assumed.max_thickness, assumed.max_camber, "nothing")
    try:
        polar = read_qblade_polar(polar_path)
        contour = polar_path.parent / polar.airfoil.replace("\\", "/")
        if polar.airfoil and contour.is_file():
            airfoil = read_coordinates(contour)
            if airfoil.zero_lift_angle > 0.0:
                airfoil = Airfoil(airfoil.name, -airfoil.camber, airfoil.thickness)
            name, camber = section_of_contour(airfoil)
            origin = "contour" if name == AIRFOIL else "catalogue"
            return _Section(name, airfoil.max_thickness, camber, origin)
        camber = float(camber_of_zero_lift(-abs(polar.zero_lift_angle())))
        return _Section(AIRFOIL, polar.thickness, camber, "polar")
    except PolarError as error:
        named = str(error).startswith(str(polar_path))
        raise PropellerError(f"{path}: {error if named else f'{polar_path}: {error}'}") from None
    except ValueError as error:
        raise PropellerError(f"{path}: {error}") from None

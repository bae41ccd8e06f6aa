"""Propeller files of QPROP and QMIL, in and out.

A name; the number of blades and, if it is not the last station's, the tip radius; lift, stall, drag
and Reynolds number of the sections; factors and addends of radius, chord and angle; a line for each
station, on which its own section may follow (Drela, QPROP User Guide 1.21, 2007). QPROP takes the
tip radius in metres; the guide's example has it in the unit of the stations.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from propmdao.formats.blade_tables.assumptions import assumed_propeller
from propmdao.formats.exchange.naca_sections import OPEN_TIP, blade_by_zero_lift
from propmdao.formats.exchange.section_fits import TIP_MACH, SectionFit, section_fits
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import clipped, fields_of, finite_number, read_text
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import printable

#: Stations that QPROP has room for.
_MOST = 81
#: Lines ahead of the stations: how many numbers each has at least and at most, and which.
_HEADER = (
    (1, 2, "Nblades [R]"),
    (2, 2, "CL0 CL_a"),
    (2, 2, "CLmin CLmax"),
    (3, 4, "CD0 CD2u CD2l CLCD0"),
    (2, 2, "REref REexp"),
    (3, 3, "Rfac Cfac Bfac"),
    (3, 3, "Radd Cadd Badd"),
)
_LONGEST_LINE = 13
#: r/R of the section in the lines ahead of the stations.
_TYPICAL = 0.75


def write_qprop(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a propeller file of QPROP, with a section's lift and drag at each station.

    Parameters
    ----------
    path : path
        File to write; lengths are in metres.
    propeller : Propeller
        Propeller to write. The file holds chord and blade angle; lift and drag are fits to the
        polars (`propmdao.formats.exchange.section_fits`). Sweep and rake are left out.

    Returns
    -------
    int
        Number of stations.

    Raises
    ------
    ValueError
        If there are more than 81 stations.
    PolarError
        If the transition of the propeller takes NeuralFoil and it is not installed.
    OutputError
        If the file cannot be written.
    """
    r = propeller.r_over_R
    if r.size > _MOST:
        raise ValueError(f"QPROP takes up to {_MOST} stations; {propeller.name} has {r.size}")
    fits, radius = section_fits(propeller, r), 0.5 * propeller.diameter
    # QPROP 1.22 takes the REref of its innermost section everywhere, so one has to do for all.
    re = fits[int(np.argmin(np.abs(r - _TYPICAL)))].re
    fits = [fit.at_reynolds(re) for fit in fits]
    typical = fits[int(np.argmin(np.abs(r - _TYPICAL)))]
    lines = [
        printable(propeller.name),
        "",
        f" {propeller.n_blades}  ! Nblades",
        "",
        f" {_lift(typical)}  ! CL0 CL_a",
        f" {typical.cl_min:.4f} {typical.cl_max:.4f}  ! CLmin CLmax",
        f" {_drag(typical)}  ! CD0 CD2u CD2l CLCD0",
        f" {typical.re:.0f} {typical.re_exponent:.3f}  ! REref REexp",
        "",
        " 1 1 1  ! Rfac Cfac Bfac",
        " 0 0 0  ! Radd Cadd Badd",
        "",
        f"# metres, degrees; sections at tip Mach {TIP_MACH:g}",
        "# r chord beta CL0 CL_a CLmin CLmax CD0 CD2u CD2l CLCD0 REref REexp",
    ]
    rows = zip(r, propeller.c_over_R, propeller.beta_deg, fits, strict=True)
    lines += [
        f" {radius * a:.7g} {radius * c:.7g} {b:.6g} {_lift(fit)} {fit.cl_min:.4f} "
        f"{fit.cl_max:.4f} {_drag(fit)} {fit.re:.0f} {fit.re_exponent:.3f}"
        for a, c, b, fit in rows
    ]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return int(r.size)


def read_qprop(path: str | os.PathLike[str]) -> Propeller:
    """Read a propeller file of QPROP or QMIL.

    Parameters
    ----------
    path : path
        The file; factors in it make its lengths metres and its angles degrees.

    Returns
    -------
    Propeller
        The propeller, named after the file. Its sections are NACA 4-digit ones, 12 % thick, with
        the camber that has the file's zero-lift angle by thin-airfoil theory. Up to a tenth of
        the radius beyond the last station is closed with its chord and angle. An
        `AssumedBladeWarning` says so.

    Raises
    ------
    PropellerError
        If the file cannot be read, a line does not hold the numbers that it should, or a value is
        out of range; the message begins with the file.
    """
    path = Path(path)
    header, stations = _numbers(path)
    (n_blades, *tips), (lift, slope), (factors, addends) = header[0], header[1], header[5:7]
    if not n_blades.is_integer():
        raise PropellerError(f"{path}: Nblades must be a whole number; it is {n_blades:g}")
    if not stations:
        raise PropellerError(f"{path}: there is no line r chord beta of a station")
    r, chord, beta = (
        np.array([row[k] for row in stations]) * factors[k] + addends[k] for k in range(3)
    )
    lifts = np.array([row[3] if len(row) > 3 else lift for row in stations])
    slopes = np.array([row[4] if len(row) > 4 else slope for row in stations])
    if not np.all(slopes > 0.0):
        raise PropellerError(f"{path}: CL_a must be above 0; one is {slopes.min():g}")
    tip = float(r[-1])
    if tips and tips[0] > 0.0:
        tip = _tip_radius(path, tips[0], factors[0], tip)
    described, assumed = blade_by_zero_lift(
        r / tip, chord / tip, beta, lambda at: np.interp(at, r / tip, -lifts / slopes)
    )
    return assumed_propeller(
        path,
        assumed,
        diameter=2.0 * tip,
        n_blades=int(n_blades),
        source=f"QPROP, {path.name}",
        **described,
    )


def _lift(fit: SectionFit) -> str:
    """Lift coefficient at no angle of attack, and its slope."""
    return f"{-fit.slope * fit.zero_lift:.4f} {fit.slope:.4f}"


def _drag(fit: SectionFit) -> str:
    """Least drag, its curvature on either side, lift at least drag."""
    return f"{fit.cd_min:.5f} {fit.curvature:.5f} {fit.curvature:.5f} {fit.cl_of_cd_min:.4f}"


def _numbers(path: Path) -> tuple[list[list[float]], list[list[float]]]:
    """Numbers of the lines ahead of the stations, and of these."""
    text = read_text(path, PropellerError, undecodable="replace")
    lines = [
        (f"{path}, line {number}", content)
        for number, line in enumerate(text.splitlines(), start=1)
        if (content := line.split("!")[0].split("#")[0].strip())
    ][1:]  # the first line is the name
    if len(lines) < len(_HEADER):
        raise PropellerError(
            f"{path}: no propeller file of QPROP: a name and {len(_HEADER)} lines of numbers "
            "expected ahead of the stations"
        )
    ranges = [*_HEADER, *[(3, _LONGEST_LINE, "r chord beta")] * (len(lines) - len(_HEADER))]
    rows = []
    for (where, content), (least, most, names) in zip(lines, ranges, strict=True):
        fields = fields_of(content)
        if fields is None or not least <= len(fields) <= most:
            raise PropellerError(f"{where}: numbers {names} expected, not '{clipped(content)}'")
        rows.append([finite_number(field, PropellerError, where) for field in fields])
    return rows[: len(_HEADER)], rows[len(_HEADER) :]


def _tip_radius(path: Path, stated: float, factor: float, last: float) -> float:
    """Tip radius [m] as a file has it, in metres or in the unit of its stations."""
    for radius in (stated, factor * stated):
        # A last station that rounding has put beyond the tip is at it.
        if (1.0 - 1e-6) * last <= radius <= last / (1.0 - OPEN_TIP):
            return max(radius, last)
    raise PropellerError(
        f"{path}: R, {stated:g}, must be at the last station, {last:g} m, or up to "
        f"{OPEN_TIP:.0%} of it beyond"
    )

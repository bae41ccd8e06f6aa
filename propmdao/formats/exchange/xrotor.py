"""Rotor files of XROTOR, in and out.

Lines of numbers between lines of heads that begin with an exclamation mark: air, radius and speed,
hub, up to 20 sections, flags, stations (``SAVE`` and ``LOAD`` of XROTOR 7.55; Drela, Youngren,
XROTOR User Guide, 2003). Sections lie at some r/R; between them XROTOR is linear.
"""

from __future__ import annotations

import os
from pathlib import Path

import numpy as np

from propmdao.formats.blade_tables.assumptions import assumed_propeller
from propmdao.formats.exchange.naca_sections import blade_by_zero_lift
from propmdao.formats.exchange.section_fits import TIP_MACH, section_fits
from propmdao.propeller.checks import MOST_STATIONS, PropellerError
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air
from propmdao.runtime.input_files import clipped, fields_of, finite_number, read_text
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import printable

_TITLE = "XROTOR"
_MOST_SECTIONS = 20
#: Lift's slope beyond stall and its rise to there, and the Mach number of rising drag, as XROTOR
#: has them by default.
_STALL_SLOPE, _STALL_RISE, _CRITICAL_MACH = 0.1, 0.1, 0.8
#: Advance ratio, V over the speed of the tip, of the operating point that the file needs.
_ADVANCE = 0.1


def write_xrotor(path: str | os.PathLike[str], propeller: Propeller) -> int:
    """Write a rotor file of XROTOR.

    Parameters
    ----------
    path : path
        File to write; lengths are in metres.
    propeller : Propeller
        Propeller to write. The file holds chord and blade angle; lift and drag of up to 20
        sections are fits to the polars (`propmdao.formats.exchange.section_fits`). Sweep and rake
        are left out. XROTOR spans its own stations over those of the file.

    Returns
    -------
    int
        Number of stations.

    Raises
    ------
    PolarError
        If the transition of the propeller takes NeuralFoil and it is not installed.
    OutputError
        If the file cannot be written.
    """
    air, r = Air(), propeller.r_over_R
    chosen = np.unique(np.linspace(0, r.size - 1, min(r.size, _MOST_SECTIONS)).round().astype(int))
    fits = section_fits(propeller, r[chosen])
    speed = _ADVANCE * TIP_MACH * air.sound_speed
    lines = [
        f"{_TITLE} VERSION:  7.55",
        printable(propeller.name),
        "! Rho Vso Rmu Alt",
        f" {air.density} {air.sound_speed} {air.dynamic_viscosity} 0.0",
        "! Rad Vel Adv Rake",
        f" {0.5 * propeller.diameter:.9g} {speed:.9g} {_ADVANCE:g} 0.0",
        "! XI0 XIW",
        f" {r[0]:.9g} 0.0",
        "! Naero",
        f" {len(fits)}",
    ]
    for position, fit in zip(r[chosen], fits, strict=True):
        lines += [
            "! Xisection",
            f" {position:.9g}",
            "! A0deg dCLdA CLmax CLmin",
            f" {np.degrees(fit.zero_lift):.5f} {fit.slope:.5f} {fit.cl_max:.5f} {fit.cl_min:.5f}",
            "! dCLdAstall dCLstall Cmconst Mcrit",
            f" {_STALL_SLOPE} {_STALL_RISE} {fit.moment:.5f} {_CRITICAL_MACH}",
            "! CDmin CLCDmin dCDdCL^2",
            f" {fit.cd_min:.6f} {fit.cl_of_cd_min:.5f} {fit.curvature:.6f}",
            "! REref REexp",
            f" {fit.re:.0f} {fit.re_exponent:.4f}",
        ]
    lines += ["! LVDuct LDuct LWind", " F F F", "! II Nblds", f" {r.size} {propeller.n_blades}"]
    lines += ["! r/R C/R Beta0deg Ubody"]
    rows = zip(r, propeller.c_over_R, propeller.beta_deg, strict=True)
    lines += [f" {a:.9g} {c:.9g} {b:.9g} 0.0" for a, c, b in rows]
    with replacing(path) as file:
        file.write_text("\n".join(lines) + "\n", encoding="utf-8")
    return int(r.size)


def read_xrotor(path: str | os.PathLike[str]) -> Propeller:
    """Read a rotor file of XROTOR from version 6.9 on.

    Parameters
    ----------
    path : path
        The file; its lengths are in metres.

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
    lines = _Lines(path)
    lines.numbers(4, "Rho Vso Rmu Alt")
    tip, _, _, rake = lines.numbers(4, "Rad Vel Adv Rake")
    lines.numbers(2, "XI0 XIW")
    positions, zero_lift = [], []
    for _ in range(lines.count("Naero", _MOST_SECTIONS)):
        positions += lines.numbers(1, "Xisection")
        zero_lift.append(lines.numbers(4, "A0deg dCLdA CLmax CLmin")[0])
        lines.numbers(4, "dCLdAstall dCLstall Cmconst Mcrit")
        lines.numbers(3, "CDmin CLCDmin dCDdCL^2")
        lines.numbers(2, "REref REexp")
    lines.skip()  # flags of the duct and of the wake
    n_stations, n_blades = (lines.whole(value) for value in lines.numbers(2, "II Nblds"))
    if not 2 <= n_stations <= MOST_STATIONS:
        raise PropellerError(f"{path}: II must be 2 ... {MOST_STATIONS}; it is {n_stations}")
    table = [lines.numbers(4, "r/R C/R Beta0deg Ubody")[:3] for _ in range(n_stations)]
    r, chord, beta = np.transpose(table)
    described, assumed = blade_by_zero_lift(
        r, chord, beta, lambda at: np.interp(at, positions, np.radians(zero_lift))
    )
    if rake:
        assumed += f"; no rake, of which the file has {rake:g}"
    return assumed_propeller(
        path,
        assumed,
        diameter=2.0 * tip,
        n_blades=n_blades,
        source=f"XROTOR, {path.name}",
        **described,
    )


class _Lines:
    """Lines of numbers of a file, one after the other."""

    def __init__(self, path: Path) -> None:
        text = read_text(path, PropellerError, undecodable="replace")
        self._path = path
        self._lines = [
            (f"{path}, line {number}", line.split("!")[0].strip())
            for number, line in enumerate(text.splitlines(), start=1)
            if line.split("!")[0].strip()
        ]
        if not self._lines or not self._lines[0][1].startswith(_TITLE):
            raise PropellerError(
                f"{path}: no rotor file of XROTOR from version 6.9 on: its first line begins with "
                f"{_TITLE} VERSION"
            )
        del self._lines[:2]  # title and name

    def skip(self) -> None:
        """Leave a line out."""
        self._next("flags")

    def numbers(self, n: int, names: str) -> list[float]:
        """First numbers of the next line."""
        where, line = self._next(names)
        fields = fields_of(line)
        if fields is None or len(fields) < n:
            raise PropellerError(f"{where}: numbers {names} expected, not '{clipped(line)}'")
        return [finite_number(field, PropellerError, where) for field in fields[:n]]

    def count(self, name: str, most: int) -> int:
        """A number of things to come."""
        (value,) = self.numbers(1, name)
        if not 1 <= self.whole(value) <= most:
            raise PropellerError(f"{self._path}: {name} must be 1 ... {most}; it is {value:g}")
        return int(value)

    def whole(self, value: float) -> int:
        """A whole number."""
        if not value.is_integer():
            raise PropellerError(f"{self._path}: a whole number expected; it is {value:g}")
        return int(value)

    def _next(self, names: str) -> tuple[str, str]:
        """The next line and where it stands."""
        if not self._lines:
            raise PropellerError(f"{self._path}: ends ahead of {names}")
        return self._lines.pop(0)

"""PE0 files of the maker of the APC propellers as propellers.

What the file refers to the mould is referred to the chord line here. Chord, TWIST and SWEEP are of
the parting lines, the foremost and rearmost points of a section. On Clark-Y blades, whose lower
side is flat, QUOTED is its angle, and TWIST follows from it within 0.05 deg if the line runs to the
upper corner of a blunt trailing edge as thick as CROSS-SECTION says. PRATHER is the angle of a
gauge under the section, which touches the lower corner. The chord line ends between both corners,
so its angle is the mean of what each of the two lines gives; where the gauge lies lower than a
sharp trailing edge allows, at roots that run into the hub and at tips, the parting line counts
alone.

The maker scales his airfoils by the thickness ratio. CLARK-Y keeps its flat lower side, to
0.001 deg, at every thickness: all its ordinates are scaled. E63 and APC12 keep their camber:
PRATHER falls with their thickness as it does for a camber line that stays.
"""

from __future__ import annotations

import os
import warnings
from pathlib import Path

import numpy as np

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.blade_tables.pe0_table import FloatArray, Pe0Table, read_pe0_table
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, Airfoil
from propmdao.propeller.airfoils.datums import chord_from_flat_bottom, chord_from_parting_line
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

#: The maker's names of airfoils, and ours; the files say that APC12 is NACA 4412.
_AIRFOILS = {
    "E63": "e63",
    "APC12": "naca4412",
    "CLARK-Y": "clarky",
    "NACA0012": "naca0012",
    "NACA2412": "naca2412",
}
_ALL_ORDINATES_SCALED = ("clarky",)
_QUARTER = 0.25
#: Chord over tip radius of the tip, at least: the last row of a table has next to none, and faces
#: of a surface need an area.
_TIP_CHORD = 0.005


def read_pe0(path: str | os.PathLike[str]) -> Propeller:
    """Read a PE0 file as a propeller.

    Parameters
    ----------
    path : path
        The file.

    Returns
    -------
    Propeller
        The propeller, named after the file. An `AssumedBladeWarning` says what was assumed.

    Raises
    ------
    PropellerError
        If `read_pe0_table` refuses the file, the catalogue does not have its airfoils, or a value
        is out of range; the message begins with the file.
    """
    path = Path(path)
    table = read_pe0_table(path)
    try:
        propeller = propeller_of_table(table, path.stem)
    except PropellerError as error:
        raise PropellerError(f"{path}: {error}") from error
    steeper = float(np.max(propeller.beta_deg - table.twist_deg))
    warnings.warn(
        f"{path}: assumed, for the file does not say: no hub, the blade begins at the first station"
        f" (r/R {propeller.r_over_R[0]:.3g}); chord line between parting line and gauge, up to "
        f"{steeper:.1f} deg steeper than TWIST; trailing edges sharp",
        AssumedBladeWarning,
        stacklevel=4,  # past the table of readers and `load_propeller`
    )
    return propeller


def propeller_of_table(table: Pe0Table, name: str) -> Propeller:
    """Turn the table of a PE0 file into a propeller.

    Parameters
    ----------
    table : Pe0Table
        Contents of the file.
    name : str
        Name of the propeller.

    Returns
    -------
    Propeller
        The propeller: blade angle of the chord line, sweep of the quarter chord from SWEEP, rake
        of the quarter chord from ZHIGH, at the stations of the table; material and cross-sections
        for elastic blades.

    Raises
    ------
    PropellerError
        If the catalogue does not have its airfoils, their transition does not run outward, or a
        value is out of range.
    """
    tip = table.radius[-1]
    airfoils = _airfoils(table)
    sections = [_Section(table, airfoils, i) for i in range(table.radius.size)]
    beta = np.array([section.beta for section in sections])
    steeper = beta - np.radians(table.twist_deg)
    # The row that closes the tip has no section to be gauged.
    closing = table.cross_section == 0.0
    if closing.all():
        raise PropellerError("CROSS-SECTION must not be 0 everywhere")
    beta[closing] += (
        np.interp(table.radius[closing], table.radius[~closing], steeper[~closing])
        - (steeper[closing])
    )
    ahead, height = np.transpose(
        [section.quarter_chord(angle) for section, angle in zip(sections, beta, strict=True)]
    )
    # The same row has no cross-section; the last one before it stands for it.
    area = np.interp(
        table.radius,
        table.radius[~closing],
        table.cross_section[~closing] / table.chord[~closing] ** 2,
    )
    scaled = any(airfoil in _ALL_ORDINATES_SCALED for _, airfoil in airfoils)
    return Propeller(
        name=name,
        diameter=2.0 * float(tip),
        n_blades=table.n_blades,
        r_over_R=table.radius / tip,
        c_over_R=np.where(closing, np.maximum(table.chord / tip, _TIP_CHORD), table.chord / tip),
        beta_deg=np.degrees(beta),
        airfoils=airfoils,
        thickness_over_chord=table.thickness_ratio,
        sweep_over_R=-ahead / tip,
        rake_over_R=height / tip,
        camber_over_chord=np.array([s.camber.max() for s in sections]) if scaled else None,
        area_over_c2=area,
        youngs_modulus=table.modulus,
        material_density=table.density,
        source=f"the maker's table, {table.title}: chord, twist, thickness, sweep, height, "
        "airfoils; blade angle of the chord line from TWIST, PRATHER and the sections' shape",
    )


class _Section:
    """The section of one station, blended and scaled as the maker does it."""

    def __init__(
        self, table: Pe0Table, airfoils: tuple[tuple[float, str], ...], station: int
    ) -> None:
        self._table, self._station = table, station
        r = table.radius[station] / table.radius[-1]
        positions = [position for position, _ in airfoils]
        shares = [float(np.interp(r, positions, unit)) for unit in np.eye(len(positions))]
        sections = [find_airfoil(name) for _, name in airfoils]
        ratio = table.thickness_ratio[station]
        thickness = _sum(shares, [section.thickness for section in sections])
        self.thickness = thickness * (ratio / thickness.max())
        self.camber = _sum(shares, [_camber(section, ratio) for section in sections])

    @property
    def beta(self) -> float:
        """Angle of the chord line from the rotor plane [rad]."""
        table, i = self._table, self._station
        twist = float(np.radians(table.twist_deg[i]))
        gauge = np.arctan2(table.pitch_prather[i], 2.0 * np.pi * table.radius[i])
        to_upper = twist + chord_from_parting_line(self.camber, self.thickness, twist)
        to_lower = float(gauge) + chord_from_flat_bottom(self.camber, self.thickness)
        return 0.5 * (to_upper + max(to_upper, to_lower))

    def quarter_chord(self, beta: float) -> tuple[float, float]:
        """Distance of the quarter chord ahead of the radial line, and its height [m]."""
        table, i = self._table, self._station
        x = np.concatenate([CHORD_FRACTION, CHORD_FRACTION]) - _QUARTER
        half = 0.5 * self.thickness
        z = np.concatenate([self.camber + half, self.camber - half])
        ahead = np.max(-x * np.cos(beta) - z * np.sin(beta))
        above = np.max(-x * np.sin(beta) + z * np.cos(beta))
        chord = table.chord[i]
        return float(table.sweep[i] - chord * ahead), float(table.z_high[i] - chord * above)


def _sum(shares: list[float], lines: list[FloatArray]) -> FloatArray:
    """Blend of lines."""
    blend: FloatArray = np.tensordot(shares, lines, axes=1)
    return blend


def _camber(section: Airfoil, ratio: float) -> FloatArray:
    """Camber line of an airfoil that the maker has scaled to a thickness ratio."""
    if section.name in _ALL_ORDINATES_SCALED:
        return section.camber * (ratio / section.max_thickness)
    return section.camber


def _airfoils(table: Pe0Table) -> tuple[tuple[float, str], ...]:
    """The airfoils' transition as pairs of r/R and our names."""
    tip = float(table.radius[-1])
    names = []
    for _, name in table.airfoils:
        if name not in _AIRFOILS:
            raise PropellerError(
                f"airfoil '{name}' is not known; known are {', '.join(_AIRFOILS)}: write a "
                "propeller file (TOML) with an airfoil or a .dat file in its place"
            )
        names.append(_AIRFOILS[name])
    (start, end), (first, second) = (radius for radius, _ in table.airfoils), names
    if first == second or start >= tip:
        return ((1.0, first),)
    if not 0.0 <= start < end <= tip * (1.0 + 1e-9):
        raise PropellerError(
            f"the airfoils' transition must run outward on the blade; it runs from r/R "
            f"{start / tip:.4g} to {end / tip:.4g}"
        )
    return ((start / tip, first), (min(end / tip, 1.0), second))

"""Propeller: what a user describes, checked, read from and written to TOML."""

from __future__ import annotations

import dataclasses
import difflib
import os
import tomllib
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt
import tomli_w

from propmdao import description_checks as checks
from propmdao.catalog import catalog_names, propeller_file
from propmdao.description_checks import PropellerError
from propmdao.geometry.airfoil_library import find_airfoil

FloatArray = npt.NDArray[np.float64]


__all__ = ["DISTRIBUTIONS", "Propeller", "PropellerError", "load_propeller"]

#: Station arrays of a propeller, in the order of its file.
DISTRIBUTIONS = (
    "r_over_R",
    "c_over_R",
    "beta_deg",
    "thickness_over_chord",
    "sweep_over_R",
    "rake_over_R",
)


@dataclasses.dataclass(frozen=True, eq=False)
class Propeller:
    """A propeller as it is described: stations, sections, blades.

    A changed propeller is ``dataclasses.replace(propeller, beta_deg=propeller.beta_deg + 1)``.

    Attributes
    ----------
    name : str
        What it is called.
    diameter : float
        Tip to tip [m].
    n_blades : int
        Number of blades, at least 1.
    r_over_R : (n_stations,) array
        Stations, rising; the last is the tip, 1.
    c_over_R, beta_deg : (n_stations,) arrays
        Chord over tip radius and blade angle from the rotor plane [deg].
    airfoils : sequence of (float, str)
        r/R and airfoil (catalogue name, "naca4412" or a .dat path), rising in r/R; blended
        linearly between, held constant beyond.
    thickness_over_chord : (n_stations,) array, optional
        Maximum thickness over chord; by default that of the airfoils.
    sweep_over_R : (n_stations,) array or number, optional
        Quarter chord aft (against rotation) of the radial line, 0 by default.
    rake_over_R : (n_stations,) array or number, optional
        Quarter chord toward thrust of the rotor plane, 0 by default.
    source : str
        Where the numbers come from.

    Raises
    ------
    PropellerError
        If a value is missing, not finite, out of range or an airfoil is unknown.
    """

    name: str
    diameter: float
    n_blades: int
    r_over_R: FloatArray
    c_over_R: FloatArray
    beta_deg: FloatArray
    airfoils: Sequence[tuple[float, str]]
    thickness_over_chord: FloatArray | None = None
    sweep_over_R: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(()))
    rake_over_R: FloatArray = dataclasses.field(default_factory=lambda: np.zeros(()))
    source: str = ""

    def __post_init__(self) -> None:
        for key in ("name", "source"):
            if not isinstance(getattr(self, key), str):
                raise PropellerError(f"{key} must be text; it is {getattr(self, key)!r}")
        # The attribute of a frozen dataclass can only be set this way.
        object.__setattr__(self, "diameter", checks.number("diameter", self.diameter))
        if not self.diameter > 0.0:
            raise PropellerError(f"diameter must be positive [m]; it is {self.diameter}")
        if not isinstance(self.n_blades, int | np.integer) or isinstance(self.n_blades, bool):
            raise PropellerError(f"n_blades must be a whole number; it is {self.n_blades!r}")
        if self.n_blades < 1:
            raise PropellerError(f"n_blades must be at least 1; it is {self.n_blades}")

        r = checks.stations(self.r_over_R)
        object.__setattr__(self, "r_over_R", r)
        for key in DISTRIBUTIONS[1:]:
            value = getattr(self, key)
            if key == "thickness_over_chord" and value is None:
                continue
            if key in ("sweep_over_R", "rake_over_R") and np.ndim(value) == 0:
                value = np.full(r.size, checks.number(key, value))
            object.__setattr__(self, key, checks.distribution(key, value, r))
        chord, beta, thickness = self.c_over_R, self.beta_deg, self.thickness_over_chord
        checks.require("c_over_R", "be positive", chord > 0.0, chord, r)
        checks.require("beta_deg", "be within -90..90", np.abs(beta) <= 90.0, beta, r)
        if thickness is not None:
            holds = (thickness > 0.0) & (thickness < 1.0)
            checks.require("thickness_over_chord", "be above 0 and below 1", holds, thickness, r)
        object.__setattr__(self, "airfoils", checks.airfoil_pairs(self.airfoils))

    def sections(self) -> tuple[FloatArray, FloatArray]:
        """Blend the airfoils to the stations, linearly in r/R.

        Returns
        -------
        camber, thickness : (n_stations, n_chord) arrays
            Camber line and full thickness over chord, on
            `propmdao.geometry.airfoil.CHORD_FRACTION`; the thickness is that of the airfoils, not
            scaled to `thickness_over_chord`.
        """
        airfoils = [find_airfoil(name) for _, name in self.airfoils]
        positions = [position for position, _ in self.airfoils]
        weights = np.stack(
            [np.interp(self.r_over_R, positions, unit) for unit in np.eye(len(airfoils))], axis=1
        )
        camber = weights @ np.stack([airfoil.camber for airfoil in airfoils])
        return camber, weights @ np.stack([airfoil.thickness for airfoil in airfoils])

    @classmethod
    def from_toml(cls, path: str | os.PathLike[str]) -> Propeller:
        """Read a propeller file.

        Parameters
        ----------
        path : path
            TOML file; .dat paths in it are relative to its folder.

        Returns
        -------
        Propeller
            The propeller.

        Raises
        ------
        PropellerError
            If the file cannot be read, is no TOML, lacks a key, has an unknown one or holds a
            value out of range; the message begins with the file.
        """
        path = Path(path)
        try:
            text = path.read_text(encoding="utf-8")
        except OSError as error:
            raise PropellerError(f"{path}: cannot be read: {error.strerror}") from error
        except UnicodeDecodeError as error:
            raise PropellerError(f"{path}: is not text in UTF-8") from error
        return _from_text(text, str(path), path.parent)

    def to_toml(self, path: str | os.PathLike[str]) -> None:
        """Write a propeller file that `from_toml` reads back to the same propeller.

        Parameters
        ----------
        path : path
            Where to write; .dat files in its folder or below are named relative to it.
        """
        folder = Path(path).absolute().parent
        lines = [tomli_w.dumps({"name": self.name, "diameter": self.diameter}).rstrip()]
        lines.append(f"n_blades = {self.n_blades}")
        for key in DISTRIBUTIONS:
            values = getattr(self, key)
            if values is None or (key in ("sweep_over_R", "rake_over_R") and not values.any()):
                continue
            lines.append(f"{key} = [{', '.join(repr(float(value)) for value in values)}]")
        tables = []
        for position, name in self.airfoils:
            if name.endswith(".dat"):
                absolute = Path(name).absolute()
                inside = absolute.is_relative_to(folder)
                name = str(absolute.relative_to(folder) if inside else absolute)
            entry = tomli_w.dumps({"airfoil": name}).rstrip()
            tables.append(f"{{ r_over_R = {position}, {entry} }}")
        lines.append(f"airfoils = [ {', '.join(tables)} ]")
        lines.append(tomli_w.dumps({"source": self.source}))
        Path(path).write_text("\n".join(lines), encoding="utf-8")


def load_propeller(name_or_path: str | os.PathLike[str]) -> Propeller:
    """Get a propeller from the catalogue or from a file.

    Parameters
    ----------
    name_or_path : str or path
        A name of `propmdao.catalog.catalog_names`, or the path of a TOML file.

    Returns
    -------
    Propeller
        The propeller.

    Raises
    ------
    PropellerError
        If there is none of that name (the message lists near ones) or its file is wrong.
    """
    known = catalog_names()
    name = os.fspath(name_or_path)
    if name in known:
        file = propeller_file(name)
        return _from_text(file.read_text(encoding="utf-8"), file.name, None)
    if name.endswith(".toml") or Path(name).is_file():
        return Propeller.from_toml(name)
    near = difflib.get_close_matches(name.lower(), known, cutoff=0.4) or known
    raise PropellerError(
        f"unknown propeller '{name}'; near: {', '.join(near)}; `propmdao list` shows the "
        "catalogue, or give the path of a .toml file"
    )


def _from_text(text: str, label: str, folder: Path | None) -> Propeller:
    """Build a propeller from TOML text; errors begin with the label."""
    try:
        data = tomllib.loads(text)
    except tomllib.TOMLDecodeError as error:
        raise PropellerError(f"{label}: is not valid TOML: {error}") from error
    fields = dataclasses.fields(Propeller)
    keys = [field.name for field in fields]
    for key in data:
        if key not in keys:
            near = difflib.get_close_matches(key, keys, n=1)
            hint = f"did you mean '{near[0]}'?" if near else f"known: {', '.join(keys)}"
            raise PropellerError(f"{label}: unknown key '{key}'; {hint}")
    for key in ("name", "diameter", "n_blades", "r_over_R", "c_over_R", "beta_deg", "airfoils"):
        if key not in data:
            raise PropellerError(f"{label}: missing key '{key}'")
    data["airfoils"] = _airfoil_tables(label, data["airfoils"], folder)
    try:
        return Propeller(**data)
    except PropellerError as error:
        raise PropellerError(f"{label}: {error}") from error


def _airfoil_tables(label: str, tables: Any, folder: Path | None) -> list[tuple[float, str]]:
    """Read airfoils = [{r_over_R, airfoil}, ...]; .dat paths become relative to the folder."""
    pairs = []
    for table in tables if isinstance(tables, list) else [tables]:
        if not isinstance(table, dict) or set(table) != {"r_over_R", "airfoil"}:
            raise PropellerError(
                f'{label}: airfoils must be a list of {{ r_over_R = 0.15, airfoil = "e63" }}; '
                f"got {table!r}"
            )
        name = table["airfoil"]
        if folder is not None and isinstance(name, str) and name.endswith(".dat"):
            name = str(folder / name)
        pairs.append((table["r_over_R"], name))
    return pairs

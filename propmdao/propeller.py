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

from propmdao.catalog import catalog_names, propeller_file
from propmdao.geometry.airfoil import AirfoilError
from propmdao.geometry.airfoil_library import find_airfoil

FloatArray = npt.NDArray[np.float64]


class PropellerError(ValueError):
    """A propeller's description is wrong or cannot be found; the message is one line."""


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
        Number of blades, one allowed.
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
        _set(self, "diameter", _number("diameter", self.diameter))
        if not self.diameter > 0.0:
            raise PropellerError(f"diameter must be positive [m]; it is {self.diameter:g}")
        if not isinstance(self.n_blades, (int, np.integer)) or isinstance(self.n_blades, bool):
            raise PropellerError(f"n_blades must be a whole number; it is {self.n_blades!r}")
        if self.n_blades < 1:
            raise PropellerError(f"n_blades must be at least 1; it is {self.n_blades}")
        for key in ("name", "source"):
            if not isinstance(getattr(self, key), str):
                raise PropellerError(f"{key} must be text; it is {getattr(self, key)!r}")

        r = _distribution("r_over_R", self.r_over_R)
        if r.size < 2:
            raise PropellerError(f"r_over_R must hold at least 2 stations; it holds {r.size}")
        _set(self, "r_over_R", r)
        for key in DISTRIBUTIONS[1:]:
            value = getattr(self, key)
            if key == "thickness_over_chord" and value is None:
                continue
            if np.ndim(value) == 0 and key in ("sweep_over_R", "rake_over_R"):
                value = np.full(r.size, _number(key, value))
            _set(self, key, _distribution(key, value, r))
        _check_ranges(self)
        _set(self, "airfoils", _airfoils(self.airfoils))

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
            if name.endswith(".dat") and Path(name).absolute().is_relative_to(folder):
                name = str(Path(name).absolute().relative_to(folder))
            entry = tomli_w.dumps({"airfoil": name}).rstrip()
            tables.append(f"    {{ r_over_R = {position!r}, {entry} }},\n")
        lines.append(f"airfoils = [\n{''.join(tables)}]")
        lines.append(tomli_w.dumps({"source": self.source}))
        Path(path).write_text("\n".join(lines), encoding="utf-8")


#: Station arrays of a propeller, in the order of its file.
DISTRIBUTIONS = (
    "r_over_R",
    "c_over_R",
    "beta_deg",
    "thickness_over_chord",
    "sweep_over_R",
    "rake_over_R",
)


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


def _set(propeller: Propeller, key: str, value: object) -> None:
    """Set a field of the frozen dataclass while it is being made."""
    object.__setattr__(propeller, key, value)


def _number(key: str, value: Any) -> float:
    """Return a finite number or say what it is instead."""
    try:
        number = float(value)
    except (TypeError, ValueError):
        raise PropellerError(f"{key} must be a number; it is {value!r}") from None
    if isinstance(value, (str, bool)) or not np.isfinite(number):
        raise PropellerError(f"{key} must be a finite number; it is {value!r}")
    return number


def _distribution(key: str, values: Any, r: FloatArray | None = None) -> FloatArray:
    """Return a read-only array of finite numbers, one for each station."""
    try:
        array = np.array(values, dtype=float)
    except (TypeError, ValueError):
        raise PropellerError(f"{key} must be a list of numbers; it is {values!r}") from None
    if array.ndim != 1:
        raise PropellerError(f"{key} must be a list of numbers; it is {values!r}")
    if r is not None and array.size != r.size:
        raise PropellerError(f"{key} has {array.size} values for {r.size} stations of r_over_R")
    _require(key, "be finite", np.isfinite(array), array, r)
    array.setflags(write=False)
    return array


def _require(
    key: str, what: str, holds: npt.NDArray[np.bool_], values: FloatArray, r: FloatArray | None
) -> None:
    """Raise for the first station where a condition does not hold."""
    if not holds.all():
        i = int(np.argmin(holds))
        where = "" if r is None else f" (r/R {r[i]:g})"
        raise PropellerError(f"{key} must {what}; station {i + 1}{where} has {values[i]:g}")


def _check_ranges(propeller: Propeller) -> None:
    """Raise for the first value out of range."""
    r, chord, beta = propeller.r_over_R, propeller.c_over_R, propeller.beta_deg
    _require("r_over_R", "be above 0 and at most 1", (r > 0.0) & (r <= 1.0), r, None)
    rising = np.append(True, np.diff(r) > 0.0)
    _require("r_over_R", "rise from station to station", rising, r, None)
    if r[-1] != 1.0:
        # The diameter says where the tip is; a blade that ends before it contradicts itself.
        raise PropellerError(f"r_over_R must end at the tip, 1; the last station has {r[-1]:g}")
    _require("c_over_R", "be positive", chord > 0.0, chord, r)
    _require("beta_deg", "be within -90..90", np.abs(beta) <= 90.0, beta, r)
    thickness = propeller.thickness_over_chord
    if thickness is not None:
        holds = (thickness > 0.0) & (thickness < 1.0)
        _require("thickness_over_chord", "be above 0 and below 1", holds, thickness, r)


def _airfoils(pairs: Any) -> tuple[tuple[float, str], ...]:
    """Return checked (r/R, airfoil) pairs, rising in r/R, each airfoil known."""
    checked: list[tuple[float, str]] = []
    for pair in pairs:
        try:
            position, name = pair
        except (TypeError, ValueError):
            raise PropellerError(f"airfoils must be (r/R, airfoil) pairs; got {pair!r}") from None
        position = _number("r_over_R of an airfoil", position)
        if not 0.0 <= position <= 1.0:
            raise PropellerError(
                f"r_over_R of airfoil {name!r} must be in 0..1; it is {position:g}"
            )
        if checked and position <= checked[-1][0]:
            raise PropellerError(
                f"airfoils must rise in r_over_R; {name!r} at {position:g} follows {checked[-1][0]:g}"
            )
        if not isinstance(name, str):
            raise PropellerError(f"airfoil at r/R {position:g} must be a name; it is {name!r}")
        try:
            find_airfoil(name)
        except AirfoilError as error:
            raise PropellerError(str(error)) from error
        checked.append((position, name))
    if not checked:
        raise PropellerError("airfoils must name at least one airfoil")
    return tuple(checked)

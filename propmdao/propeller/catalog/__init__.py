"""Propellers, airfoils and motors that ship with propmdao: names, and where their files are."""

from __future__ import annotations

from importlib.resources import files
from importlib.resources.abc import Traversable

_FOLDER = files(__name__)


def catalog_names() -> list[str]:
    """List the propellers of the catalogue by name, sorted.

    Returns
    -------
    list of str
        Names that `propmdao.formats.propellers.load_propeller` takes.
    """
    return _names("propellers")


def airfoil_names() -> list[str]:
    """List the airfoils of the catalogue by name, sorted; NACA 4-digit sections need no file.

    Returns
    -------
    list of str
        Names that a propeller file may give an airfoil, beside "naca4412" and .dat paths.
    """
    return _names("airfoils")


def propeller_file(name: str) -> Traversable:
    """Get the TOML file of a propeller of the catalogue.

    Parameters
    ----------
    name : str
        Name of the propeller, one of `catalog_names`.

    Returns
    -------
    Traversable
        The file.
    """
    return _FOLDER / "propellers" / f"{name}.toml"


def airfoil_file(name: str) -> Traversable:
    """Get the TOML file of an airfoil of the catalogue.

    Parameters
    ----------
    name : str
        Name of the airfoil, one of `airfoil_names`.

    Returns
    -------
    Traversable
        The file: name, source, and camber and full thickness over chord on
        `propmdao.propeller.airfoils.airfoil.CHORD_FRACTION`.
    """
    return _FOLDER / "airfoils" / f"{name}.toml"


def motor_file() -> Traversable:
    """Get the TOML file of the motors.

    Returns
    -------
    Traversable
        The file: a table for each motor.
    """
    return _FOLDER / "motors" / "motors.toml"


def _names(folder: str) -> list[str]:
    entries = (entry.name for entry in (_FOLDER / folder).iterdir())
    return sorted(name.removesuffix(".toml") for name in entries if name.endswith(".toml"))

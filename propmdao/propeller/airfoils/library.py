"""Airfoils by name: the catalogue, the NACA 4-digit series, coordinate files."""

from __future__ import annotations

import difflib
import functools
import tomllib
from pathlib import Path

import numpy as np

from propmdao.propeller.airfoils.airfoil import Airfoil, AirfoilError, naca4_from_name
from propmdao.propeller.airfoils.coordinate_files import read_coordinates
from propmdao.propeller.catalog import airfoil_file, airfoil_names

#: Endings of coordinate files.
COORDINATE_ENDINGS = (".dat", ".csv")


@functools.cache
def _from_catalogue(name: str) -> Airfoil:
    data = tomllib.loads(airfoil_file(name).read_text(encoding="utf-8"))
    camber, thickness = (np.array(data[key], dtype=float) for key in ("camber", "thickness"))
    return Airfoil(name, camber, thickness, data["source"])


def find_airfoil(name: str) -> Airfoil:
    """Get an airfoil by name.

    Parameters
    ----------
    name : str
        A name of the catalogue ("e63"), a NACA 4-digit name ("naca4412"), or the path of a
        coordinate file that ends in .dat or .csv.

    Returns
    -------
    Airfoil
        The section.

    Raises
    ------
    AirfoilError
        If there is no such airfoil; the message lists names that come near.
    """
    names = airfoil_names()
    if name in names:
        return _from_catalogue(name)
    if name.endswith(COORDINATE_ENDINGS):
        return read_coordinates(Path(name))
    if name.startswith("naca"):
        return naca4_from_name(name)
    near = difflib.get_close_matches(name.lower(), names) or names
    raise AirfoilError(
        f"unknown airfoil '{name}'; near: {', '.join(near)}; also 'naca4412' or a path to a .dat"
    )

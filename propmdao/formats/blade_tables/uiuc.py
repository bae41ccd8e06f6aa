"""Geometry files of the UIUC Propeller Data Site."""

from __future__ import annotations

import os
import warnings
from collections.abc import Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.blade_tables.names import LARGEST, blades_of_name, inches_of_name
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import read_text, table_rows

_INCH = 0.0254  # m
_N_BLADES = 2
_AIRFOIL = "naca4412"


def read_named_uiuc_geometry(path: str | os.PathLike[str]) -> Propeller:
    """Read chord and blade angle from a file whose name holds the diameter.

    Parameters
    ----------
    path : path
        File as `read_uiuc_geometry` takes it, named like the files of the data set:
        ``apcsf_9x4.7_geom.txt`` is 9 inches in diameter, ``da4022_9x6.75_3b.txt`` has 3 blades.

    Returns
    -------
    Propeller
        The propeller, named after the file, with two blades where its name has no other number,
        and with NACA 4412 sections. An `AssumedBladeWarning` says what was assumed.

    Raises
    ------
    PropellerError
        If the name does not hold the diameter, the file cannot be read or a value is out of range;
        the message begins with the file.
    """
    path = Path(path)
    inches, said = inches_of_name(path.stem), blades_of_name(path.stem)
    if inches is None:
        _columns(path)  # a file that is no geometry at all is refused as that
        raise PropellerError(
            f"{path}: the diameter is missing: a UIUC geometry file does not hold it, and the name "
            f"does not say it, as apcsf_9x4.7_geom.txt does in inches, up to {LARGEST:g}; rename "
            "the file, or write a propeller file (TOML), which holds diameter, blades and airfoils"
        )
    n_blades = said or _N_BLADES
    propeller = read_uiuc_geometry(
        path, diameter=inches * _INCH, n_blades=n_blades, airfoils=[(1.0, _AIRFOIL)]
    )
    blades = "" if said else f" and {_N_BLADES} blades"
    warnings.warn(
        f"{path}: assumed, for the file does not say: NACA 4412 sections from root to tip{blades}; "
        "a propeller file (TOML), which `propmdao export` writes, can hold others",
        AssumedBladeWarning,
        stacklevel=4,  # past the table of readers and `load_propeller`
    )
    return propeller


def read_uiuc_geometry(
    path: str | os.PathLike[str],
    *,
    diameter: float,
    n_blades: int,
    airfoils: Sequence[tuple[float, str]],
) -> Propeller:
    """Read chord and blade angle; what the file does not hold is given by the caller.

    Parameters
    ----------
    path : path
        Text file: a header line, which may be missing, then r/R, c/R and beta [deg], separated by
        blanks or commas.
    diameter : float
        Diameter, tip to tip [m].
    n_blades : int
        Number of blades.
    airfoils : sequence of (float, str)
        Pairs of r/R and airfoil, as in `propmdao.propeller.description.Propeller`.

    Returns
    -------
    Propeller
        The propeller, named after the file.

    Raises
    ------
    PropellerError
        If the file cannot be read or a value is out of range; the message begins with the file.
    """
    path = Path(path)
    r_over_R, c_over_R, beta_deg = _columns(path)
    try:
        return Propeller(
            name=path.stem,
            diameter=diameter,
            n_blades=n_blades,
            r_over_R=r_over_R,
            c_over_R=c_over_R,
            beta_deg=beta_deg,
            airfoils=airfoils,
            source=f"chord and blade angle: UIUC Propeller Data Site, {path.name}",
        )
    except PropellerError as error:
        raise PropellerError(f"{path}: {error}") from error


def _columns(path: Path) -> npt.NDArray[np.float64]:
    """Return r/R, c/R and beta, a row each."""
    text = read_text(path, PropellerError)
    rows = table_rows(text, 3, "three numbers r/R c/R beta", PropellerError, str(path))
    return np.array(rows).reshape(-1, 3).T

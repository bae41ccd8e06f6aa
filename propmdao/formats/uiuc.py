"""Geometry files of the UIUC Propeller Data Site."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import read_text, table_rows


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
        Tip to tip [m].
    n_blades : int
        Number of blades.
    airfoils : sequence of (float, str)
        r/R and airfoil, as in `propmdao.propeller.description.Propeller`.

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
    text = read_text(path, PropellerError)
    rows = table_rows(text, 3, "three numbers r/R c/R beta", PropellerError, str(path))
    r_over_R, c_over_R, beta_deg = np.array(rows).reshape(-1, 3).T
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

"""Geometry files of the UIUC Propeller Data Site."""

from __future__ import annotations

import os
from collections.abc import Sequence
from pathlib import Path

import numpy as np

from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller


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
    try:
        lines = path.read_text(encoding="utf-8").splitlines()
    except OSError as error:
        raise PropellerError(f"{path}: cannot be read: {error.strerror}") from error
    except UnicodeDecodeError as error:
        raise PropellerError(f"{path}: is not text in UTF-8") from error
    rows = []
    for number, line in enumerate(lines, start=1):
        if not line.strip():
            continue
        try:
            r, chord, beta = (float(field) for field in line.replace(",", " ").split())
        except ValueError:
            if number == 1:
                continue
            raise PropellerError(
                f"{path}, line {number}: three numbers r/R c/R beta expected, not '{line.strip()}'"
            ) from None
        rows.append((r, chord, beta))
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

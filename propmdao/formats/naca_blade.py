"""A propeller whose sections a design study has made: NACA 4-digit ones, as files."""

from __future__ import annotations

import dataclasses
import os
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.formats.toml_files import write_toml
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, naca4
from propmdao.propeller.description import Propeller

CAMBER_POSITION = 0.4  # of the chord; the catalogue has polars for these


def with_naca_sections(
    propeller: Propeller,
    name: str,
    r_over_R: Sequence[float],
    max_camber: npt.ArrayLike,
    thickness_over_chord: npt.ArrayLike,
    folder: str | os.PathLike[str],
    **changes: Any,
) -> Propeller:
    """Give a propeller NACA 4-digit sections and write it with them.

    Parameters
    ----------
    propeller : Propeller
        What is kept.
    name : str
        Of the new propeller and its files, ``name.toml`` and a ``.dat`` for each section.
    r_over_R : (n_sections,) sequence
        Where the sections are; linear in between.
    max_camber, thickness_over_chord : (n_sections,) arrays
        Of the sections, maximum camber at 0.4 of the chord.
    folder : path
        Where the files go.
    **changes
        Further attributes of the new propeller.

    Returns
    -------
    Propeller
        As `propmdao analyze` reads it from its file.
    """
    folder = Path(folder)
    cambers, thicknesses = (np.asarray(of, float) for of in (max_camber, thickness_over_chord))
    airfoils = []
    for r, camber, thickness in zip(r_over_R, cambers, thicknesses, strict=True):
        section = naca4(camber, CAMBER_POSITION, thickness)
        half = 0.5 * section.thickness
        x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION[1:])
        z = np.append((section.camber + half)[::-1], (section.camber - half)[1:])
        file = folder / f"{name}_{100.0 * r:.0f}.dat"
        np.savetxt(file, np.transpose([x, z]))
        airfoils.append((r, str(file)))
    new = dataclasses.replace(
        propeller,
        name=name,
        airfoils=airfoils,
        thickness_over_chord=np.interp(propeller.r_over_R, r_over_R, thicknesses),
        **changes,
    )
    write_toml(folder / f"{name}.toml", new)
    return new

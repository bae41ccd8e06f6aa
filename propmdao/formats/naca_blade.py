"""Propellers with NACA 4-digit sections that a design study has chosen, written as files."""

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
from propmdao.runtime.output_files import replacing

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
        Propeller whose other attributes are kept.
    name : str
        Name of the new propeller and of its files, ``name.toml`` and a ``.dat`` for each section.
    r_over_R : (n_sections,) sequence
        Radii of the sections; the blade is linear in between.
    max_camber, thickness_over_chord : (n_sections,) arrays
        Maximum camber, at 0.4 of the chord, and thickness of the sections over their chord.
    folder : path
        Folder for the files.
    **changes
        Further attributes of the new propeller.

    Returns
    -------
    Propeller
        The new propeller, as `propmdao analyze` reads it from its file.

    Raises
    ------
    OutputError
        If a file cannot be written.
    """
    folder = Path(folder)
    cambers, thicknesses = np.asarray(max_camber, float), np.asarray(thickness_over_chord, float)
    airfoils = []
    for r, camber, thickness in zip(r_over_R, cambers, thicknesses, strict=True):
        section = naca4(camber, CAMBER_POSITION, thickness)
        half = 0.5 * section.thickness
        x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION[1:])
        z = np.append((section.camber + half)[::-1], (section.camber - half)[1:])
        file = folder / f"{name}_{100.0 * r:.0f}.dat"
        with replacing(file) as written:
            np.savetxt(written, np.transpose([x, z]))
        airfoils.append((r, str(file)))
    new = dataclasses.replace(
        propeller,
        name=name,
        airfoils=airfoils,
        thickness_over_chord=np.interp(propeller.r_over_R, r_over_R, thicknesses),
        camber_over_chord=None,
        **changes,
    )
    write_toml(folder / f"{name}.toml", new)
    return new

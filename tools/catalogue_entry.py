"""Write a propeller of the catalogue from the maker's file.

    python tools/catalogue_entry.py FILE.PE0 NAME [SOURCE]

Writes NAME.toml into the catalogue: those stations of the file that the splines of the blade need
to give all the others, rounded to what the file holds.
"""

from __future__ import annotations

import dataclasses
import sys
from pathlib import Path

import numpy as np
from scipy.interpolate import CubicSpline

from propmdao.formats.blade_tables.pe0 import propeller_of_table
from propmdao.formats.blade_tables.pe0_table import read_pe0_table
from propmdao.formats.toml_files import write_toml
from propmdao.propeller.description import Propeller

CATALOGUE = Path(__file__).parents[1] / "propmdao" / "propeller" / "catalog" / "propellers"
#: Errors that are let pass at the stations that are left out, and digits that are kept: both about
#: those of a table to 0.0001 inches and 0.0001 degrees.
TOLERANCES = {
    "c_over_R": 3e-4, "beta_deg": 0.03, "sweep_over_R": 3e-4, "rake_over_R": 3e-4,
    "thickness_over_chord": 5e-4,
}  # fmt: skip
DIGITS = {"c_over_R": 5, "beta_deg": 3, "sweep_over_R": 5, "rake_over_R": 5,
          "thickness_over_chord": 4, "camber_over_chord": 5, "r_over_R": 5,
          "area_over_c2": 4}  # fmt: skip
#: Outside this the blade has next to no chord, and its angle and offsets count for nothing.
LAST = 0.995


def needed(propeller: Propeller) -> list[int]:
    """Stations that give the others, by adding the worst one until all are within tolerance."""
    r = propeller.r_over_R
    kept = [0, 1, int(np.searchsorted(r, 0.5)), r.size - 2, r.size - 1]
    while True:
        worst = np.zeros(r.size)
        for key, tolerance in TOLERANCES.items():
            values = getattr(propeller, key)
            linear = key == "thickness_over_chord"
            guess = np.interp(r, r[kept], values[kept]) if linear else (
                CubicSpline(r[kept], values[kept], bc_type="not-a-knot")(r)
            )  # fmt: skip
            inside = (r <= LAST) | (key == "c_over_R")
            worst = np.maximum(worst, np.where(inside, np.abs(guess - values) / tolerance, 0.0))
        if worst.max() <= 1.0:
            return kept
        kept = sorted({*kept, int(worst.argmax())})


def main(file: str, name: str, source: str) -> None:
    """Write the entry."""
    whole = propeller_of_table(read_pe0_table(file), name)
    kept = needed(whole)
    rounded = {
        key: np.round(getattr(whole, key)[kept], digits)
        for key, digits in DIGITS.items()
        if getattr(whole, key) is not None
    }
    airfoils = [(round(position, 4), airfoil) for position, airfoil in whole.airfoils]
    entry = dataclasses.replace(
        whole,
        diameter=round(whole.diameter, 7),
        youngs_modulus=whole.youngs_modulus and float(f"{whole.youngs_modulus:.4g}"),
        airfoils=airfoils,
        source=source,
        **rounded,
    )
    write_toml(CATALOGUE / f"{name}.toml", entry)
    print(f"{name}: {len(kept)} of {whole.r_over_R.size} stations")


if __name__ == "__main__":
    main(*sys.argv[1:4])

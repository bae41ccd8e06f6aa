"""Chords that zigzag from station to station are warned of, blades as they are built are not."""

from __future__ import annotations

import dataclasses
import warnings

import numpy as np
import pytest
from scipy.interpolate import CubicSpline

from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.spline_swings import ChordWarning, warn_of_swings
from propmdao.propeller.catalog import catalog_names

STATIONS = [0.25, 0.5, 0.54, 0.69, 0.75, 1.0]
ZIGZAG = [0.16, 0.29, 0.15, 0.22, 0.13, 0.06]


def test_a_zigzag_is_named_with_its_radius_and_chord() -> None:
    with pytest.warns(ChordWarning) as caught:
        warn_of_swings(STATIONS, ZIGZAG, 0.715)
    (message,) = (str(warning.message) for warning in caught)
    assert "\n" not in message
    radius = float(message.split("r/R ")[1].split(",")[0])
    chord = float(message.split("stations: ")[1].split(" mm")[0])
    assert chord == pytest.approx(715.0 * CubicSpline(STATIONS, ZIGZAG)(radius), rel=0.05)


@pytest.mark.parametrize(
    ("factor", "warned"), [(0.45, True), (0.55, False), (1.9, False), (2.1, True)]
)
def test_half_and_twice_the_chords_beside_are_the_ends(factor: float, warned: bool) -> None:
    """A spline through four points of a parabola is the parabola: between two it turns."""
    r = np.array([0.2, 0.25, 0.75, 0.8])
    chord = 0.1 * (factor + (1.0 - factor) * (r - 0.5) ** 2 / 0.25**2)
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        warn_of_swings(r, chord, 1.0)
    assert [f"{100.0 * factor:.3g} mm at r/R 0.5" in str(w.message) for w in caught] == (
        [True] if warned else []
    )


def test_no_propeller_of_the_catalogue_swings() -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error", ChordWarning)
        for name in catalog_names():
            Blade.from_propeller(load_propeller(name))


def test_a_blade_made_of_a_zigzag_warns() -> None:
    plain = load_propeller("apcsf_11x4.7")
    chord = plain.c_over_R * np.where(np.arange(plain.c_over_R.size) % 2, 1.8, 0.4)
    with pytest.warns(ChordWarning, match="the chord swings between stations"):
        Blade.from_propeller(dataclasses.replace(plain, c_over_R=chord))

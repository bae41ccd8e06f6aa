"""Chords between stations: a spline through chords that zigzag swings far beyond them."""

from __future__ import annotations

import warnings

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

#: Chord between two stations over the smaller, or below the larger, of theirs that is warned of.
SWING = 2.0
#: Radii looked at between two stations.
_N_BETWEEN = 49


class ChordWarning(UserWarning):
    """The chord between two stations is far from the chords at them."""


def warn_of_swings(r_over_R: npt.ArrayLike, chord_over_R: npt.ArrayLike, radius: float) -> None:
    """Warn where the chord between two stations is below half or above twice what it is at them.

    Parameters
    ----------
    r_over_R, chord_over_R : (n_stations,) array_like
        Radii and chords of the stations over the tip radius.
    radius : float
        Tip radius [m].

    Warns
    -----
    ChordWarning
        Once, of the swing that is largest; the message has the radius and the chord there.
    """
    stations = np.asarray(r_over_R, float)
    chords = np.asarray(chord_over_R, float)
    share = np.linspace(0.0, 1.0, _N_BETWEEN + 2)[1:-1]
    between = stations[:-1, None] + share * np.diff(stations)[:, None]
    # The interpolation of the blade, see `propmdao.geometry.blade.span_interpolation`.
    chord = CubicSpline(stations, chords)(between)
    smaller = np.minimum(chords[:-1], chords[1:])[:, None]
    larger = np.maximum(chords[:-1], chords[1:])[:, None]
    # A chord below zero swings the further, the deeper it is.
    tiny = chord < 1e-3 * smaller
    below = np.where(tiny, 1e3 * (1.0 - chord / smaller), smaller / np.where(tiny, smaller, chord))
    swing = np.maximum(below, chord / larger)
    if swing.max(initial=0.0) <= SWING:
        return
    interval, place = np.unravel_index(int(swing.argmax()), swing.shape)
    low, high = stations[interval], stations[interval + 1]
    n = int((swing.max(axis=1) > SWING).sum())
    others = "" if n == 1 else f"; it swings so in {n} intervals"
    warnings.warn(
        f"the chord swings between stations: {1e3 * radius * chord[interval, place]:.3g} mm at "
        f"r/R {between[interval, place]:.3g}, but {1e3 * radius * chords[interval]:.3g} and "
        f"{1e3 * radius * chords[interval + 1]:.3g} mm at the stations {low:g} and {high:g} "
        f"(a cubic spline goes through them){others}: smoother chords or more stations tame it",
        ChordWarning,
        stacklevel=3,
    )

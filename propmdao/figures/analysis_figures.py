"""Figures of an analysis: what its observers hear, and where the noise goes."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import numpy as np

from propmdao.acoustics.kinematics.observers import labels, point
from propmdao.acoustics.levels.decibels import level_db
from propmdao.analysis.results import MECHANISMS, Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures import acoustic_plots, directivity, plots

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def analysis_figures(
    analysis: Analysis, name: str, hemispheres: Sequence[tuple[float, float]] = ()
) -> dict[str, Figure]:
    """Draw an analysis.

    Parameters
    ----------
    analysis : Analysis
        With one observer or more.
    name : str
        Of the propeller.
    hemispheres : sequence of (radius, step_deg)
        Hemispheres below the rotor or the aircraft that are the last of its observers.

    Returns
    -------
    dict of str to Figure
        "spectrum" and "pressure" at the first observer, "third_octaves" there with broadband noise,
        "directivity" where three observers or more are at one distance and azimuth, "hemisphere"
        and "hemisphere_2" ... .

    Raises
    ------
    ValueError
        If there are no observers, or the rotor stands still.
    """
    if len(analysis.observers) == 0:
        raise ValueError("figures need observers")
    where = labels(point(*analysis.observers.T))[0]
    title = f"{name}, {analysis.rpm:.0f} rpm, {where}, {analysis.observers[0, 0]:.4g} m"
    tones = {title: analysis.tones}
    figures = {"pressure": plots.pressure(tones)}
    noise = analysis.broadband
    total = np.zeros((len(analysis.observers), BANDS_HZ.size))
    if noise is None:
        figures["spectrum"] = plots.spectrum(tones)
    else:
        total = np.asarray(noise.total)
    heard = acoustic_plots.Heard(analysis.tones, BANDS_HZ, total)
    if noise is not None:
        figures["spectrum"] = acoustic_plots.spectrum({title: heard})
        parts = {
            "total": acoustic_plots.band_levels(heard),
            "broadband": np.asarray(level_db(total[0])),
        }
        for mechanism in MECHANISMS:
            power = getattr(noise, mechanism)[0]
            parts[mechanism.replace("_", " ")] = np.asarray(level_db(power))
        figures["third_octaves"] = acoustic_plots.third_octaves(BANDS_HZ, parts)
    levels = acoustic_plots.source_levels(heard)
    if noise is None:
        del levels["broadband"]
    on_arc = _arc(analysis)
    if on_arc.size >= 3:
        elevation = analysis.observers[on_arc, 1]
        drawn = {source: level[on_arc] for source, level in levels.items()}
        figures["directivity"] = directivity.directivity(elevation, drawn)
    end = len(analysis.observers)
    for number, (radius, step) in reversed([*enumerate(hemispheres, start=1)]):
        elevation, azimuth = (np.linspace(a, b, round((b - a) / step) + 1)
                              for a, b in ((-90.0, 0.0), (0.0, 360.0)))  # fmt: skip
        start = end - elevation.size * azimuth.size
        level = levels["total"][start:end].reshape(elevation.size, azimuth.size)
        label = f"OASPL at {radius:.4g} m, {acoustic_plots.LEVEL}"
        if analysis.surroundings.level_flight:
            label += "; azimuth from the nose"
        key = "hemisphere" if number == 1 else f"hemisphere_{number}"
        figures[key] = directivity.hemisphere_map(elevation, azimuth, level, label)
        end = start
    return figures


def _arc(analysis: Analysis) -> np.ndarray:
    """Largest set of observers at one distance and azimuth, by elevation."""
    places = np.round(analysis.observers[:, [0, 2]], 9)
    _, which, counts = np.unique(places, axis=0, return_inverse=True, return_counts=True)
    chosen = np.flatnonzero(which.ravel() == np.argmax(counts))
    elevations, first = np.unique(analysis.observers[chosen, 1], return_index=True)
    return chosen[first]

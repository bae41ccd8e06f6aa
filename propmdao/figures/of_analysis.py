"""Figures of an analysis: what its observers hear, and where the noise goes."""

from __future__ import annotations

from collections.abc import Iterator
from typing import TYPE_CHECKING

import numpy as np

from propmdao.acoustics.kinematics.observers import directions, labels
from propmdao.acoustics.levels.decibels import level_db
from propmdao.analysis.results import MECHANISMS, Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.directivity import directivity, hemisphere_map
from propmdao.figures.pressure import blade_passage, pressure
from propmdao.figures.sound import Sound, band_levels, source_levels
from propmdao.figures.spectra import harmonic_spectrum, narrowband_spectrum, third_octaves
from propmdao.figures.style import LEVEL, Floats
from propmdao.records.listening import Listening

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def analysis_figures(analysis: Analysis, observer: int = 0) -> dict[str, Figure]:
    """Draw an analysis.

    Parameters
    ----------
    analysis : Analysis
        Analysis with one observer or more.
    observer : int
        Index of the observer of spectrum and pressure.

    Returns
    -------
    dict of str to Figure
        "spectrum" and "pressure" at one observer, "third_octaves" there with broadband noise,
        "directivity" of an arc of three observers or more, "hemisphere" of a hemisphere. Further
        ones are numbered: "directivity_2", "hemisphere_2" ... . Observers without groups count as
        an arc where all are at one distance and azimuth.

    Raises
    ------
    ValueError
        If there are no observers, there is no such one, or the rotor stands still.
    """
    positions = analysis.listening.observers
    if len(positions) == 0:
        raise ValueError("figures need observers")
    if not 0 <= observer < len(positions):
        raise ValueError(f"observer must be within 0 ... {len(positions) - 1}; it is {observer}")
    sound = analysis_sound(analysis)
    figures = _at_observer(analysis, sound, observer)
    levels = source_levels(sound)
    numbers = {"directivity": 0, "hemisphere": 0}
    for kind, members in _groups(analysis.listening):
        here = {source: level[members] for source, level in levels.items()}
        if kind == "arc":
            name, figure = "directivity", _arc(positions[members], here)
        elif kind == "hemisphere":
            name, figure = "hemisphere", _hemisphere(analysis.listening, members, here["total"])
        else:
            continue
        if figure is not None:
            numbers[name] += 1
            figures[name if numbers[name] == 1 else f"{name}_{numbers[name]}"] = figure
    return figures


def analysis_sound(analysis: Analysis) -> Sound:
    """Sound of an analysis at all of its observers.

    Parameters
    ----------
    analysis : Analysis
        Analysis with or without broadband noise.

    Returns
    -------
    Sound
        Tones, and broadband noise where there is any.
    """
    if analysis.broadband is None:
        return Sound.of_tones(analysis.tones)
    return Sound(analysis.tones, BANDS_HZ, np.asarray(analysis.broadband.total))


def mechanism_levels(analysis: Analysis, observer: int = 0) -> dict[str, Floats]:
    """Third octaves of an analysis by mechanism of the broadband noise.

    Parameters
    ----------
    analysis : Analysis
        Analysis with broadband noise.
    observer : int
        Index of the observer.

    Returns
    -------
    dict of str to (n_bands,) array
        Levels in the bands `propmdao.analysis.self_noise.BANDS_HZ` [dB]: "total", with the tones,
        "broadband", and each mechanism by its name.
    """
    noise = analysis.broadband
    assert noise is not None
    sound = analysis_sound(analysis)
    powers = {"broadband": sound.broadband[observer]}
    powers |= {name.replace("_", " "): getattr(noise, name)[observer] for name in MECHANISMS}
    levels = {name: np.asarray(level_db(power)) for name, power in powers.items()}
    return {"total": band_levels(sound, observer)} | levels


def _at_observer(analysis: Analysis, sound: Sound, observer: int) -> dict[str, Figure]:
    """Spectrum and pressure at one observer, and third octaves with broadband noise."""
    positions = analysis.listening.observers
    radius = directions(positions[observer]).radius
    title = (
        f"{analysis.propeller.name}, {analysis.rpm:.0f} rpm, {labels(positions)[observer]},"
        f" {radius:.4g} m"
    )
    figures = {"pressure": pressure({title: blade_passage(sound.tones, observer)})}
    if sound.has_broadband:
        figures["spectrum"] = narrowband_spectrum({title: sound}, observer)
        figures["third_octaves"] = third_octaves(BANDS_HZ, mechanism_levels(analysis, observer))
    else:
        figures["spectrum"] = harmonic_spectrum({title: sound}, observer)
    return figures


def _groups(listening: Listening) -> Iterator[tuple[str, slice]]:
    """Kind and members of each group of observers."""
    if not listening.groups:
        seen = directions(listening.observers)
        spread = max(np.ptp(seen.radius), np.ptp(seen.azimuth_deg))
        yield "arc" if spread < 1e-9 else "point", slice(0, len(listening.observers))
    start = 0
    for group in listening.groups:
        yield group.kind, slice(start, start + group.n)
        start += group.n


def _arc(positions: Floats, levels: dict[str, Floats]) -> Figure | None:
    """Polar diagram of an arc, if it has three elevations or more."""
    seen = np.round(directions(positions).elevation_deg, 9)
    elevation, rising = np.unique(seen, return_index=True)
    if elevation.size < 3:
        return None
    return directivity(elevation, {source: level[rising] for source, level in levels.items()})


def _hemisphere(listening: Listening, members: slice, level: Floats) -> Figure:
    """Map of a hemisphere, whose observers are in the order of `observers.hemisphere`."""
    # Of n elevations and 4 n - 3 azimuths: both run in the same steps, over 90 and 360 deg.
    n = round((3.0 + np.sqrt(9.0 + 16.0 * level.size)) / 8.0)
    elevation, azimuth = np.linspace(-90.0, 0.0, n), np.linspace(0.0, 360.0, 4 * n - 3)
    radius = directions(listening.observers[members.start]).radius
    label = f"OASPL at {radius:.4g} m, {LEVEL}"
    if listening.surroundings.level_flight:
        label += "; azimuth from the nose"
    return hemisphere_map(elevation, azimuth, level.reshape(n, 4 * n - 3), label)

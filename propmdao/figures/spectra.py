"""Figures of spectra: harmonics by noise source, narrow bands, third octaves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.levels.bands import bands_in_bins, tones_in_bins
from propmdao.acoustics.levels.decibels import level_db, mean_square, spl_db
from propmdao.figures.contents.palette import (
    LEVEL,
    LOWEST_LEVEL,
    MARKERS,
    RUN_COLORS,
    SOURCE_COLORS,
    Measured,
    line_colors,
    line_styles,
)
from propmdao.figures.contents.sound import Sound, amplitudes, band_edges, band_levels
from propmdao.figures.style import GRID, level_line, literal, page, rows_of_axes, say_silent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LOWEST, _HIGHEST = 50.0, 20e3  # Hz, of what is drawn


def harmonic_spectrum(sounds: Mapping[str, Sound], observer: int = 0) -> Figure:
    """Levels of the harmonics at an observer, by source of the tones.

    Parameters
    ----------
    sounds : mapping of str to Sound
        Sounds by name, one below the other; their tones are drawn.
    observer : int
        Index of the observer in each of them.

    Returns
    -------
    Figure
        Stems that start 80 dB below the loudest tone; quieter tones, and those below -100 dB, are
        not drawn.
    """
    figure, rows = rows_of_axes(len(sounds))
    loudest = max(float(np.max(spl_db(sound.tones.total[observer]))) for sound in sounds.values())
    top = 5.0 * np.ceil(max(loudest, LOWEST_LEVEL + 70.0) / 5.0 + 1.0)
    floor = max(top - 80.0, LOWEST_LEVEL)
    for axes, (name, sound) in zip(rows, sounds.items(), strict=True):
        frequency = np.asarray(sound.tones.frequency_hz)
        parts = amplitudes(sound.tones)
        colors = line_colors(parts)
        for i, (source, pressure) in enumerate(parts.items()):
            level = np.asarray(spl_db(pressure[observer]))
            drawn = level > floor
            if not drawn.any():
                continue
            beside = (i - 0.5 * (len(parts) - 1)) * 0.05 * frequency[0]
            stems = axes.stem(
                frequency[drawn] + beside, level[drawn], bottom=floor, basefmt=" ", label=source
            )
            stems.markerline.set(color=colors[source], markersize=5, marker=MARKERS[i])
            stems.stemlines.set(color=colors[source], linewidth=2.0)
        axes.set_title(f"{literal(name)}: BPF {frequency[0]:.1f} Hz", fontsize="medium", loc="left")
        axes.set(ylabel=f"SPL, {LEVEL}", ylim=(floor, top))
        if not axes.containers:
            axes.set_xlim(right=1.05 * frequency[-1])
            say_silent(axes)
    rows[-1].set_xlabel("frequency, Hz (sources side by side)")
    rows[-1].set_xlim(left=0.0)
    if rows[0].containers:
        rows[0].legend(loc="upper right", ncols=3, framealpha=0.95)
    return figure


def narrowband_spectrum(
    sounds: Mapping[str, Sound], observer: int = 0, bin_hz: float = 5.0
) -> Figure:
    """Narrowband spectrum and third octaves of tones and broadband noise.

    Parameters
    ----------
    sounds : mapping of str to Sound
        Sounds by name, one below the other. One without broadband noise has neither its line nor
        third octaves.
    observer : int
        Index of the observer in each of them.
    bin_hz : float
        Width of the bins of the narrowband spectrum [Hz].

    Returns
    -------
    Figure
        The figure, from 50 Hz to 20 kHz; levels more than 60 dB below the loudest are not drawn.
    """
    figure, rows = rows_of_axes(len(sounds))
    bins = bin_hz * np.arange(1, np.ceil(_HIGHEST * 1.2 / bin_hz))
    loudest = LOWEST_LEVEL
    for axes, (name, sound) in zip(rows, sounds.items(), strict=True):
        loudest = max(loudest, _draw_narrowband(axes, sound, observer, bins))
        bpf = sound.tones.frequency_hz[0]
        axes.set_title(f"{literal(name)}: BPF {bpf:.1f} Hz", fontsize="medium", loc="left")
        axes.set_ylabel(f"SPL, {LEVEL}")
    top = 5.0 * np.ceil(loudest / 5.0 + 0.5)
    rows[0].set_ylim(max(top - 60.0, LOWEST_LEVEL), top)
    frequency_axis(rows[-1])
    handles, names = rows[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=3, fontsize="medium")
    return figure


def _draw_narrowband(axes: Any, sound: Sound, observer: int, bins: npt.NDArray[Any]) -> float:
    """Lines of one sound, and the level of the loudest."""
    tones = mean_square(sound.tones.total[observer])
    power = np.asarray(tones_in_bins(sound.tones.frequency_hz, tones, bins))
    width = f"bins of {bins[0]:g} Hz"
    if not sound.has_broadband:
        level = np.asarray(level_db(power))
        axes.plot(bins, level, color=SOURCE_COLORS["total"], linewidth=1.0, label=f"tones, {width}")
        return float(level.max())
    noise = bands_in_bins(sound.bands_hz, sound.broadband[observer], bins)
    axes.plot(
        bins, level_db(power + noise), color=SOURCE_COLORS["total"], linewidth=1.0,
        label=f"tones and broadband noise, {width}",
    )  # fmt: skip
    axes.plot(
        bins, level_db(noise), color=SOURCE_COLORS["broadband"], linewidth=2.0,
        label=f"broadband noise, {width}",
    )  # fmt: skip
    bands, edges = band_levels(sound, observer), band_edges(sound.bands_hz)
    axes.stairs(bands, edges, baseline=None, color=RUN_COLORS[0], linewidth=2.0,
                label="third octaves, tones and broadband noise")  # fmt: skip
    return float(bands.max())


def third_octaves(
    bands_hz: npt.ArrayLike,
    levels: Mapping[str, npt.ArrayLike],
    measured: Measured | None = None,
    title: str = "",
) -> Figure:
    """Third-octave spectra, computed and measured.

    Parameters
    ----------
    bands_hz : (n_bands,) array
        Mid-band frequencies of the computed levels [Hz].
    levels : mapping of str to (n_bands,) array
        Computed band levels by name [dB]: lines.
    measured : mapping of str to (bands_hz, levels), optional
        Measured band levels by the same names: dots, joined by a thin line.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure; levels more than 60 dB below the loudest, or below -100 dB, are not drawn, nor
        named.
    """
    figure = page(7.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    measured = measured or {}
    every = [*levels.values(), *(known for _, known in measured.values())]
    top = 5.0 * np.ceil(max(LOWEST_LEVEL, *(np.max(level) for level in every)) / 5.0 + 0.5)
    floor = max(top - 60.0, LOWEST_LEVEL)
    colors, styles = line_colors(levels), line_styles(levels)
    for name, level in levels.items():
        color = colors[name]
        if np.max(level) > floor:
            axes.plot(
                np.asarray(bands_hz), np.asarray(level), styles[name], color=color,
                label=literal(name), **level_line(name),
            )  # fmt: skip
        if name in measured:
            band, known = (np.asarray(values, float) for values in measured[name])
            axes.plot(
                band, known, "o-", color=color, linewidth=0.7, label=f"{literal(name)}, measured"
            )
    axes.set(ylabel=f"band level, {LEVEL}", ylim=(floor, top))
    axes.set_title(literal(title), fontsize="medium", loc="left")
    frequency_axis(axes)
    if axes.lines:
        figure.legend(loc="outside upper center", ncols=4)
    else:
        say_silent(axes)
    return figure


def frequency_axis(axes: Any) -> None:
    """Make an axis of frequencies from 50 Hz to 20 kHz.

    Parameters
    ----------
    axes : Axes
        Axes whose horizontal axis it is.
    """
    axes.set(xscale="log", xlim=(_LOWEST, _HIGHEST), xlabel="frequency, Hz")
    ticks = [50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000]
    axes.set_xticks(ticks, [f"{tick:g}" if tick < 1000 else f"{tick // 1000}k" for tick in ticks])
    axes.set_xticks([], minor=True)

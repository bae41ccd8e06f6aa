"""Figure of the spectra of several sounds over each other: tones, narrow bands, third octaves."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np

from propmdao.acoustics.levels.bands import bands_in_bins
from propmdao.acoustics.levels.decibels import level_db, spl_db
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.palette import (
    LEVEL,
    LEVEL_DBA,
    LOWEST_LEVEL,
    MARKERS,
    Floats,
    line_colors,
    line_styles,
)
from propmdao.figures.contents.sound import Sound, band_edges, band_levels, source_levels
from propmdao.figures.spectra import frequency_axis
from propmdao.figures.style import GRID, headline, literal, page, say_silent

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_RANGE = 60.0  # dB that are drawn
_BIN_HZ = 5.0


def spectra_over_each_other(
    sounds: Mapping[str, Sound], observer: int = 0, title: str = ""
) -> Figure:
    """Tones and broadband noise, third octaves, and these A-weighted, of sounds at an observer.

    Parameters
    ----------
    sounds : mapping of str to Sound
        Sounds by name, at most `len(propmdao.figures.style.BLADE_COLORS)`.
    observer : int
        Index of the observer in each of them.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure, from 50 Hz to 20 kHz: above the tones as dots and the broadband noise in bins of
        5 Hz, then third octaves of both together, in dB and in dBA; overall levels stand in the
        legends. Levels more than 60 dB below the loudest are not drawn.
    """
    figure = page(11.0)
    rows: Any = figure.subplots(3, 1, sharex=True)
    colors, styles = line_colors(sounds), line_styles(sounds)
    lines = {name: {"color": colors[name], "linestyle": styles[name]} for name in sounds}
    _draw_tones_and_noise(rows[0], sounds, observer, lines)
    weighting = 20.0 * np.log10(np.asarray(a_weighting(BANDS_HZ)))
    for axes, a_weighted in zip(rows[1:], (False, True), strict=True):
        unit = "dBA" if a_weighted else "dB"
        levels = {}
        for name, sound in sounds.items():
            overall = source_levels(sound, a_weighted)["total"][observer]
            bands = _bands(sound, observer) + (weighting if a_weighted else 0.0)
            levels[f"{name}: {overall:.1f} {unit}"] = bands
        _draw_bands(axes, levels, list(lines.values()))
        axes.set_ylabel(f"third octaves, {LEVEL_DBA if a_weighted else LEVEL}")
    headline(figure, title)
    frequency_axis(rows[-1])
    return figure


def _draw_tones_and_noise(
    axes: Any, sounds: Mapping[str, Sound], observer: int, lines: Mapping[str, dict[str, Any]]
) -> None:
    """Tones as dots on stems, and broadband noise as lines."""
    axes.set_ylabel(f"tones; noise in bins of {_BIN_HZ:g} Hz,\n{LEVEL}")
    tones = {
        name: np.asarray(spl_db(sound.tones.total[observer])) for name, sound in sounds.items()
    }
    bins = _BIN_HZ * np.arange(1, np.ceil(24e3 / _BIN_HZ))
    noise = {
        name: np.asarray(level_db(bands_in_bins(sound.bands_hz, sound.broadband[observer], bins)))
        for name, sound in sounds.items()
        if sound.has_broadband
    }
    floor = _scale(axes, [*tones.values(), *noise.values()])
    for marker, (name, level) in zip(MARKERS, tones.items(), strict=False):
        line = lines[name]
        frequency = np.asarray(sounds[name].tones.frequency_hz)
        drawn = level > floor
        if drawn.any():
            axes.vlines(frequency[drawn], floor, level[drawn], **line, linewidth=1.2)
            axes.plot(
                frequency[drawn], level[drawn], marker, color=line["color"], markersize=6,
                label=f"{literal(name)}: BPF {frequency[0]:.1f} Hz",
            )  # fmt: skip
        if name in noise:
            axes.plot(bins, noise[name], **line, linewidth=1.8)
    _legend_or_silence(axes)


def _draw_bands(axes: Any, levels: Mapping[str, Floats], lines: list[dict[str, Any]]) -> None:
    """Steps of band levels."""
    floor = _scale(axes, list(levels.values()))
    edges = band_edges(BANDS_HZ)
    for line, (name, level) in zip(lines, levels.items(), strict=True):
        if np.max(level) > floor:
            axes.stairs(
                np.maximum(level, floor - 1.0), edges, baseline=None, label=literal(name),
                linewidth=2.0, **line,
            )  # fmt: skip
    _legend_or_silence(axes)


def _scale(axes: Any, levels: list[Floats]) -> float:
    """Scale axes to the loudest level, with room for the legend; the lowest that is drawn."""
    loudest = max(LOWEST_LEVEL, *(float(np.max(level)) for level in levels))
    floor = max(5.0 * np.ceil(loudest / 5.0) - _RANGE, LOWEST_LEVEL)
    axes.set_ylim(floor, floor + _RANGE + 5.0 * len(levels))
    axes.grid(**GRID)
    axes.set_axisbelow(True)
    return float(floor)


def _legend_or_silence(axes: Any) -> None:
    handles, names = axes.get_legend_handles_labels()
    if handles:
        axes.legend(handles, names, loc="upper right", framealpha=0.95)
    else:
        say_silent(axes)


def _bands(sound: Sound, observer: int) -> Floats:
    """Third octaves of tones and of broadband noise, if there is any [dB]."""
    if not sound.has_broadband:
        silence = np.zeros((len(sound.tones.total), BANDS_HZ.size))
        sound = Sound(sound.tones, BANDS_HZ, silence)
    return band_levels(sound, observer)

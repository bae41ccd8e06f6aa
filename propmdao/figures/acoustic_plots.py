"""Figures of what is heard: spectra, pressure, levels of a flyover.

All are 1200 pixels wide, without a display. Here are tones with broadband noise,
and measurements: dots of the colour of the line that they belong to.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.levels.bands import bands_in_bins, tones_in_bands, tones_in_bins
from propmdao.acoustics.levels.decibels import level_db, mean_square
from propmdao.acoustics.signals import Tones
from propmdao.figures.style import GRID, PART_COLORS, RUN_COLORS, page, rows_of_axes

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Colours of noise sources, in the order in which they are drawn.
SOURCE_COLORS = {
    "thickness": PART_COLORS["thickness"],
    "loading": PART_COLORS["loading"],
    "broadband": "#009E73",
    "total": PART_COLORS["total"],
}
_LOWEST, _HIGHEST = 50.0, 20e3  # Hz, of what is drawn
_HALF_BAND = 10**0.05
#: Unit of levels.
LEVEL = "dB re 20 µPa"
_OTHER_COLORS = ("#E69F00", "#CC79A7", "#56B4E9", "#8C564B", "#999999", "#F0E442")

Floats = npt.NDArray[np.float64]
#: Measured (where, level in dB) by the name of what it belongs to.
Measured = Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]]


class Heard(NamedTuple):
    """Tones and broadband noise at the same observers.

    Attributes
    ----------
    tones : Tones
        Amplitudes.
    bands_hz : (n_bands,) array
        Mid-band frequencies of neighbouring third octaves [Hz].
    broadband : (n_observers, n_bands) array
        Mean squares in them [Pa^2].
    """

    tones: Tones
    bands_hz: Floats
    broadband: Floats


def source_levels(heard: Heard) -> dict[str, Floats]:
    """Overall level of each noise source and of all together.

    Parameters
    ----------
    heard : Heard
        What is heard.

    Returns
    -------
    dict of str to (n_observers,) array
        OASPL of thickness, loading, broadband and total [dB], by the names of `SOURCE_COLORS`.
    """
    noise = heard.broadband.sum(axis=-1)
    tones = heard.tones
    energy = {
        "thickness": np.sum(np.asarray(mean_square(tones.thickness)), axis=-1),
        "loading": np.sum(np.asarray(mean_square(tones.loading)), axis=-1),
        "broadband": noise,
        "total": np.sum(np.asarray(mean_square(tones.total)), axis=-1) + noise,
    }
    return {name: np.asarray(level_db(one)) for name, one in energy.items()}


def band_levels(heard: Heard, observer: int = 0) -> Floats:
    """Third octaves of tones and broadband noise together.

    Parameters
    ----------
    heard : Heard
        What is heard.
    observer : int
        Where.

    Returns
    -------
    (n_bands,) array
        Levels [dB].
    """
    tones = mean_square(heard.tones.total[observer])
    in_bands = tones_in_bands(heard.tones.frequency_hz, tones, heard.bands_hz)
    return np.asarray(level_db(np.asarray(in_bands) + heard.broadband[observer]))


def spectrum(heard: Mapping[str, Heard], observer: int = 0, bin_hz: float = 5.0) -> Figure:
    """Narrowband spectrum and third octaves of tones and broadband noise.

    Parameters
    ----------
    heard : mapping of str to Heard
        By name, one below the other.
    observer : int
        Which of their observers.
    bin_hz : float
        Width of the bins of the narrowband spectrum [Hz].

    Returns
    -------
    Figure
        The figure, from 50 Hz to 20 kHz; levels more than 60 dB below the loudest are not drawn.
    """
    figure, rows = rows_of_axes(len(heard))
    bins = bin_hz * np.arange(1, np.ceil(_HIGHEST * 1.2 / bin_hz))
    loudest = -200.0
    for axes, (name, sound) in zip(rows, heard.items(), strict=True):
        frequency = sound.tones.frequency_hz
        tones = tones_in_bins(frequency, mean_square(sound.tones.total[observer]), bins)
        noise = bands_in_bins(sound.bands_hz, sound.broadband[observer], bins)
        axes.plot(
            bins, level_db(np.asarray(tones) + noise), color=SOURCE_COLORS["total"],
            linewidth=1.0, label=f"tones and broadband noise, bins of {bin_hz:g} Hz",
        )  # fmt: skip
        axes.plot(
            bins, level_db(noise), color=SOURCE_COLORS["broadband"], linewidth=2.0,
            label=f"broadband noise, bins of {bin_hz:g} Hz",
        )  # fmt: skip
        center, bands = sound.bands_hz, band_levels(sound, observer)
        edges = np.append(center / _HALF_BAND, center[-1] * _HALF_BAND)
        axes.stairs(bands, edges, baseline=None, color=RUN_COLORS[0], linewidth=2.0,
                    label="third octaves, tones and broadband noise")  # fmt: skip
        loudest = max(loudest, bands.max())
        axes.set_title(f"{name}: BPF {frequency[0]:.1f} Hz", fontsize="medium", loc="left")
        axes.set_ylabel(f"SPL, {LEVEL}")
    top = 5.0 * np.ceil(loudest / 5.0 + 0.5)
    rows[0].set_ylim(top - 60.0, top)
    _frequency_axis(rows[-1])
    handles, names = rows[0].get_legend_handles_labels()
    figure.legend(handles, names, loc="outside upper center", ncols=3, fontsize="medium")
    return figure


def third_octaves(
    bands_hz: npt.ArrayLike, levels: Mapping[str, npt.ArrayLike], measured: Measured | None = None
) -> Figure:
    """Third-octave spectra, computed and measured.

    Parameters
    ----------
    bands_hz : (n_bands,) array
        Mid-band frequencies of what was computed [Hz].
    levels : mapping of str to (n_bands,) array
        Computed band levels by name [dB]: lines.
    measured : mapping of str to (bands_hz, levels), optional
        By the same names: dots, joined by a thin line.

    Returns
    -------
    Figure
        The figure; levels more than 60 dB below the loudest are not drawn, nor named.
    """
    figure = page(7.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    measured = measured or {}
    every = [*levels.values(), *(known for _, known in measured.values())]
    top = 5.0 * np.ceil(max(np.max(level) for level in every) / 5.0 + 0.5)
    for name, color, level in colored(levels):
        if level.max() > top - 60.0:
            style = "-" if name in SOURCE_COLORS or not measured else "--"
            axes.plot(np.asarray(bands_hz), level, style, color=color, label=name, **_line(name))
        if name in measured:
            band, known = (np.asarray(q, float) for q in measured[name])
            axes.plot(band, known, "o-", color=color, linewidth=0.7, label=f"{name}, measured")
    axes.set(ylabel=f"band level, {LEVEL}", ylim=(top - 60.0, top))
    _frequency_axis(axes)
    figure.legend(loc="outside upper center", ncols=4)
    return figure


def pressure(
    records: Mapping[str, Mapping[str, npt.ArrayLike]], sample_rate: float, duration: float
) -> Figure:
    """Sound pressure over time.

    Parameters
    ----------
    records : mapping of str to mapping of str to (n_times,) array
        Records by name, one below the other: parts of the noise by name [Pa].
    sample_rate : float
        [Hz].
    duration : float
        How much of them is drawn [s].

    Returns
    -------
    Figure
        The figure.
    """
    figure, rows = rows_of_axes(len(records))
    shown = round(duration * sample_rate)
    for axes, (name, parts) in zip(rows, records.items(), strict=True):
        for i, (part, color, record) in enumerate(colored(parts)):
            time = 1e3 * np.arange(record.size) / sample_rate
            axes.plot(
                time[:shown], 1e3 * record[:shown], color=color, linewidth=1.0 + i, label=part
            )
        axes.set_title(name, fontsize="medium", loc="left")
        axes.set_ylabel("pressure, mPa")
        axes.margins(x=0.0)
    rows[-1].set_xlabel("time since blade 1 was at azimuth 0, ms")
    figure.legend(*rows[0].get_legend_handles_labels(), loc="outside upper right", ncols=4)
    return figure


def level_history(
    time: npt.ArrayLike,
    levels: Mapping[str, npt.ArrayLike],
    label: str,
    moments: Mapping[str, float] | None = None,
) -> Figure:
    """Levels of a flyover against time.

    Parameters
    ----------
    time : (n_times,) array
        When it is heard [s].
    levels : mapping of str to (n_times,) array
        Levels by name [dB].
    label : str
        Which level, with its unit.
    moments : mapping of str to float, optional
        Times to mark, by name [s].

    Returns
    -------
    Figure
        The figure; levels more than 60 dB below the loudest are not drawn.
    """
    figure = page(6.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    for name, color, level in colored(levels):
        axes.plot(np.asarray(time), level, color=color, label=name, **_line(name))
    for (name, moment), style in zip((moments or {}).items(), ("--", ":", "-."), strict=False):
        axes.axvline(moment, color="0.4", linestyle=style, label=name)
    top = 5.0 * np.ceil(max(np.max(level) for level in levels.values()) / 5.0 + 0.5)
    bottom = 5.0 * np.floor(min(np.min(level) for level in levels.values()) / 5.0)
    axes.set(xlabel="time, s", ylabel=label, ylim=(max(bottom, top - 60.0), top))
    axes.margins(x=0.0)
    figure.legend(loc="outside upper center", ncols=4)
    return figure


def colored(values: Mapping[str, npt.ArrayLike]) -> Iterator[tuple[str, str, Floats]]:
    """Give what is drawn its colours.

    Parameters
    ----------
    values : mapping of str to array
        By name.

    Yields
    ------
    str, str, array
        Name, colour and values: noise sources have their own colours, which others leave alone.
    """
    others = iter(_OTHER_COLORS if set(values) & set(SOURCE_COLORS) else RUN_COLORS)
    for name, of in values.items():
        yield name, SOURCE_COLORS.get(name) or next(others), np.asarray(of, float)


def _line(name: str) -> dict[str, Any]:
    """The total is broad and below all others: it is often that of its loudest part."""
    return {"linewidth": 4.0, "zorder": 1.9} if name == "total" else {"linewidth": 2.0}


def _frequency_axis(axes: Any) -> None:
    axes.set(xscale="log", xlim=(_LOWEST, _HIGHEST), xlabel="frequency, Hz")
    ticks = [50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000]
    axes.set_xticks(ticks, [f"{tick:g}" if tick < 1000 else f"{tick // 1000}k" for tick in ticks])
    axes.set_xticks([], minor=True)

"""Figures of what observers hear, and the sounds themselves, for pages."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from propmdao.acoustics.kinematics.observers import directions, on_map
from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.sounds.recordings import SAMPLE_RATE, common_full_scale
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.analysis.sounds import pressure_record
from propmdao.figures.contents.palette import (
    LEVEL,
    LEVEL_DBA,
    LOWEST_LEVEL,
    MARKERS,
    Floats,
    line_colors,
)
from propmdao.figures.contents.pressures import LOWEST_PRESSURE, blade_passage
from propmdao.figures.contents.sound import (
    amplitudes,
    analysis_sound,
    mechanism_levels,
    source_levels,
)
from propmdao.figures.contents.subjects import observer_groups
from propmdao.figures.pages.diagrams import (
    diagram,
    filled_map,
    half_circle,
    line,
    lines_of,
    over_elevation,
)
from propmdao.figures.pages.parts import Figure, Panel, Player
from propmdao.formats.wav import FULL_SCALE, flac

_LOWEST_HZ, _HIGHEST_HZ = 50.0, 20e3  # of what is drawn of bands
_RANGE = {"tones": 80.0, "bands": 60.0, "elevation": 40.0}  # dB below the loudest
_TICKS = (50, 100, 200, 500, 1000, 2000, 5000, 10000, 20000)
MOST_OBSERVERS = 8  # whose spectra a page holds
_MOST_SOUNDS = 4  # half a megabyte each


def loudest_observers(analysis: Analysis) -> list[int]:
    """Observers whose spectra a page holds: the loudest ones.

    Parameters
    ----------
    analysis : Analysis
        Analysis with observers.

    Returns
    -------
    list of int
        Indices, that of the loudest tones first, `MOST_OBSERVERS` at most.
    """
    level = np.asarray(oaspl_db(analysis.tones.total))
    return [int(i) for i in np.argsort(-level, kind="stable")[:MOST_OBSERVERS]]


def place(analysis: Analysis, observer: int) -> str:
    """Number and place of an observer in words.

    Parameters
    ----------
    analysis : Analysis
        Analysis with observers.
    observer : int
        Index of the observer.

    Returns
    -------
    str
        The words.
    """
    seen = directions(analysis.listening.observers[observer]).rounded()
    words = f"observer {observer + 1}: elevation {seen.elevation_deg:.4g}°"
    if seen.azimuth_deg and abs(seen.elevation_deg) < 90.0:
        words += f", azimuth {seen.azimuth_deg:.4g}°"
    return f"{words}, {seen.radius:.4g} m"


def at_observers(analysis: Analysis, observers: Sequence[int]) -> Figure:
    """Draw spectrum and pressure at observers, to be chosen from.

    Parameters
    ----------
    analysis : Analysis
        Analysis with observers.
    observers : sequence of int
        Indices of the observers.

    Returns
    -------
    Figure
        Tones by source, third octaves by mechanism where there is broadband noise, pressure of the
        tones over a blade passage.
    """
    panels = {}
    for observer in observers:
        drawn = [_tones({"": analysis}, observer)]
        if analysis.broadband is not None:
            drawn.append(_mechanisms(analysis, observer))
        drawn.append(_pressure(analysis, observer))
        panels[place(analysis, observer)] = drawn
    return Figure(
        "Spectrum and pressure",
        "Levels of the tones by source and harmonic, of broadband noise by mechanism, and the"
        " pressure of the tones over one blade passage",
        panels,
        choice="At",
        note="Blade 1 is at azimuth 0 at time 0. Nothing below -100 dB is drawn.",
    )


def beside(analyses: Mapping[str, Analysis], observers: Sequence[int]) -> Figure:
    """Draw tones and third octaves of several propellers at observers, to be chosen from.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, with the same observers.
    observers : sequence of int
        Indices of the observers.

    Returns
    -------
    Figure
        Tones, and third octaves of all noise where there is broadband noise.
    """
    first = next(iter(analyses.values()))
    panels = {}
    for observer in observers:
        drawn = [_tones(analyses, observer)]
        if first.broadband is not None:
            levels = {name: mechanism_levels(a, observer)["total"] for name, a in analyses.items()}
            drawn.append(_bands("third octaves of all noise", levels))
        panels[place(first, observer)] = drawn
    return Figure(
        "Spectra",
        f"Levels of the tones and third octaves of {' and '.join(analyses)}",
        panels,
        choice="At",
    )


def _tones(analyses: Mapping[str, Analysis], observer: int) -> Panel:
    """Stems of the tones: of one analysis by source, of several in all."""
    shown: dict[str, tuple[Floats, Floats]] = {}
    for name, analysis in analyses.items():
        frequency = np.asarray(analysis.tones.frequency_hz)
        parts = amplitudes(analysis.tones)
        for source, pressure in parts.items() if len(analyses) == 1 else [(name, parts["total"])]:
            shown[source] = frequency, np.asarray(spl_db(pressure[observer]))
    bottom, top = _scale([level for _, level in shown.values()], _RANGE["tones"])
    colors, data = line_colors(shown), list[dict[str, Any]]()
    apart = 0.05 * min(float(frequency[0]) for frequency, _ in shown.values())
    for i, (name, (frequency, level)) in enumerate(shown.items()):
        drawn = level > bottom
        x = frequency[drawn] + (i - 0.5 * (len(shown) - 1)) * apart
        stems = np.stack([x, x, np.full(x.size, np.nan)], axis=-1).ravel()
        ends = np.stack([np.full(x.size, bottom), level[drawn], np.full(x.size, np.nan)], axis=-1)
        data.append(
            line(stems, ends.ravel(), color=colors[name])
            | {"legendgroup": name, "showlegend": False, "hoverinfo": "skip",
               "meta": {"hidden": True}}
        )  # fmt: skip
        dots = line(frequency[drawn], level[drawn], name, color=colors[name], marker=MARKERS[i])
        dots |= {"mode": "markers", "x": [round(float(f), 3) for f in x], "legendgroup": name}
        dots["marker"] |= {"color": colors[name], "size": 8}
        data.append(dots)
    label = f"tones, {LEVEL}"
    return diagram(label, data, ("frequency, Hz", ""), {"rangemode": "tozero"},
                   {"range": [bottom, top]})  # fmt: skip


def _mechanisms(analysis: Analysis, observer: int) -> Panel:
    return _bands("third octaves by mechanism", mechanism_levels(analysis, observer))


def _bands(label: str, levels: Mapping[str, Floats]) -> Panel:
    """Third octaves over a logarithmic axis of frequency."""
    bottom, top = _scale(levels.values(), _RANGE["bands"])
    audible = {n: np.where(v > bottom, v, np.nan) for n, v in levels.items() if v.max() > bottom}
    x = {
        "type": "log",
        "range": [float(np.log10(_LOWEST_HZ)), float(np.log10(_HIGHEST_HZ))],
        "tickvals": list(_TICKS),
        "ticktext": [f"{t}" if t < 1000 else f"{t // 1000}k" for t in _TICKS],
    }
    data = lines_of(BANDS_HZ, audible)
    return diagram(f"{label}, {LEVEL}", data, ("frequency, Hz", ""), x, {"range": [bottom, top]})


def _pressure(analysis: Analysis, observer: int) -> Panel:
    record = blade_passage(analysis.tones, observer)
    parts = {
        name: 1e3 * values
        for name, values in record.parts.items()
        if np.sqrt(np.mean(np.square(values))) > LOWEST_PRESSURE
    }
    return diagram(
        "pressure of the tones, mPa",
        lines_of(1e3 * record.time, parts),
        ("time, ms", ""),
    )


def over_directions(analyses: Mapping[str, Analysis]) -> list[Figure]:
    """Draw levels over direction: of arcs of three elevations or more, and of hemispheres.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, with the same observers.

    Returns
    -------
    list of Figure
        A figure for each group of observers, in dB and in dBA. One analysis has its sources, of
        several each has its total.
    """
    first = next(iter(analyses.values()))
    levels = {unit: _over_all(analyses, unit == LEVEL_DBA) for unit in (LEVEL, LEVEL_DBA)}
    figures = []
    for kind, members in observer_groups(first.listening):
        seen = directions(first.listening.observers[members]).rounded()
        elevation, rising = np.unique(seen.elevation_deg, return_index=True)
        panels: dict[str, list[Panel]] = {}
        for unit, every in levels.items():
            here = {name: level[members] for name, level in every.items()}
            if kind == "arc" and elevation.size >= 3:
                panels[unit] = [_arc(elevation, {n: v[rising] for n, v in here.items()}, unit)]
            elif kind == "hemisphere":
                panels[unit] = [
                    _hemisphere(name, level, unit)
                    for name, level in here.items()
                    if len(analyses) > 1 or name == "total"
                ]
        if panels:
            figures.append(
                Figure(
                    f"Level over direction, {seen.radius[0]:.4g} m away",
                    "Overall level over the elevation from the rotor plane"
                    if kind == "arc"
                    else "Overall level over elevation and azimuth of the hemisphere below",
                    panels,
                    choice="Level in",
                    note="Elevation is from the rotor plane, negative on the wake's side.",
                )
            )
    return figures


def _over_all(analyses: Mapping[str, Analysis], a_weighted: bool) -> dict[str, Floats]:
    """Levels at all observers: by source of one analysis, or of each of several."""
    every = {n: source_levels(analysis_sound(a), a_weighted) for n, a in analyses.items()}
    if len(every) == 1:
        return next(iter(every.values()))
    return {name: levels["total"] for name, levels in every.items()}


def _arc(elevation: Floats, levels: Mapping[str, Floats], unit: str) -> Panel:
    bottom, top = _scale(levels.values(), _RANGE["elevation"])
    audible = {name: level for name, level in levels.items() if level.max() > LOWEST_LEVEL}
    return half_circle(f"OASPL, {unit}", over_elevation(elevation, audible, bottom), bottom, top)


def _hemisphere(name: str, level: Floats, unit: str) -> Panel:
    table = on_map(level)
    return filled_map(
        name,
        ("azimuth, deg", "elevation, deg"),
        table.azimuth_deg,
        table.elevation_deg,
        np.maximum(table.values, LOWEST_LEVEL),
        unit,
    )


def _scale(levels: Any, reach: float) -> tuple[float, float]:
    """Lowest and highest level that are drawn [dB]."""
    loudest = max(LOWEST_LEVEL + reach, *(float(np.max(level)) for level in levels))
    top = 5.0 * float(np.ceil(loudest / 5.0 + 0.2))
    return max(top - reach, LOWEST_LEVEL), top


def words_on_observers(n_shown: int, n_observers: int) -> str:
    """Sentence on whose spectra a page holds.

    Parameters
    ----------
    n_shown, n_observers : int
        Number of observers that are shown, and of all.

    Returns
    -------
    str
        The sentence.
    """
    of_whom = (
        "all observers"
        if n_shown == n_observers
        else f"the {n_shown} loudest of {n_observers} observers"
    )
    return (
        f"Spectra are those of {of_whom}, that of the loudest tones first; sounds are of the first"
        " ones, all of one full scale, so that they can be compared by ear."
    )


def players(
    analyses: Mapping[str, Analysis], observers: Sequence[int], seconds: float
) -> list[Player]:
    """Make the sounds of a page, all of one full scale, so that they can be compared by ear.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, with the same observers.
    observers : sequence of int
        Indices of the observers, of which the first ones are heard.
    seconds : float
        About how long each is [s].

    Returns
    -------
    list of Player
        Sounds observer by observer, as many as a page holds.

    Raises
    ------
    ValueError
        If the rotor stands still or the sound is too short.
    """
    observers = observers[: max(1, _MOST_SOUNDS // len(analyses))]
    records = {name: pressure_record(a, seconds, observers) for name, a in analyses.items()}
    # Straight below a steady rotor there are no tones: silence has a scale, too.
    full_scale = max(common_full_scale(*records.values()), FULL_SCALE.lowest)
    several = len(analyses) > 1
    return [
        Player(
            f"{name}, {place(analysis, observer)}" if several else place(analysis, observer),
            f"{records[name].shape[-1] / SAMPLE_RATE:.1f} s, repeated; full scale"
            f" {full_scale:g} Pa",
            flac(records[name][number], full_scale),
        )
        for number, observer in enumerate(observers)
        for name, analysis in analyses.items()
    ]

"""The page of a flyover: levels over time, what the microphone hears."""

from __future__ import annotations

from typing import Any

import numpy as np

from propmdao.acoustics.sounds.recordings import SAMPLE_RATE, common_full_scale
from propmdao.analysis.flights.flyover_results import STEP, Flight, Flyover
from propmdao.analysis.results import Analysis
from propmdao.figures.contents.doubts import doubts
from propmdao.figures.contents.palette import Floats
from propmdao.figures.contents.subjects import condition
from propmdao.figures.pages import rotor_figures, tables
from propmdao.figures.pages.analysis_page import blades_section, inputs_section
from propmdao.figures.pages.diagrams import diagram, line, lines_of
from propmdao.figures.pages.parts import Figure, Origin, Page, Player, Section, Table
from propmdao.formats.wav import FULL_SCALE, flac

_HEARD = 20.0  # s around the loudest moment: more would make a large page
_RANGE = 60.0  # dB below the loudest that are drawn


def flyover_page(
    analysis: Analysis, flight: Flight, flyover: Flyover, result: dict[str, Any], origin: Origin
) -> Page:
    """Make the page of a flyover.

    Parameters
    ----------
    analysis : Analysis
        The rotor.
    flight : Flight
        Way of the rotor past the microphone.
    flyover : Flyover
        What is heard, with its pressure record.
    result : dict
        The same with the keys of ``propmdao flyover --json``.
    origin : Origin
        Where the numbers come from.

    Returns
    -------
    Page
        The page.
    """
    name = analysis.propeller.name
    total = result["levels"]["total"]
    numbers = {
        "loudest": f"{total['lamax_dba']:.1f} dBA",
        "SEL": f"{total['sel_dba']:.1f} dBA",
        "EPNL": "none" if result["epnl"] is None else f"{result['epnl']:.1f} EPNdB",
    }
    noise: list[Any] = [_levels(result)]
    if flyover.pressure is not None:
        noise.append(_player(flyover.pressure, flyover))
    noise.append(_history(flyover))
    notes = [f"No EPNL: {result['epnl_failure']}."] if result["epnl_failure"] else []
    return Page(
        title=f"{name} past a microphone",
        subtitle=f"{condition(analysis)}, {flight.height:g} m above the ground; microphone"
        f" {flight.sideline:g} m beside the track, {flight.microphone_height:g} m high",
        doubts=doubts([result]),
        numbers=numbers | tables.first_numbers({**result, "observers": []}),
        sections=[
            Section("Noise", noise, notes),
            Section("Loads", [rotor_figures.span_loads({name: analysis})]),
            blades_section({name: analysis.changed_propeller}),
            inputs_section({name: result}),
        ],
        origin=origin,
    )


def _levels(result: dict[str, Any]) -> Table:
    """Levels by part."""
    rows = [
        [part, *(tables.level(level[key]) for key in ("lamax_dba", "sel_dba"))]
        for part, level in result["levels"].items()
    ]
    head = ["", f"loudest {STEP:g} s, dBA", "SEL, dBA"]
    return Table("Levels at the microphone, re 20 µPa and (20 µPa)² s", head, rows)


def _history(flyover: Flyover) -> Figure:
    """Levels, distance and direction over time."""
    levels = {part: flyover.level_dba(part) for part in flyover.mean_square}
    top = 5.0 * float(np.ceil(max(level.max() for level in levels.values()) / 5.0 + 0.2))
    audible = {
        part: np.where(level > top - _RANGE, level, np.nan)
        for part, level in levels.items()
        if level.max() > top - _RANGE
    }
    time = ("time since overhead, s", "")
    panels = [
        diagram(
            "level, dBA re 20 µPa", lines_of(flyover.time, audible), time, y={"rangemode": "normal"}
        )
    ]
    seen = {
        "distance, m": np.asarray(flyover.sight.distance[0]),
        "elevation from the rotor plane, deg": np.asarray(flyover.sight.elevation_deg[0]),
    }
    for label, values in seen.items():
        panels.append(diagram(label, [line(flyover.time, values, color="#0072B2")], time))
    return Figure(
        "Over time",
        "A-weighted level by source, distance and elevation of what is heard over time",
        {"all": panels},
        note=f"Steps of {STEP:g} s. Distance and elevation are of where the sound has left.",
    )


def _player(pressure: Floats, flyover: Flyover) -> Player:
    """Sound around the loudest moment."""
    loudest = int(np.argmax(flyover.level_dba()))
    middle = (loudest + 0.5) * STEP
    start = max(0, int((middle - 0.5 * _HEARD) * SAMPLE_RATE))
    heard_part = pressure[start : start + int(_HEARD * SAMPLE_RATE)]
    full_scale = max(common_full_scale(heard_part), FULL_SCALE.lowest)
    begin = float(flyover.time[0]) - 0.5 * STEP + start / SAMPLE_RATE
    return Player(
        "The microphone",
        f"{heard_part.size / SAMPLE_RATE:.1f} s, from {begin:+.1f} s of overhead on; full scale"
        f" {full_scale:g} Pa",
        flac(heard_part, full_scale),
        repeats=False,
    )

"""Tables of broadband noise for people: what makes it, and how far it is to be believed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.console import Console

from propmdao.commands.output.tables import level_cell, narrow_table, number_cell

_HEADINGS = {
    "pressure_side": "pressure\nside",
    "suction_side": "suction\nside",
    "separation": "sepa-\nration",
    "laminar_shedding": "laminar\nvortices",
    "bluntness": "blunt\nedge",
    "tip": "tip\nvortex",
    "inflow_turbulence": "inflow\nturbu-\nlence",
}
_WORDS = {
    "pressure_side": "the boundary layer of the pressure side",
    "suction_side": "the boundary layer of the suction side",
    "separation": "separation",
    "laminar_shedding": "vortices of laminar boundary layers",
    "bluntness": "the blunt trailing edge",
    "tip": "the tip vortex",
    "inflow_turbulence": "turbulence that flows in",
}
_TRIPPED = {"none": "untripped", "light": "lightly tripped", "heavy": "heavily tripped"}
_QUANTITIES = {"reynolds": "Reynolds number", "mach": "Mach number", "angle_deg": "angle, deg"}


def trip_words(model: dict[str, Any]) -> str:
    """Say how the boundary layers are tripped in broadband noise.

    Parameters
    ----------
    model : dict
        Model with broadband noise, as ``propmdao analyze --json`` writes it.

    Returns
    -------
    str
        Words that follow "blades".
    """
    noise, transition = model["noise"]["broadband"], model["loads"]["transition"]
    places = [transition[f"trip_{side}"] for side in ("upper", "lower")]
    tripped = any(place is not None and place < 1.0 for place in places)
    trip = noise["trip"] or "none"  # None of a model that is not completed
    if trip == "none" and noise["layers"] == "sections" and tripped:
        return "tripped as in the polars"
    if isinstance(trip, str):
        return _TRIPPED[trip]
    parts = [f"{words} ({trip.count(word)})" for word, words in _TRIPPED.items() if word in trip]
    return " and ".join(parts) + " stations"


def print_mechanisms(console: Console, analyses: Sequence[dict[str, Any]]) -> None:
    """Print broadband noise mechanism by mechanism, the loudest, and what is not measured.

    Parameters
    ----------
    console : Console
        Where to print.
    analyses : sequence of dict
        Results with the keys of ``propmdao analyze --json``; nothing is printed of those without
        broadband noise or observers.
    """
    places = [
        (analysis["rpm"], observer)
        for analysis in analyses
        for observer in analysis["observers"]
        if "broadband_dba" in observer
    ]
    if not places:
        return
    table = narrow_table()
    for heading in ("rpm", "elev.\ndeg", *_HEADINGS.values()):
        table.add_column(heading, justify="right")
    loudest = []
    for rpm, observer in places:
        levels = observer["broadband_dba"]
        loudest.append(max(levels, key=levels.__getitem__))
        place = number_cell(observer["elevation_deg"], ".4g")
        table.add_row(f"{rpm:.1f}", place, *(level_cell(levels[name]) for name in _HEADINGS))
    console.print("Broadband noise by mechanism, dBA:")
    console.print(table)
    first = max(dict.fromkeys(loudest), key=loudest.count)
    share = "" if len(set(loudest)) == 1 else f" at {loudest.count(first)} of {len(loudest)} places"
    console.print(f"The loudest is {_WORDS[first]}{share}.", highlight=False)
    for analysis in analyses:
        for line in _outside(analysis):
            console.print(line, highlight=False)


def _outside(analysis: dict[str, Any]) -> list[str]:
    """Sentences on what lies beyond the measurements of the model."""
    return [
        f"At {analysis['rpm']:.1f} rpm {100 * reach['outside']:.0f} % of the span is outside of"
        f" what NASA RP-1218 measured: {_QUANTITIES[name]} {reach['least']:.3g} to"
        f" {reach['largest']:.3g}, there {reach['measured'][0]:g} to {reach['measured'][1]:g}."
        for name, reach in analysis["broadband_range"].items()
        if reach["outside"] >= 0.005
    ]

"""Tables for people: bands that inputs which are not known for sure leave around numbers."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from rich.console import Console
from rich.table import Table

from propmdao.analysis.comparisons import flat_values
from propmdao.commands.output.tables import narrow_table, number_cell
from propmdao.runtime.terminal import printable

BAND = (
    "First line: with the input at its upper end, second: at its lower end. Band: root of the sum"
    " of their squares, what raises a number apart from what lowers it."
)
# Results of a band: label, formats of the number and of its changes.
_BAND_ROWS = {
    "rpm": ("rpm", ".1f", "+.1f"),
    "thrust": ("thrust, N", "#.4g", "+.3g"),
    "shaft_power": ("power, W", "#.4g", "+.3g"),
}


def print_bands(console: Console, analyses: Sequence[dict[str, Any]]) -> None:
    """Print what inputs that are not known for sure do to the numbers, where it was asked.

    Parameters
    ----------
    console : Console
        Where to.
    analyses : sequence of dict
        Results with the keys of ``propmdao analyze --json``; those without "band" are left out.
    """
    bands = [analysis for analysis in analyses if analysis.get("band")]
    for analysis in bands:
        console.print(f"Band at {analysis['rpm']:.1f} rpm: changes of the numbers", highlight=False)
        console.print(_band(analysis))
        for effect in analysis["band"]["effects"]:
            if effect["left_out"]:
                text = f"The band lacks {effect['name']}: {effect['left_out']}."
                console.print(printable(text), highlight=False)
    if bands:
        console.print(BAND)


def _band(analysis: dict[str, Any]) -> Table:
    """Changes of every number: by each input, at its upper and its lower end, and by all."""
    band, observers = analysis["band"], analysis["observers"]
    rows, numbers = [], dict[str, Any]()
    for key in band["above"]:
        if key == "spl_bpf_db":
            rows += [(f"BPF dB, {place}", ".1f", "+.2f") for place in _places(observers)]
            numbers[key] = [observer[key] for observer in observers]
        else:
            rows.append(_BAND_ROWS[key])
            numbers[key] = analysis[key]
    columns, table = [], narrow_table()
    for heading in ("", "value"):
        table.add_column(heading, justify="right" if heading else "left", no_wrap=True)
    for effect in band["effects"]:
        low, high = effect["ends"]
        # Word below word, so that the table fits a terminal of 80 characters.
        words = [*effect["name"].split(), f"{low:g} to", f"{high:g} {effect['unit']}".rstrip()]
        table.add_column("\n".join(words), justify="right", no_wrap=True)
        columns.append((effect["changes"][1], effect["changes"][0]))
    table.add_column("band", justify="right")
    columns.append((band["above"], band["below"]))
    flat = [tuple(None if end is None else flat_values(end) for end in ends) for ends in columns]
    for k, ((label, form, change), value) in enumerate(
        zip(rows, flat_values(numbers), strict=True)
    ):
        cells = (
            "\n".join("-" if end is None else number_cell(end[k], change) for end in ends)
            for ends in flat
        )
        table.add_row(label, number_cell(value, form), *cells)
    return table


def _places(observers: Sequence[dict[str, Any]]) -> list[str]:
    """What tells observers from each other in few characters."""
    keys = {"elevation_deg": "{:+.4g} deg", "azimuth_deg": "az. {:.4g}", "radius": "{:.4g} m"}
    differ = [
        key
        for key in keys
        if key == "elevation_deg" or len({observer[key] for observer in observers}) > 1
    ]
    return [", ".join(keys[key].format(observer[key]) for key in differ) for observer in observers]

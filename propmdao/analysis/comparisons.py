"""Results of several propellers side by side, to read and as CSV."""

from __future__ import annotations

import csv
import math
import os
from collections.abc import Iterable, Iterator, Mapping, Sequence
from typing import Any

import numpy as np
from rich import box
from rich.table import Table

from propmdao.acoustics.levels.decibels import energy_sum_db
from propmdao.analysis.request import Request
from propmdao.analysis.results import Analysis
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.output_files import replacing
from propmdao.runtime.terminal import plain_console

Row = tuple[str, str, str]
Cell = float | str | None
Rows = list[tuple[str, ...]]  # rows of a table, its head first

#: Rows of an operating point and the levels at one observer: label, key, format.
ROWS: tuple[Row, ...] = (
    ("rotation speed, rpm", "rpm", ".0f"),
    ("thrust, N", "thrust", ".2f"),
    ("torque, N m", "torque", ".5f"),
    ("CT", "CT", ".4f"),
    ("CQ", "CQ", ".5f"),
    ("OASPL thickness, dB", "oaspl_thickness_db", ".2f"),
    ("OASPL loading, dB", "oaspl_loading_db", ".2f"),
    ("OASPL total, dB", "oaspl_db", ".2f"),
    ("SPL at BPF, dB", "spl_bpf_db", ".2f"),
    ("BPF, Hz", "bpf_hz", ".1f"),
)


def at_observer(analysis: Analysis, observer: int = 0) -> dict[str, float]:
    """Flatten an analysis to the numbers that `ROWS` names.

    Parameters
    ----------
    analysis : Analysis
        Result of `propmdao.analysis.single_point.analyze`, with observers.
    observer : int
        Index of the observer.

    Returns
    -------
    dict of str to float
        Numbers by the keys of ``propmdao analyze --json``, and ``bpf_hz``.
    """
    values = analysis.to_dict()
    levels = values.pop("observers")[observer]
    values |= levels | {"bpf_hz": levels["harmonics"][0]["frequency_hz"]}
    return {key: value for key, value in values.items() if isinstance(value, float)}


#: Rows of an operating point: label, key, format.
OPERATION: tuple[Row, ...] = (
    ("rotation speed, rpm", "rpm", ".1f"),
    ("thrust, N", "thrust", ".4f"),
    ("torque, N m", "torque", ".5f"),
    ("shaft power, W", "shaft_power", ".3f"),
    ("efficiency", "eta", ".4f"),
    ("figure of merit", "figure_of_merit", ".4f"),
    ("helical tip Mach number", "tip_mach", ".4f"),
    ("CT", "CT", ".5f"),
    ("CP", "CP", ".5f"),
)
#: Levels at an observer: label, key.
LEVEL_ROWS = (
    ("tone at blade passage, dB", "spl_bpf_db"),
    ("thickness noise, dB", "oaspl_thickness_db"),
    ("loading noise, dB", "oaspl_loading_db"),
    ("tones, dB", "oaspl_db"),
    ("tones, dBA", "oaspl_dba"),
    ("broadband noise, dB", "oaspl_broadband_db"),
    ("broadband noise, dBA", "oaspl_broadband_dba"),
    ("total, dB", "oaspl_total_db"),
    ("total, dBA", "oaspl_total_dba"),
)


def operation_and_levels(
    result: Mapping[str, Any], observer: int = 0
) -> tuple[list[Row], dict[str, Cell]]:
    """Rows and numbers of a comparison: operating point, levels at an observer and over all.

    Parameters
    ----------
    result : dict
        With the keys of ``propmdao analyze --json``.
    observer : int
        Index of the observer.

    Returns
    -------
    rows : list of (label, key, format)
        Rows for `print_comparison`; levels only where there are observers, means over them (of
        the mean square) only where there are several.
    values : dict
        Numbers by the keys of the rows.
    """
    values: dict[str, Cell] = {key: result[key] for _, key, _ in OPERATION if key in result}
    state = Request.from_dict(result).point.at(result["rpm"] * RAD_PER_S)
    values["tip_mach"] = float(state.tip_mach(0.5 * _diameter(result)))
    # Efficiency is 0 in hover, the figure of merit no measure of flight.
    left_out = "figure_of_merit" if result["speed"] else "eta"
    rows = [row for row in OPERATION if row[1] != left_out]
    observers = result["observers"]
    if not observers:
        return rows, values
    place = observers[observer]
    parts = {
        f"observer {observer + 1}: {place['elevation_deg']:+.4g} deg, {place['radius']:.4g} m": (
            "at",
            place,
        )
    }
    if len(observers) > 1:
        mean = {
            key: float(energy_sum_db(np.array([each[key] for each in observers])))
            - 10.0 * math.log10(len(observers))
            for _, key in LEVEL_ROWS
            if key in place
        }
        parts[f"mean over {len(observers)} observers"] = ("mean", mean)
    for title, (prefix, levels) in parts.items():
        rows.append((title, "", ""))
        for label, key in LEVEL_ROWS:
            if key in levels:
                rows.append((f"  {label}", f"{prefix} {key}", ".2f"))
                values[f"{prefix} {key}"] = levels[key]
    return rows, values


def _diameter(result: Mapping[str, Any]) -> float:
    """Diameter that was analysed: the changed one, where it was changed [m]."""
    return float(result["change"]["diameter"] or result["propeller"]["diameter"])


def print_comparison(
    rows: Sequence[Row], columns: Mapping[str, Mapping[str, Cell]], n_changes: int = 1
) -> None:
    """Print columns of results with their change from the first.

    Parameters
    ----------
    rows : sequence of (label, key, format)
        Rows to show.
    columns : mapping of str to mapping
        Results by key, under their heading, two columns at least; a missing key leaves its cell
        empty.
    n_changes : int
        Number of columns after the first that are followed by their change from it.
    """
    # Tight, so that five columns and their labels fit a terminal of 80 characters.
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    table.add_column("", no_wrap=True)
    for heading in _headings(columns, n_changes):
        table.add_column(heading, justify="right")
    for label, form, cells in _cells(rows, columns, n_changes):
        forms = [f"+z{form}" if is_change else form for _, is_change in cells]
        table.add_row(
            label, *(_format(cell, form) for (cell, _), form in zip(cells, forms, strict=True))
        )
    plain_console().print(table, highlight=False)


def write_comparison(
    rows: Sequence[Row],
    columns: Mapping[str, Mapping[str, Cell]],
    file: str | os.PathLike[str],
    n_changes: int = 1,
) -> None:
    """Write what `print_comparison` prints to a CSV file, unrounded.

    Parameters
    ----------
    rows, columns, n_changes
        The same as there.
    file : path
        CSV file.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    headings = [heading.replace("\n", " ") for heading in _headings(columns, n_changes)]
    with replacing(file) as whole, whole.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["", *headings])
        for label, _, cells in _cells(rows, columns, n_changes):
            writer.writerow([label, *(cell for cell, _ in cells)])


def _headings(columns: Iterable[str], n_changes: int) -> list[str]:
    """Headings of the columns, with those of the changes."""
    first, *others = columns
    headings = [first]
    for number, name in enumerate(others):
        headings += [name, "change"] if number < n_changes else [name]
    return headings


def _cells(
    rows: Sequence[Row], columns: Mapping[str, Mapping[str, Cell]], n_changes: int
) -> Iterator[tuple[str, str, list[tuple[Cell, bool]]]]:
    """Label, format and cells of each row, and which of the cells are changes."""
    for label, key, form in rows:
        first, *others = (column.get(key) for column in columns.values())
        cells = [(first, False)]
        for number, value in enumerate(others):
            cells.append((value, False))
            if number < n_changes:
                known = isinstance(first, float) and isinstance(value, float)
                cells.append((value - first if known else None, True))  # type: ignore[operator]
        yield label, form, cells


def flat_values(values: Mapping[str, Any]) -> list[float]:
    """Put the numbers of a band's results into one list.

    Parameters
    ----------
    values : mapping of str to float or list of float
        Results by name, as plain numbers.

    Returns
    -------
    list of float
        The numbers in their order, those of the observers one after the other.
    """
    return [
        number
        for value in values.values()
        for number in (value if isinstance(value, list) else [value])
    ]


def side_by_side(rows: Sequence[Row], columns: Mapping[str, Mapping[str, Cell]]) -> Rows:
    """Format columns of results, for `markdown`.

    Parameters
    ----------
    rows : sequence of (label, key, format)
        Rows to show.
    columns : mapping of str to mapping
        Results by key, under their heading; a missing key leaves its cell empty.

    Returns
    -------
    list of tuple of str
        Rows of text, the head first.
    """
    table: Rows = [("", *(heading.replace("\n", " ") for heading in columns))]
    for label, key, form in rows:
        table.append((label, *(_format(column.get(key), form) for column in columns.values())))
    return table


def markdown(rows: Rows) -> str:
    """Write rows as a Markdown table, first column to the left, numbers to the right.

    Parameters
    ----------
    rows : list of tuple of str
        Rows of text, the head first, all of one length.

    Returns
    -------
    str
        Lines of the table, each with its line break.
    """
    head, *body = rows
    rule = ("---", *("---:" for _ in head[1:]))
    return "".join(f"| {' | '.join(row)} |\n" for row in (head, rule, *body))


def _format(cell: Cell, form: str) -> str:
    return "" if cell is None else format(cell, form)

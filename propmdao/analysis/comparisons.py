"""Results of several propellers side by side, to read and as CSV."""

from __future__ import annotations

import csv
import os
from collections.abc import Mapping, Sequence

from rich import box
from rich.table import Table

from propmdao.analysis.results import Analysis
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


def print_comparison(
    rows: Sequence[Row], columns: Mapping[str, Mapping[str, Cell]], file: str | os.PathLike[str]
) -> None:
    """Print columns of results with the change from the first to the second, and write them.

    Parameters
    ----------
    rows : sequence of (label, key, format)
        Rows to show.
    columns : mapping of str to mapping
        Results by key, under their heading, two columns at least; a missing key leaves its cell
        empty.
    file : path
        CSV file with the same rows and columns, unrounded.
    """
    first, second, *others = columns
    headings = [first, second, "change", *others]
    # Tight, so that five columns and their labels fit a terminal of 80 characters.
    table = Table(box=box.SIMPLE_HEAD, padding=0, show_edge=False)
    table.add_column("", no_wrap=True)
    for heading in headings:
        table.add_column(heading, justify="right")
    with replacing(file) as whole, whole.open("w", newline="", encoding="utf-8") as stream:
        writer = csv.writer(stream)
        writer.writerow(["", *(heading.replace("\n", " ") for heading in headings)])
        for label, key, form in rows:
            before, after, *rest = (columns[heading].get(key) for heading in columns)
            change = None
            if isinstance(before, float) and isinstance(after, float):
                change = after - before
            table.add_row(
                label,
                *(_format(cell, form) for cell in (before, after)),
                _format(change, f"+{form}"),
                *(_format(cell, form) for cell in rest),
            )
            writer.writerow([label, before, after, change, *rest])
    plain_console().print(table, highlight=False)


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

"""The page of a sweep: results over what varies, and its points."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np

from propmdao.figures.contents.palette import LINE_STYLES, MARKERS, RUN_COLORS, Floats
from propmdao.figures.contents.sweeps import OF_USE, SHOWN, column_label
from propmdao.figures.pages import tables
from propmdao.figures.pages.analysis_page import blades_section
from propmdao.figures.pages.diagrams import diagram, filled_map, line
from propmdao.figures.pages.parts import Figure, Origin, Page, Panel, Section, Table
from propmdao.propeller.description import Propeller
from propmdao.propeller.identity import checksum
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS, RESULTS, VARIABLES

_MOST_LINES = 5  # of values of the second variable that are lines; more are a map
_MOST_ROWS = 500  # of the table; the file has all
_DRAWN = {"thrust": "thrust, N", "shaft_power": "shaft power, W", **SHOWN}
_LEVELS = {"oaspl_total_dba": "all noise, dBA", "oaspl_dba": "tones, dBA", "oaspl_db": "tones, dB"}

Row = Mapping[str, Any]


def sweep_page(
    propeller: Propeller,
    rows: Sequence[Row],
    columns: Sequence[str],
    asked: Mapping[str, Any],
    failures: Sequence[str],
    origin: Origin,
) -> Page:
    """Make the page of a sweep.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    rows : sequence of dict
        Cells of the points that have been analysed, by column.
    columns : sequence of str
        One or two variables that vary, of `contents.sweeps.varied_columns`.
    asked : dict
        What was asked of all points, with the keys of ``propmdao analyze --json``: model and
        listening.
    failures : sequence of str
        Reasons of the points that have failed.
    origin : Origin
        Where the numbers come from.

    Returns
    -------
    Page
        The page.
    """
    described = {name: getattr(propeller, name) for name in ("name", "diameter", "n_blades")}
    described |= {"checksum": checksum(propeller), "source": propeller.source}
    over = [_figure(rows, columns)]
    noise = _noise(rows, columns)
    if noise is not None:
        over.append(noise)
    return Page(
        title=f"Sweep of {propeller.name}",
        subtitle=f"over {' and '.join(column_label(column) for column in columns)}",
        doubts=[f"Failed: {reason}" for reason in dict.fromkeys(failures)],
        numbers={
            "points": str(len(rows) + len(failures)),
            "analysed": str(len(rows)),
            "failed": str(len(failures)),
        },
        sections=[
            Section("Results", over),
            Section("Points", [_points(rows, columns)]),
            blades_section({propeller.name: propeller}),
            Section("Inputs", [tables.described(described), tables.inputs(asked)]),
        ],
        origin=origin,
    )


def _figure(rows: Sequence[Row], columns: Sequence[str]) -> Figure:
    """Thrust, power, coefficients over the variables."""
    panels = [_over(rows, columns, name, label) for name, label in _DRAWN.items()]
    return Figure(
        "Thrust, power and efficiency",
        f"{', '.join(_DRAWN.values())} over {' and '.join(map(column_label, columns))}",
        {"all": panels},
        note="Points that have failed leave gaps; in maps an efficiency below 0 is 0.",
    )


def _noise(rows: Sequence[Row], columns: Sequence[str]) -> Figure | None:
    """Levels over the variables, observer by observer; None where nobody listens."""
    places = [name.partition("@")[2] for name in rows[0] if name.startswith("oaspl_dba@")]
    if not places:
        return None
    panels = {
        place: [
            _over(rows, columns, f"{level}@{place}", label)
            for level, label in _LEVELS.items()
            if f"{level}@{place}" in rows[0]
        ]
        for place in places
    }
    return Figure(
        "Levels",
        f"Levels re 20 µPa over {' and '.join(map(column_label, columns))}",
        panels,
        choice="At (distance, elevation)",
        note="Levels re 20 µPa, rms.",
    )


def _over(rows: Sequence[Row], columns: Sequence[str], name: str, label: str) -> Panel:
    """One result over one or two variables."""
    first, second = columns[0], columns[1] if len(columns) == 2 else None
    others = [None] if second is None else sorted({float(row[second]) for row in rows})
    if len(others) > _MOST_LINES:
        assert second is not None
        return _map(rows, (first, second, name), label)
    data = []
    for k, other in enumerate(others):
        chosen = [row for row in rows if second is None or float(row[second]) == other]
        x, y = (np.array([float(row[key]) for row in chosen]) for key in (first, name))
        order = np.argsort(x)
        named = "" if second is None else f"{column_label(second)}: {other:g}"
        data.append(
            line(
                x[order], y[order], named, color=RUN_COLORS[k], marker=MARKERS[k],
                style=LINE_STYLES[(k + 1) % len(LINE_STYLES)],
            )
        )  # fmt: skip
    return diagram(label, data, (column_label(first), ""))


def _map(rows: Sequence[Row], names: tuple[str, str, str], label: str) -> Panel:
    """Filled contours over two variables."""
    first, second, name = names
    x, y = (np.array(sorted({float(row[column]) for row in rows})) for column in (first, second))
    values: Floats = np.full((y.size, x.size), np.nan)
    for row in rows:
        j, i = (int(np.searchsorted(axis, float(row[c]))) for axis, c in ((y, second), (x, first)))
        values[j, i] = float(row[name])
    if name in OF_USE:
        values = np.where(np.isnan(values), np.nan, np.maximum(values, 0.0))
    unit = label.rpartition(", ")[2] if ", " in label else ""
    return filled_map(label, (column_label(first), column_label(second)), x, y, values, unit)


def _points(rows: Sequence[Row], columns: Sequence[str]) -> Table:
    """Variables and results of the points."""
    levels = {**LEVELS, **BROADBAND_LEVELS}
    names = [*columns, *(name for name in ("rpm", "speed") if name not in columns)]
    names += [n for n in RESULTS if n in rows[0] and n not in ("converged", "failure")]
    heads = {name: _head(name) for name in names if name in rows[0]}
    for name in rows[0]:
        quantity, _, place = name.partition("@")
        if place and quantity in _LEVELS:
            heads[name] = f"{quantity.replace('_', ' ')} {place}, {levels[quantity].unit}"
    cells = [[f"{float(row[name]):.5g}" for name in heads] for row in rows[:_MOST_ROWS]]
    left_out = f", the first {_MOST_ROWS} of {len(rows)}" if len(rows) > _MOST_ROWS else ""
    return Table(f"Points{left_out}", list(heads.values()), cells, n_words=0)


def _head(name: str) -> str:
    if name in VARIABLES:
        return column_label(name)
    unit = RESULTS[name].unit.replace("*", " ")
    words = name.replace("_", " ")
    return f"{words}, {unit}" if unit else words

"""Figures of a sweep: thrust, power and efficiency over what was varied."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from propmdao.figures.contents.palette import LINE_STYLES, MARKERS, RUN_COLORS, Floats
from propmdao.figures.contents.sweeps import OF_USE, SHOWN, column_label
from propmdao.figures.style import GRID, headline, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_MOST_LINES = 5  # of values of the second variable that are lines; more are a map

Rows = Sequence[Mapping[str, float]]


def sweep_maps(rows: Rows, columns: Sequence[str], title: str = "") -> Figure:
    """Draw CT, CP, efficiency and figure of merit over one or two variables.

    Parameters
    ----------
    rows : sequence of dict
        Variables and results of the points that have been analysed, by column; points that have
        failed are not among them and leave gaps.
    columns : sequence of str
        One or two variables, of `varied_columns`.
    title : str
        Title.

    Returns
    -------
    Figure
        Lines over the first variable, one for each value of the second; a map where these are more
        than five, in which an efficiency or a figure of merit below 0 is 0.
    """
    figure = page(8.5)
    grid: Any = figure.subplots(2, 2, sharex=True)
    first, second = columns[0], columns[1] if len(columns) == 2 else None
    others = [None] if second is None else sorted({row[second] for row in rows})
    for axes, (name, label) in zip(grid.ravel(), SHOWN.items(), strict=True):
        if len(others) > _MOST_LINES:
            assert second is not None
            _draw_map(figure, axes, rows, (first, second, name), label)
            axes.set_ylabel(column_label(second))
            axes.set_title(label, fontsize="medium", loc="left")
            continue
        for k, other in enumerate(others):
            chosen = [row for row in rows if second is None or row[second] == other]
            x = np.array([row[first] for row in chosen])
            order = np.argsort(x)
            named = "" if other is None or second is None else f"{column_label(second)}: {other:g}"
            axes.plot(
                x[order], np.array([row[name] for row in chosen])[order],
                color=RUN_COLORS[k], linestyle=LINE_STYLES[(k + 1) % len(LINE_STYLES)],
                marker=MARKERS[k], markersize=4, label=named, linewidth=1.8,
            )  # fmt: skip
        axes.set_ylabel(label)
        axes.grid(**GRID)
    for axes in grid[-1]:
        axes.set_xlabel(column_label(first))
    headline(figure, title)
    if 1 < len(others) <= _MOST_LINES:
        figure.legend(*grid[0, 0].get_legend_handles_labels(), loc="outside lower center", ncols=3)
    return figure


def _draw_map(figure: Any, axes: Any, rows: Rows, names: tuple[str, str, str], label: str) -> None:
    """Filled contours with levels on them; points that have failed are left white."""
    first, second, name = names
    x, y = (np.array(sorted({row[column] for row in rows})) for column in (first, second))
    values: Floats = np.full((y.size, x.size), np.nan)
    for row in rows:
        values[np.searchsorted(y, row[second]), np.searchsorted(x, row[first])] = row[name]
    if name in OF_USE:
        values = np.maximum(values, 0.0)
    drawn = np.ma.masked_invalid(values)
    if np.ptp(drawn.compressed()) < 1e-12:  # efficiency in hover
        axes.text(0.5, 0.5, f"{label} {drawn.min():g} everywhere", ha="center",
                  transform=axes.transAxes)  # fmt: skip
        return
    filled = axes.contourf(x, y, drawn, 10, cmap="viridis")
    lines = axes.contour(x, y, drawn, 10, colors="black", linewidths=0.6)
    for text in axes.clabel(lines, fontsize="small"):
        text.set_bbox({"facecolor": "white", "alpha": 0.7, "linewidth": 0.0, "pad": 0.5})
    figure.colorbar(filled, ax=axes, label=label, format="%g")
    axes.plot(*[grid.ravel() for grid in np.meshgrid(x, y)], ".", color="white", markersize=2)

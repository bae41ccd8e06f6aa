"""Figures of how results depend on their resolution: mesh, time step, length of a run."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING

import numpy.typing as npt

from propmdao.figures.contents.palette import LINE_STYLES, RUN_COLORS
from propmdao.figures.style import GRID, headline, literal, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

LEAST_SPAN = 0.01  # of an axis over its values


def refinement(
    resolution: Sequence[float] | Sequence[str],
    panels: Mapping[str, Mapping[str, npt.ArrayLike]],
    label: str,
    title: str = "",
) -> Figure:
    """Draw results over the resolution, axes one below the other.

    Parameters
    ----------
    resolution : sequence of float or of str
        Resolutions: numbers, or names, which are drawn at equal distances.
    panels : mapping of str to mapping of str to (n,) array
        Results of each axes by their name with its unit: lines by name, the same in all of them.
        One line alone needs no name and may have an empty one.
    label : str
        Name of the resolution, with its unit.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(1.2 + 2.6 * len(panels))
    rows = figure.subplots(len(panels), 1, sharex=True, squeeze=False)[:, 0]
    for axes, (name, lines) in zip(rows, panels.items(), strict=True):
        for number, (line, values) in enumerate(lines.items()):
            axes.plot(
                list(resolution), values, marker="o", label=literal(line),
                color=RUN_COLORS[number % len(RUN_COLORS)],
                linestyle=LINE_STYLES[(number + 1) % len(LINE_STYLES)],
            )  # fmt: skip
        axes.set_ylabel(name)
        axes.grid(**GRID)
        # Numbers as they are: an offset beside the axis is overlooked, and so is how little it is
        # that rounding makes of the whole height.
        axes.ticklabel_format(axis="y", useOffset=False)
        low, high = axes.get_ylim()
        least = LEAST_SPAN * max(abs(low), abs(high))
        if high - low < least:
            axes.set_ylim(0.5 * (low + high - least), 0.5 * (low + high + least))
    if any(next(iter(panels.values()))):
        figure.legend(*rows[0].get_legend_handles_labels(), loc="outside upper right", ncols=4)
    rows[-1].set_xlabel(label)
    headline(figure, title)
    return figure

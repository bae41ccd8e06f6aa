"""Figures of a search by derivatives: how it went, and how smooth its objectives are."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import RUN_COLORS, line_colors, line_styles
from propmdao.figures.style import GRID, headline, literal, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_LEAST_VIOLATION = 1e-7


def history(
    runs: Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]],
    label: str,
    tolerance: float,
    title: str = "",
) -> Figure:
    """Objective and largest violation of a constraint over the evaluations of searches.

    Parameters
    ----------
    runs : mapping of str to (objective, violation)
        Searches by name, (n_evaluations,) arrays each: the objective, nan where the analysis
        failed, and the largest violation in driver scaling.
    label : str
        Name of the objectives with their unit, for the axis.
    tolerance : float
        Violation that counts as none.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure; dots are designs that meet all constraints. Violations below 1e-7 are drawn
        there.
    """
    figure = page(8.0)
    above, below = figure.subplots(2, 1, sharex=True)
    colors, styles = line_colors(runs), line_styles(runs)
    for name, run in runs.items():
        color, style = colors[name], styles[name]
        objective, violation = (np.asarray(values, float) for values in run)
        number = np.arange(1, objective.size + 1)
        met = violation <= tolerance
        last = f"{name}: {objective[met][-1]:.2f}" if met.any() else name
        above.plot(number, objective, style, color=color, linewidth=1.5, label=literal(last))
        above.plot(number[met], objective[met], "o", color=color, markersize=5)
        below.plot(
            number, np.clip(violation, _LEAST_VIOLATION, None), style, marker="o", color=color,
            linewidth=1.5, markersize=4,
        )  # fmt: skip
    below.axhline(tolerance, color="0.4", linestyle="--", label=f"tolerance, {tolerance:g}")
    below.set(yscale="log", ylabel="largest constraint violation, scaled",
              xlabel="designs evaluated")  # fmt: skip
    above.set_ylabel(label)
    headline(figure, title)
    for axes in (above, below):
        axes.grid(**GRID)
        axes.set_axisbelow(True)
        axes.legend(loc="upper right", framealpha=0.95)
    return figure


def line_scans(
    position: npt.ArrayLike, lines: Mapping[str, npt.ArrayLike], labels: Mapping[str, str]
) -> Figure:
    """Responses along lines through a design space, and their second differences.

    Parameters
    ----------
    position : (n,) array
        Positions along each line, equally spaced.
    lines : mapping of str to (n_lines, n) array
        Values on each line, by response.
    labels : mapping of str to str
        Names of the responses with their units, for the axes.

    Returns
    -------
    Figure
        The figure, a row for each response: values on the left and on the right the size of the
        second differences, in which a jump or a kink would stand as a single high point.
    """
    position = np.asarray(position, float)
    figure = page(1.0 + 1.9 * len(lines))
    rows = figure.subplots(len(lines), 2, sharex=True, squeeze=False)
    for (left, right), (name, values) in zip(rows, lines.items(), strict=True):
        for line, color in zip(np.asarray(values, float), RUN_COLORS, strict=False):
            left.plot(position, line, color=color, linewidth=1.5)
            right.semilogy(position[1:-1], np.abs(np.diff(line, 2)), color=color, linewidth=1.0)
        left.set_ylabel(labels[name])
        for axes in (left, right):
            axes.grid(**GRID)
            axes.margins(x=0.0)
    for axes, title in zip(rows[0], ("value", "second difference, size"), strict=True):
        axes.set_title(title, fontsize="medium")
    for axes in rows[-1]:
        axes.set_xlabel("position along the line")
    figure.align_ylabels(rows[:, 0])
    return figure

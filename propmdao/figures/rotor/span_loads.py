"""Figure of the loads of a blade over its span."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from propmdao.analysis.results import Analysis
from propmdao.figures.contents.distributions import span_values
from propmdao.figures.contents.palette import Floats
from propmdao.figures.style import GRID, headline, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_COLOR = "#0072B2"


def span_loads(analysis: Analysis, title: str = "") -> Figure:
    """Draw lift, angle of attack, Reynolds number, circulation, drag and thrust over span.

    Parameters
    ----------
    analysis : Analysis
        Analysis; at an incidence means over the turn are drawn, with the range over it.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure, a dot for each strip of the lattice.
    """
    values = span_values(analysis)
    figure = page(9.5)
    grid: Any = figure.subplots(3, 2, sharex=True)
    r = np.asarray(analysis.loads.strips.r_over_R)
    for axes, (label, value) in zip(grid.ravel(), values.items(), strict=True):
        _draw(axes, r, value)
        axes.set_ylabel(label)
        axes.grid(**GRID)
    for axes in grid[-1]:
        axes.set_xlabel("r/R")
    figure.align_ylabels(grid)
    headline(figure, title)
    return figure


def _draw(axes: Any, r: Floats, over_turn: Floats) -> None:
    """Mean over the turn, and its range where it is not the same all around."""
    if len(over_turn) > 1:
        low, high = over_turn.min(axis=0), over_turn.max(axis=0)
        axes.fill_between(r, low, high, color=_COLOR, alpha=0.2, linewidth=0.0)
    axes.plot(r, over_turn.mean(axis=0), "o-", color=_COLOR, markersize=4, linewidth=1.5)
    axes.set_xlim(right=1.02)

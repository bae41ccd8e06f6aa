"""Figure of how a search converges: every design that it has tried."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import LINE_STYLES
from propmdao.figures.style import GRID, literal, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def convergence(
    objective: npt.ArrayLike,
    feasible: npt.ArrayLike,
    label: str,
    references: Mapping[str, float] | None = None,
) -> Figure:
    """All designs that a search has tried, and the best feasible one so far.

    Parameters
    ----------
    objective : (n_evaluations,) array
        Objective, which is minimised, in the order of evaluation; nan where the analysis failed.
    feasible : (n_evaluations,) bool array
        True where all constraints hold.
    label : str
        Name of the objective with its unit, for the axis.
    references : mapping of str to float, optional
        Values of the objective to compare with, by name.

    Returns
    -------
    Figure
        The figure.
    """
    objective, feasible = np.asarray(objective, float), np.asarray(feasible, bool)
    evaluation = np.arange(1, objective.size + 1)
    failed = np.isnan(objective)
    best = np.fmin.accumulate(np.where(feasible, objective, np.nan))
    figure = page(6.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    for chosen, marker, color, name in (
        (feasible & ~failed, "o", "#56B4E9", "feasible"),
        (~feasible & ~failed, "x", "#D55E00", "violates a constraint"),
    ):
        axes.scatter(
            evaluation[chosen], objective[chosen], s=14, marker=marker, color=color,
            linewidths=1.0, label=f"{literal(name)} ({chosen.sum()})",
        )  # fmt: skip
    if failed.any():
        axes.plot(
            evaluation[failed], np.full(failed.sum(), 0.015), "^", color="#CC79A7", markersize=5,
            transform=axes.get_xaxis_transform(), label=f"analysis failed ({failed.sum()})",
        )  # fmt: skip
    axes.step(evaluation, best, where="post", color="black", linewidth=2.0, label="best feasible")
    for (name, value), style in zip((references or {}).items(), LINE_STYLES, strict=False):
        axes.axhline(value, color="0.4", linestyle=style, label=f"{literal(name)}, {value:.2f}")
    axes.set(xlabel="designs evaluated", ylabel=label, xlim=(0, objective.size + 1))
    axes.legend(loc="upper right", framealpha=0.95)
    return figure

"""Figures of sections measured in wind tunnels."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import RUN_COLORS
from propmdao.figures.style import GRID, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure

Floats = npt.NDArray[np.float64]


def drag_ratios(
    cl: Floats, groups: Mapping[str, npt.NDArray[np.bool_]], ratios: Mapping[str, Floats]
) -> Figure:
    """Measured over computed drag at equal lift, over the lift coefficient.

    Parameters
    ----------
    cl : (n,) array
        Lift coefficients of the measured points.
    groups : mapping of str to (n,) array of bool
        Points that share a colour, by name, at most seven groups.
    ratios : mapping of str to (n,) array
        Ratios by the name of what was computed: axes each, side by side. Ratios that are nan are
        left out.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(5.0)
    axes_of: Any = figure.subplots(1, len(ratios), sharex=True, sharey=True, squeeze=False)[0]
    for axes, (name, ratio) in zip(axes_of, ratios.items(), strict=True):
        for (label, chosen), color in zip(groups.items(), RUN_COLORS, strict=False):
            axes.plot(cl[chosen], ratio[chosen], ".", color=color, markersize=4, label=label)
        axes.axhline(1.0, color="0.3", linewidth=1.0)
        axes.set_title(name, fontsize="medium")
        axes.set_xlabel("lift coefficient")
        axes.set_yscale("log")
        axes.set_ylim(0.4, 4.0)
        axes.set_yticks([0.5, 1.0, 2.0, 4.0], ["0.5", "1", "2", "4"])
        axes.minorticks_off()
        axes.grid(**GRID)
    axes_of[0].set_ylabel("measured over computed drag at equal lift")
    handles, labels = axes_of[0].get_legend_handles_labels()
    figure.legend(handles, labels, loc="outside upper center", ncols=len(labels))
    return figure

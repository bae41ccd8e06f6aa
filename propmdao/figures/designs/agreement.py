"""Figure of how far two models agree on many designs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from propmdao.figures.style import GRID, literal, page, run_dots

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Designs by their group, each with what either model says of it.
Groups = Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]]


def agreement(quantities: Mapping[str, Groups], models: tuple[str, str]) -> Figure:
    """What one model says of designs over what another one does, quantity by quantity.

    Parameters
    ----------
    quantities : mapping of str to mapping of str to ((n,) array, (n,) array)
        By the quantity with its unit: groups of designs, with the values of both models.
    models : (str, str)
        Names of the models; the first is on the horizontal axis.

    Returns
    -------
    Figure
        The figure; on the line both agree.
    """
    figure = page(5.5)
    every_axes = figure.subplots(1, len(quantities), squeeze=False)[0]
    for axes, (quantity, groups) in zip(every_axes, quantities.items(), strict=True):
        axes.grid(**GRID)
        for number, (name, values) in enumerate(groups.items()):
            across, up = (np.asarray(of_model, float) for of_model in values)
            axes.plot(across, up, **run_dots(number), label=literal(f"{name} ({across.size})"))
        every = np.concatenate([np.ravel(v) for pair in groups.values() for v in pair])
        ends = float(every.min()), float(every.max())
        axes.plot(ends, ends, color="0.4", linestyle="--", label="equal")
        axes.set(
            xlabel=literal(f"{quantity}, {models[0]}"), ylabel=literal(f"{quantity}, {models[1]}")
        )
    every_axes[0].legend(loc="best", framealpha=0.95)
    return figure

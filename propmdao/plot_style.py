"""What all figures share: colours, line styles, the page."""

from __future__ import annotations

from typing import Any, Literal

import numpy.typing as npt

try:
    from matplotlib.figure import Figure
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "figures need matplotlib: pip install 'propmdao[plots]'", name=error.name
    ) from None

# Okabe and Ito's palette, which colour-blind people can tell apart.
PART_COLORS = {"thickness": "#0072B2", "loading": "#D55E00", "total": "#000000"}
BLADE_COLORS = ("#777777", "#009E73", "#CC79A7", "#E69F00")
RUN_COLORS = ("#E69F00", "#009E73", "#0072B2", "#D55E00", "#CC79A7", "#000000")
LINE_STYLES = ("--", "-", "-.", ":")
GRID: dict[str, Any] = {"color": "0.9", "linewidth": 0.8}


def page(height: float, layout: Literal["constrained"] | None = "constrained") -> Figure:
    """Make a figure of 1200 pixels' width that needs no display.

    Parameters
    ----------
    height : float
        Of 10 for a square.
    layout : "constrained" or None
        How matplotlib lays it out, if it does.

    Returns
    -------
    Figure
        The figure.
    """
    return Figure(figsize=(10.0, height), dpi=120, layout=layout)


def rows_of_axes(n: int) -> tuple[Figure, npt.NDArray[Any]]:
    """Make equal axes with common scales, one below the other.

    Parameters
    ----------
    n : int
        How many.

    Returns
    -------
    Figure, (n,) array of Axes
        The figure and its axes.
    """
    figure = page(1.0 + 3.0 * n)
    rows = figure.subplots(n, 1, sharex=True, sharey=True, squeeze=False)[:, 0]
    for axes in rows:
        axes.grid(**GRID)
        axes.set_axisbelow(True)
    return figure, rows

"""What all figures share: colours, line styles, the page."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
import numpy.typing as npt

if TYPE_CHECKING:
    from matplotlib.projections.polar import PolarAxes

try:
    from matplotlib.figure import Figure
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "figures need matplotlib: pip install 'propmdao[plots]'", name=error.name
    ) from None

# Okabe and Ito's palette, which colour-blind people can tell apart.
PART_COLORS = {"thickness": "#0072B2", "loading": "#D55E00", "total": "#000000"}
BLADE_COLORS = ("#777777", "#009E73", "#CC79A7", "#E69F00")
# A blade keeps its colour where it is one of several runs.
RUN_COLORS = (*BLADE_COLORS, "#0072B2", "#D55E00", "#000000")
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


def half_circle(loudest: float, step_deg: float, label: str) -> tuple[Figure, PolarAxes]:
    """Make a figure of levels over elevation: half a circle, from the wake to ahead.

    Parameters
    ----------
    loudest : float
        Highest level to be drawn [dB]; 40 dB below it is the centre.
    step_deg : float
        Between the elevations that are named [deg].
    label : str
        Of the levels, with their unit.

    Returns
    -------
    Figure, PolarAxes
        The figure, with room for a legend on its right, and its axes: draw at angles in radians.
    """
    figure = page(8.0, layout=None)
    # Half a circle fills the middle half of its square; the legend stands beside it.
    axes = cast("PolarAxes", figure.add_axes((-0.06, 0.06, 0.704, 0.88), projection="polar"))
    top = 5.0 * np.ceil(loudest / 5.0)
    floor = top - 40.0
    axes.set(thetamin=-90.0, thetamax=90.0)
    axes.set_ylim(floor, top)
    axes.set_yticks(np.arange(floor + 10.0, top + 1.0, 10.0))
    named = {-90.0: "-90°, wake", 0.0: "0°, rotor plane", 90.0: "+90°, ahead"}
    ticks = np.arange(-90.0, 91.0, step_deg)
    axes.set_thetagrids(ticks, [named.get(tick, f"{tick:+g}°") for tick in ticks])
    for text, tick in zip(axes.get_xticklabels(), ticks, strict=True):
        text.set_horizontalalignment("left" if abs(tick) < 90.0 else "center")
    axes.grid(**GRID)
    # Along the straight edge, beside the levels of the circles.
    figure.text(0.06, 0.27, label, rotation=90.0, va="center")
    return figure, axes

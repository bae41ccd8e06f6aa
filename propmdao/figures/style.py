"""What all figures share: the page, axes, how lines are drawn.

Every figure is a `matplotlib.figure.Figure` of 1200 pixels' width that needs no display;
`save` writes it. A noise source has one colour in all of them, see `contents.palette`, and what is
measured is a dot of the colour of the line that it belongs to.
"""

from __future__ import annotations

from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import LOWEST_LEVEL, MARKERS, RUN_COLORS
from propmdao.runtime.output_files import replacing

if TYPE_CHECKING:
    from matplotlib.projections.polar import PolarAxes
    from matplotlib.text import Text

try:
    from matplotlib.figure import Figure
except ModuleNotFoundError as error:
    raise ModuleNotFoundError(
        "figures need matplotlib: pip install 'propmdao[plots]'", name=error.name
    ) from None

GRID: dict[str, Any] = {"color": "0.9", "linewidth": 0.8}


def page(height: float, layout: Literal["constrained"] | None = "constrained") -> Figure:
    """Make a figure of 1200 pixels' width that needs no display.

    Parameters
    ----------
    height : float
        Height where the width is 10.
    layout : "constrained" or None
        How matplotlib lays it out, if it does.

    Returns
    -------
    Figure
        The empty figure.
    """
    return Figure(figsize=(10.0, height), dpi=120, layout=layout)


def literal(text: str) -> str:
    """Text of users for titles and legends, in which a dollar begins no formula.

    Parameters
    ----------
    text : str
        Name or title that the user gave.

    Returns
    -------
    str
        The text as matplotlib has to be told it.
    """
    return text.replace("$", r"\$")


def headline(figure: Figure, text: str) -> Text:
    """Set the title of a whole figure, above all of its axes.

    Parameters
    ----------
    figure : Figure
        The figure.
    text : str
        Title that the user gave.

    Returns
    -------
    Text
        The title as matplotlib has it, to be changed.
    """
    return figure.suptitle(literal(text), x=0.02, ha="left", fontsize="medium")


def save(figure: Figure, path: Path) -> None:
    """Write a figure to a file that is whole at any time.

    Parameters
    ----------
    figure : Figure
        The figure.
    path : Path
        File to write or replace, of a format by its ending; its folder must exist.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    with replacing(path) as file:
        figure.savefig(file)


def rows_of_axes(n: int) -> tuple[Figure, npt.NDArray[Any]]:
    """Make equal axes with common scales, one below the other.

    Parameters
    ----------
    n : int
        Number of axes.

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


def half_circle(loudest: float, label: str) -> tuple[Figure, PolarAxes]:
    """Make a figure of levels over elevation: half a circle, from the wake to ahead.

    Parameters
    ----------
    loudest : float
        Highest level to be drawn [dB]; 40 dB below it is the centre.
    label : str
        Name of the levels, with their unit.

    Returns
    -------
    Figure, PolarAxes
        The figure, with room for a title above and a legend in its upper right corner, and its
        axes: draw at angles in radians.
    """
    # Half a circle lies in the middle of its square, which reaches out of the page on the left; the
    # legend has the corner above the arc.
    radius, left, below, above = 5.4, 1.0, 0.6, 1.0
    height = below + 2.0 * radius + above
    figure = page(height, layout=None)
    square = (0.1 * (left - 0.5 * radius), below / height, 0.2 * radius, 2.0 * radius / height)
    axes = cast("PolarAxes", figure.add_axes(square, projection="polar"))
    top = 5.0 * np.ceil(max(loudest, LOWEST_LEVEL + 40.0) / 5.0)
    floor = top - 40.0
    axes.set(thetamin=-90.0, thetamax=90.0)
    axes.set_ylim(floor, top)
    axes.set_yticks(np.arange(floor + 10.0, top + 1.0, 10.0))
    named = {-90.0: "-90°, wake", 0.0: "0°, rotor plane", 90.0: "+90°, ahead"}
    ticks = np.arange(-90.0, 91.0, 22.5)
    axes.set_thetagrids(ticks, [named.get(tick, f"{tick:+g}°") for tick in ticks])
    for text, tick in zip(axes.get_xticklabels(), ticks, strict=True):
        text.set_horizontalalignment("left" if abs(tick) < 90.0 else "center")
    axes.grid(**GRID)
    # Along the straight edge, beside the levels of the circles.
    figure.text(0.02, 0.27, label, rotation=90.0, va="center")
    return figure, axes


def say_silent(axes: Any) -> None:
    """Say on axes why they are empty.

    Parameters
    ----------
    axes : Axes
        Axes on which nothing is drawn.
    """
    axes.text(0.5, 0.5, f"nothing above {LOWEST_LEVEL:g} dB", ha="center", transform=axes.transAxes)


def run_line(number: int) -> dict[str, Any]:
    """Colour and style of the line of one of several runs.

    Parameters
    ----------
    number : int
        Number of the run, counted from 0.

    Returns
    -------
    dict
        Options of matplotlib's ``plot``.
    """
    styles = ("-", "--", "-.", ":")
    return {
        "color": RUN_COLORS[number % len(RUN_COLORS)],
        "linestyle": styles[number % len(styles)],
    }


def run_dots(number: int) -> dict[str, Any]:
    """Colour and shape of the dots of what was measured of one of several runs.

    Parameters
    ----------
    number : int
        Number of the run, counted from 0.

    Returns
    -------
    dict
        Options of matplotlib's ``plot``.
    """
    return {
        "color": RUN_COLORS[number % len(RUN_COLORS)],
        "marker": MARKERS[number % len(MARKERS)],
        "linestyle": "",
    }


def level_line(name: str) -> dict[str, Any]:
    """Width of a line of levels: the total is broad and below the others.

    The total is often that of its loudest part, which would hide it.

    Parameters
    ----------
    name : str
        Name of the noise source.

    Returns
    -------
    dict
        Options of matplotlib's ``plot``.
    """
    return {"linewidth": 4.0, "zorder": 1.9} if name == "total" else {"linewidth": 2.0}

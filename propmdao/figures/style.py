"""What all figures share: the page, axes, colours, line styles.

Every figure is a `matplotlib.figure.Figure` of 1200 pixels' width that needs no display;
`save` writes it. A noise source has one colour in all of them, and what is
measured is a dot of the colour of the line that it belongs to.
"""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
import numpy.typing as npt

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

# Okabe and Ito's palette, which colour-blind people can tell apart.
#: Colours of noise sources, in the order in which they are drawn.
SOURCE_COLORS = {
    "thickness": "#0072B2",
    "loading": "#D55E00",
    "broadband": "#009E73",
    "total": "#000000",
}
BLADE_COLORS = ("#777777", "#009E73", "#CC79A7", "#E69F00")
# A blade keeps its colour where it is one of several runs.
RUN_COLORS = (*BLADE_COLORS, "#0072B2", "#D55E00", "#000000")
_OTHER_COLORS = ("#E69F00", "#CC79A7", "#56B4E9", "#8C564B", "#999999", "#F0E442")
#: Line styles of noise sources, for whoever cannot tell the colours apart.
SOURCE_STYLES = {"thickness": "--", "loading": "-.", "broadband": ":", "total": "-"}
#: Line styles of what is compared: the first dashed, the second solid.
LINE_STYLES = ("--", "-", "-.", ":")
GRID: dict[str, Any] = {"color": "0.9", "linewidth": 0.8}
#: Dots of what is compared, in the same order.
MARKERS = "osD^v<>"
#: Unit of levels.
LEVEL = "dB re 20 µPa"
#: Unit of A-weighted levels.
LEVEL_DBA = "dBA re 20 µPa"
#: Level below which nothing is drawn [dB]: rounding errors, and silence, which is -200 dB.
LOWEST_LEVEL = -100.0

Floats = npt.NDArray[np.float64]
#: Measured (abscissa, level in dB) by the name of the line that it belongs to.
Measured = Mapping[str, tuple[npt.ArrayLike, npt.ArrayLike]]


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


def line_colors(names: Iterable[str]) -> dict[str, str]:
    """Give each line of a figure its colour.

    Parameters
    ----------
    names : iterable of str
        Names of the lines.

    Returns
    -------
    dict of str to str
        Colours by name: noise sources have their own ones, which other lines leave alone.
    """
    names = list(names)
    others = itertools.cycle(_OTHER_COLORS if set(names) & set(SOURCE_COLORS) else RUN_COLORS)
    return {name: SOURCE_COLORS.get(name) or next(others) for name in names}


def line_styles(names: Iterable[str]) -> dict[str, str]:
    """Give each line of a figure its style.

    Parameters
    ----------
    names : iterable of str
        Names of the lines.

    Returns
    -------
    dict of str to str
        Line styles by name: noise sources have their own ones; other lines take those of what is
        compared in turn, and one that is alone is solid.
    """
    names = list(names)
    others = [name for name in names if name not in SOURCE_STYLES]
    styles = itertools.cycle(LINE_STYLES if len(others) > 1 else "-")
    return {name: SOURCE_STYLES.get(name) or next(styles) for name in names}


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

"""Colours, line styles and units that pictures of every kind share; nothing here draws."""

from __future__ import annotations

import itertools
from collections.abc import Iterable, Mapping

import numpy as np
import numpy.typing as npt

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
_OTHER_COLORS = ("#E69F00", "#CC79A7", "#56B4E9", "#8C564B", "#999999", "#332288")
#: Line styles of noise sources, for whoever cannot tell the colours apart.
SOURCE_STYLES = {"thickness": "--", "loading": "-.", "broadband": ":", "total": "-"}
#: Line styles of what is compared: the first dashed, the second solid.
LINE_STYLES = ("--", "-", "-.", ":")
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

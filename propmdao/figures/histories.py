"""Figure of levels over time, of a flyover."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import line_colors, line_styles
from propmdao.figures.style import GRID, level_line, literal, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def level_history(
    time: npt.ArrayLike,
    levels: Mapping[str, npt.ArrayLike],
    label: str,
    moments: Mapping[str, float] | None = None,
) -> Figure:
    """Levels of a flyover against time.

    Parameters
    ----------
    time : (n_times,) array
        Time of reception [s].
    levels : mapping of str to (n_times,) array
        Levels by name [dB].
    label : str
        Name of the level, with its unit.
    moments : mapping of str to float, optional
        Times to mark, by name [s].

    Returns
    -------
    Figure
        The figure; levels more than 60 dB below the loudest are not drawn.
    """
    figure = page(6.0)
    axes = figure.add_subplot()
    axes.grid(**GRID)
    colors, styles = line_colors(levels), line_styles(levels)
    for name, level in levels.items():
        axes.plot(
            np.asarray(time),
            np.asarray(level),
            color=colors[name],
            linestyle=styles[name],
            label=literal(name),
            **level_line(name),
        )
    for (name, moment), style in zip((moments or {}).items(), ("--", ":", "-."), strict=False):
        axes.axvline(moment, color="0.4", linestyle=style, label=literal(name))
    top = 5.0 * np.ceil(max(np.max(level) for level in levels.values()) / 5.0 + 0.5)
    bottom = 5.0 * np.floor(min(np.min(level) for level in levels.values()) / 5.0)
    axes.set(xlabel="time, s", ylabel=label, ylim=(max(bottom, top - 60.0), top))
    axes.margins(x=0.0)
    figure.legend(loc="outside upper center", ncols=4)
    return figure

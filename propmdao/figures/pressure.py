"""Figure of sound pressure over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

import numpy as np

from propmdao.figures.contents.palette import (
    SOURCE_COLORS,
    line_colors,
    line_styles,
)
from propmdao.figures.contents.pressures import LOWEST_PRESSURE, PressureRecord
from propmdao.figures.style import literal, rows_of_axes, say_silent

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def pressure(records: Mapping[str, PressureRecord]) -> Figure:
    """Sound pressure over time.

    Parameters
    ----------
    records : mapping of str to PressureRecord
        Records by name, one below the other: `blade_passage` of `contents.pressures` makes them of
        tones, `sampled` of what was made to be heard.

    Returns
    -------
    Figure
        The figure, without parts below -100 dB. Of parts that are no noise sources, each is drawn
        broader than the one before, so that tones show on the noise that they are a part of.
    """
    figure, rows = rows_of_axes(len(records))
    for axes, (name, record) in zip(rows, records.items(), strict=True):
        colors, styles = line_colors(record.parts), line_styles(record.parts)
        for i, (part, values) in enumerate(record.parts.items()):
            if np.sqrt(np.mean(np.square(values))) < LOWEST_PRESSURE:
                continue
            width = 2.0 if part in SOURCE_COLORS else 1.0 + i
            axes.plot(
                1e3 * record.time, 1e3 * values, styles[part], color=colors[part], linewidth=width,
                label=part,
            )  # fmt: skip
        axes.set_title(literal(name), fontsize="medium", loc="left")
        axes.set_ylabel("pressure, mPa")
        axes.margins(x=0.0)
        if not axes.lines:
            axes.set(xlim=(0.0, 1e3 * record.time[-1]), ylim=(-1.0, 1.0))
            say_silent(axes)
    rows[-1].set_xlabel("time since blade 1 was at azimuth 0, ms")
    drawn = {line.get_label(): line for axes in reversed(rows) for line in axes.lines}
    if drawn:
        names = [name for name in next(iter(records.values())).parts if name in drawn]
        names += [name for name in drawn if name not in names]
        figure.legend([drawn[name] for name in names], names, loc="outside upper right", ncols=4)
    return figure

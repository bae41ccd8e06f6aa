"""Figure of sound pressure over time."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE, pressure_history
from propmdao.acoustics.signals import Tones
from propmdao.figures.sound import amplitudes
from propmdao.figures.style import (
    LOWEST_LEVEL,
    SOURCE_COLORS,
    Floats,
    line_colors,
    line_styles,
    literal,
    rows_of_axes,
    say_silent,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_TIMES = 256  # in a blade passage
_LOWEST_PRESSURE = REFERENCE_PRESSURE * 10 ** (LOWEST_LEVEL / 20)


class PressureRecord(NamedTuple):
    """Pressure at one observer over time, in parts.

    Attributes
    ----------
    time : (n_times,) array
        Time since blade 1 was at azimuth 0 [s].
    parts : mapping of str to (n_times,) array
        Pressure by noise source or another name [Pa].
    """

    time: Floats
    parts: Mapping[str, Floats]


def blade_passage(tones: Tones, observer: int = 0) -> PressureRecord:
    """Pressure of tones over one blade passage, by noise source.

    Parameters
    ----------
    tones : Tones
        Amplitudes.
    observer : int
        Index of the observer.

    Returns
    -------
    PressureRecord
        Each source and the total.

    Raises
    ------
    ValueError
        If the rotor stands still.
    """
    histories = {
        source: pressure_history(tones.frequency_hz, amplitude[observer], _TIMES)
        for source, amplitude in amplitudes(tones).items()
    }
    time, _ = histories["total"]
    return PressureRecord(time, {source: history[1] for source, history in histories.items()})


def sampled(
    parts: Mapping[str, npt.ArrayLike], sample_rate: float, duration: float
) -> PressureRecord:
    """Beginning of sampled pressures.

    Parameters
    ----------
    parts : mapping of str to (n_times,) array
        Pressure by name, from blade 1 at azimuth 0 on, as long as each other [Pa].
    sample_rate : float
        Samples in a second [Hz].
    duration : float
        Length of the beginning [s].

    Returns
    -------
    PressureRecord
        The samples of that duration, or all if there are fewer.
    """
    n = round(duration * sample_rate)
    beginnings = {name: np.asarray(record, float)[:n] for name, record in parts.items()}
    n = min(record.size for record in beginnings.values())
    return PressureRecord(np.arange(n) / sample_rate, beginnings)


def pressure(records: Mapping[str, PressureRecord]) -> Figure:
    """Sound pressure over time.

    Parameters
    ----------
    records : mapping of str to PressureRecord
        Records by name, one below the other: `blade_passage` makes them of tones, `sampled` of
        what was made to be heard.

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
            if np.sqrt(np.mean(np.square(values))) < _LOWEST_PRESSURE:
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

"""Sound pressure over time, in parts, as figures show it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import NamedTuple

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.levels.decibels import REFERENCE_PRESSURE, pressure_history
from propmdao.acoustics.signals import Tones
from propmdao.figures.contents.palette import LOWEST_LEVEL, Floats
from propmdao.figures.contents.sound import amplitudes

_TIMES = 256  # in a blade passage
#: Root of the mean square below which nothing is drawn [Pa].
LOWEST_PRESSURE = REFERENCE_PRESSURE * 10 ** (LOWEST_LEVEL / 20)


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

"""The sound of an analysis: pressure at its observers over seconds, tones and broadband noise."""

from __future__ import annotations

import math
from collections.abc import Mapping, Sequence
from pathlib import Path

import numpy as np
import numpy.typing as npt

from propmdao.acoustics.sounds.recordings import (
    MOST_SAMPLES,
    SAMPLE_RATE,
    broadband_record,
    common_full_scale,
    tone_record,
)
from propmdao.analysis.results import Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.formats.wav import FULL_SCALE, Recording, write_wav
from propmdao.records.units import Range

_SHORTEST = 0.01  # s
MAX_CHANNELS = 64  # more than any player has; programs that show sound hold them


def pressure_record(
    analysis: Analysis, duration: float, observers: Sequence[int] | None = None
) -> npt.NDArray[np.float64]:
    """Pressure at observers, to be repeated seamlessly.

    Parameters
    ----------
    analysis : Analysis
        With or without broadband noise.
    duration : float
        About how long [s]: as many blade passages as are nearest to it.
    observers : sequence of int, optional
        Indices of the observers; all by default.

    Returns
    -------
    (n_observers, n_times) array
        At `SAMPLE_RATE` [Pa]. Noise is random, the same each time, and that of one observer is not
        that of another.

    Raises
    ------
    ValueError
        If the rotor stands still, or the duration is too short for the lowest band.
    """
    tones = analysis.tones
    chosen = slice(None) if observers is None else list(observers)
    record = tone_record(tones.frequency_hz, np.asarray(tones.total)[chosen], duration)
    if analysis.broadband is not None:
        power = np.asarray(analysis.broadband.total)[chosen]
        record = record + broadband_record(BANDS_HZ, power, record.shape[-1])
    return record


def require_sound(n_observers: int, duration: float, full_scale: float | None = None) -> None:
    """Refuse a sound file that cannot be, before what is heard in it is known.

    Parameters
    ----------
    n_observers : int
        Number of observers, a channel for each.
    duration : float
        Length of the sound [s].
    full_scale : float, optional
        Pressure of the largest number in the file [Pa].

    Raises
    ------
    ValueError
        If there are more than `MAX_CHANNELS`, or a value is out of range.
    """
    if n_observers > MAX_CHANNELS:
        raise ValueError(
            f"a sound file is of at most {MAX_CHANNELS} observers; there are {n_observers}"
        )
    longest = MOST_SAMPLES / SAMPLE_RATE / max(n_observers, 1)
    Range(_SHORTEST, math.floor(longest), "s").require(
        f"length of the sound of {n_observers} observers", duration
    )
    if full_scale is not None:
        FULL_SCALE.require("full scale", full_scale)


def write_sound(
    path: str | Path, analysis: Analysis, duration: float, full_scale: float | None = None
) -> Recording:
    """Write a sound file of an analysis, a channel for each observer.

    Parameters
    ----------
    path : str or Path
        WAV file.
    analysis : Analysis
        With or without broadband noise.
    duration : float
        About how long [s].
    full_scale : float, optional
        Pressure of the largest number in the file [Pa]; by default the highest peak, rounded up.

    Returns
    -------
    Recording
        The file and its calibration.

    Raises
    ------
    ValueError
        If there are more than `MAX_CHANNELS` observers, a value is out of range, or as in
        `pressure_record` and `write_wav`.
    """
    record = _channels(analysis, duration, full_scale)
    if full_scale is None:
        full_scale = common_full_scale(record)
    return write_wav(path, record, full_scale, SAMPLE_RATE)


def write_sounds(files: Mapping[Path, Analysis], duration: float) -> list[Recording]:
    """Write sound files of one full scale, so that they can be compared by ear.

    Parameters
    ----------
    files : mapping of Path to Analysis
        Analyses by their WAV file.
    duration : float
        About how long [s].

    Returns
    -------
    list of Recording
        The files and their calibration: the highest peak of all, rounded up.

    Raises
    ------
    ValueError
        The same as from `write_sound`.
    """
    records = {file: _channels(analysis, duration) for file, analysis in files.items()}
    full_scale = common_full_scale(*records.values())
    return [write_wav(file, record, full_scale, SAMPLE_RATE) for file, record in records.items()]


def _channels(
    analysis: Analysis, duration: float, full_scale: float | None = None
) -> npt.NDArray[np.float64]:
    """Record of a file that can be, (n_observers, n_times) [Pa]."""
    # A record holds one blade passage at least, which may be long; a rotor at rest has none.
    passage_hz = float(np.asarray(analysis.tones.frequency_hz)[0])
    longer = max(duration, 1.0 / passage_hz if passage_hz > 0.0 else 0.0)
    require_sound(len(analysis.listening.observers), longer, full_scale)
    return pressure_record(analysis, duration)

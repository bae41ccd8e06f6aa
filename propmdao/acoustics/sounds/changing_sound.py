"""Sound that changes slowly: noise with changing bands, records filtered by changing air.

Frames of two steps, one for each step, fade into each other by sines, whose squares add up to one.
So the energies of uncorrelated noises add up, too, and a record that is faded on its way in and
again on its way out is the record itself.
"""

from __future__ import annotations

from collections.abc import Iterator

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.propagation.absorption import absorption_db_per_m
from propmdao.acoustics.sounds.recordings import broadband_record
from propmdao.records.air import Air

Floats = NDArray[np.float64]


def changing_noise(
    center_hz: ArrayLike, mean_square: ArrayLike, each: int, sample_rate: int, seed: int = 0
) -> Floats:
    """Record of random noise whose third octaves change from step to step.

    Parameters
    ----------
    center_hz : (n_bands,) array_like
        Mid-band frequencies of neighbouring bands [Hz].
    mean_square : (n_steps, n_bands) array_like
        Mean squares in the middle of each step [Pa^2].
    each : int
        Number of samples in a step, even.
    sample_rate : int
        Samples per second [Hz].
    seed : int
        Seed of the random noise; another seed gives another noise of the same spectrum.

    Returns
    -------
    (n_steps * each,) array
        Pressure [Pa].

    Raises
    ------
    ValueError
        If all bands reach above half the sample rate, or the frames are too short to resolve the
        lowest band.
    """
    bands = np.asarray(mean_square, float)
    noise = broadband_record(center_hz, bands, 2 * each, sample_rate, seed)
    record = np.zeros((len(bands) + 1) * each)
    for frame, window, step_noise in zip(*_frames(len(bands), each), noise, strict=False):
        record[frame] += window * step_noise
    return record[each // 2 : -(each // 2)]


def absorbed_record(
    pressure: ArrayLike, distance: ArrayLike, air: Air, each: int, sample_rate: int
) -> Floats:
    """Record after a way through the air that changes from step to step.

    Parameters
    ----------
    pressure : (n_steps * each,) array_like
        Pressure as it would be heard without absorption [Pa].
    distance : (n_steps,) array_like
        Distance travelled by the sound that is heard in the middle of each step [m].
    air : Air
        State of the air.
    each : int
        Number of samples in a step, even.
    sample_rate : int
        Samples per second [Hz].

    Returns
    -------
    (n_steps * each,) array
        Pressure [Pa].
    """
    lengths = np.asarray(distance, float)
    padded = np.pad(np.asarray(pressure, float), each // 2)
    lost = np.asarray(absorption_db_per_m(np.fft.rfftfreq(2 * each, 1 / sample_rate), air))
    record = np.zeros_like(padded)
    for frame, window, length in zip(*_frames(lengths.size, each), lengths, strict=False):
        spectrum = np.fft.rfft(window * padded[frame]) * 10 ** (-0.05 * lost * length)
        record[frame] += window * np.fft.irfft(spectrum, 2 * each)
    return record[each // 2 : -(each // 2)]


def _frames(n_steps: int, each: int) -> tuple[list[slice], Iterator[Floats]]:
    """Frames of a record that is longer by half a step on either side, and their windows."""
    fade = np.sin(np.pi * (np.arange(2 * each) + 0.5) / (2 * each))
    flat = np.r_[np.ones(each), np.zeros(each)]
    first, last = np.where(flat > 0, 1.0, fade), np.where(flat[::-1] > 0, 1.0, fade)
    if n_steps == 1:
        first = last = np.ones(2 * each)
    windows = [fade] * n_steps
    windows[0], windows[-1] = first, last
    return [slice(k * each, (k + 2) * each) for k in range(n_steps)], iter(windows)

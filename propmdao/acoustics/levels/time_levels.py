"""Levels of pressure records over time: time weighting, short-time levels, sound exposure.

A flyover is loud for a while: these levels tell when, and how much of it was heard in all.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.levels.decibels import energy_sum_db, level_db
from propmdao.acoustics.levels.weighting import a_weighting

#: Time constants of sound level meters [s] (IEC 61672-1, 5.8.1).
FAST = 0.125
SLOW = 1.0

_OVERLAP = 0.1  # of the width of a band, on either side of an edge

Floats = NDArray[np.float64]


def a_weighted(pressure: ArrayLike, sample_rate: float) -> Floats:
    """Record after A-weighting, without a shift in phase.

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure, taken to repeat itself [Pa].
    sample_rate : float
        Samples per second [Hz].

    Returns
    -------
    (..., n_times) array
        Weighted pressure [Pa].
    """
    p = np.asarray(pressure, float)
    frequency = np.fft.rfftfreq(p.shape[-1], 1 / sample_rate)
    return np.fft.irfft(np.fft.rfft(p) * np.asarray(a_weighting(frequency)), p.shape[-1])


def time_weighted_level_db(
    pressure: ArrayLike, sample_rate: float, time_constant: float = FAST
) -> Floats:
    """Level that a sound level meter shows at every sample: of `a_weighted` records LAF and LAS.

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure; before it, there is silence [Pa].
    sample_rate : float
        Samples per second [Hz].
    time_constant : float
        Time constant of the exponential average, `FAST` or `SLOW` [s].

    Returns
    -------
    (..., n_times) array
        Levels [dB re 20 uPa], at least -200.

    References
    ----------
    IEC 61672-1:2013, equation 1.
    """
    from scipy.signal import lfilter  # here: loading it takes as long as all the rest

    keep = np.exp(-1 / (sample_rate * time_constant))
    average = lfilter([1 - keep], [1, -keep], np.asarray(pressure, float) ** 2, axis=-1)
    return np.asarray(level_db(average))


def short_time_level_db(
    pressure: ArrayLike, sample_rate: float, step: float
) -> tuple[Floats, Floats]:
    """Level of each of the slices of a record, Leq over the step.

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure [Pa]; the rest after the last whole slice does not count.
    sample_rate : float
        Samples per second [Hz].
    step : float
        Length of a slice [s].

    Returns
    -------
    time : (n_slices,) array
        Middle of each slice, from the beginning of the record [s].
    level_db : (..., n_slices) array
        Levels [dB re 20 uPa], at least -200.

    Raises
    ------
    ValueError
        If the record is shorter than a slice, or a slice has no sample.
    """
    p = np.asarray(pressure, float)
    each, n = _slices(p.shape[-1], sample_rate, step)
    parts = p[..., : n * each].reshape(*p.shape[:-1], n, each)
    return _middles(n, each, sample_rate), np.asarray(level_db(np.mean(parts**2, axis=-1)))


def third_octave_history(
    pressure: ArrayLike, sample_rate: float, center_hz: ArrayLike, step: float
) -> tuple[Floats, Floats]:
    """Third octaves of each of the slices of a record.

    Bands pass into each other over a tenth of their width, as those of real filters do: sharp
    edges would ring for longer than a flying rotor's tone takes to cross them.

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure [Pa]; the rest after the last whole slice does not count.
    sample_rate : float
        Samples per second [Hz].
    center_hz : (n_bands,) array_like
        Mid-band frequencies [Hz].
    step : float
        Length of a slice [s].

    Returns
    -------
    time : (n_slices,) array
        Middle of each slice, from the beginning of the record [s].
    mean_square : (..., n_slices, n_bands) array
        Mean-square pressures [Pa^2]; over all slices and neighbouring bands they give that of the
        record.

    Raises
    ------
    ValueError
        If a band is above half the sample rate, the record is shorter than a slice, or a slice has
        no sample.
    """
    p = np.asarray(pressure, float)
    each, n = _slices(p.shape[-1], sample_rate, step)
    spectrum = np.fft.rfft(p[..., : n * each]) / (n * each)
    resolution = sample_rate / (n * each)
    bands = []
    for center in np.asarray(center_hz, float):
        edge = 0.5 + _OVERLAP
        low, high = (int(np.ceil(center * 10 ** (k / 10) / resolution)) for k in (-edge, edge))
        if high > spectrum.shape[-1]:
            raise ValueError(
                f"sample rate of {sample_rate:g} Hz is too low for the band around {center:.4g} Hz"
            )
        away = np.abs(10 * np.log10(np.arange(low, high) * resolution / center)) - 0.5
        # The squares of neighbours add up to one.
        part = np.cos(np.pi / 4 * (1 + np.maximum(away / _OVERLAP, -1))) * spectrum[..., low:high]
        # The band alone is an envelope that changes no faster than the band is wide, so that few
        # samples of it say all; four times as many as it needs follow its square within a slice.
        samples = max(8, -(-4 * (high - low) // n))
        midway = np.exp(1j * np.pi * np.arange(high - low) / (n * samples))
        envelope = np.fft.ifft(part * midway, n * samples) * (n * samples)
        energy = 2 * np.abs(envelope) ** 2
        bands.append(energy.reshape(*p.shape[:-1], n, samples).mean(axis=-1))
    return _middles(n, each, sample_rate), np.stack(bands, axis=-1)


def sound_exposure_level_db(level_db: ArrayLike, step: float) -> Floats:
    """Level of one second that has the energy of the whole event; SEL of A-weighted levels.

    Parameters
    ----------
    level_db : (..., n_slices) array_like
        Short-time levels [dB].
    step : float
        Length of a slice [s].

    Returns
    -------
    (...,) array
        Level [dB re (20 uPa)^2 s].

    References
    ----------
    ISO 1996-1:2016, 3.1.8.
    """
    return np.asarray(energy_sum_db(np.asarray(level_db)) + 10 * np.log10(step))


def _middles(n: int, each: int, sample_rate: float) -> Floats:
    return (np.arange(n, dtype=np.float64) + 0.5) * each / sample_rate


def _slices(n_times: int, sample_rate: float, step: float) -> tuple[int, int]:
    """Samples of a slice and number of slices."""
    each = round(step * sample_rate)
    if not 1 <= each <= n_times:
        raise ValueError(
            f"slices must be between {1 / sample_rate:.3g} s (a sample) and "
            f"{n_times / sample_rate:.4g} s (the record); got {step:g}"
        )
    return each, n_times // each

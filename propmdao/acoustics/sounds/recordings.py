"""Sound to listen to: records of tones and of broadband noise, and calibrated WAV files.

Records are made to be repeated: tones fit a whole number of times, noise is periodic in the length
of the record, so that a player that loops them plays no click.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.levels.bands import HALF_BAND, bands_in_bins
from propmdao.acoustics.levels.decibels import passage_frequency

#: [Hz]; holds all third octaves that are heard, up to 20 kHz.
SAMPLE_RATE = 48000
#: Numbers that a record has room for, all channels together: 240 MB, ten minutes of one channel.
MOST_SAMPLES = 30_000_000


Floats = NDArray[np.float64]


def tone_record(
    frequency_hz: ArrayLike,
    amplitude: ArrayLike,
    duration: float,
    sample_rate: int = SAMPLE_RATE,
) -> Floats:
    """Record of a rotor's tones that can be repeated seamlessly.

    Parameters
    ----------
    frequency_hz : (n_harmonics,) array_like
        Frequencies of the tones, multiples of the first [Hz].
    amplitude : (..., n_harmonics) complex array_like
        Amplitudes P_m as `Tones` holds them [Pa].
    duration : float
        Duration of the record [s]; the nearest whole number of blade passages is taken.
    sample_rate : int
        Samples per second [Hz].

    Returns
    -------
    (..., n_times) array
        Pressure [Pa]. Tones above half the sample rate are not in it. The pitch is off by less
        than half a sample in the whole record, so that the passages fit.

    Raises
    ------
    ValueError
        If the rotor stands still, the frequencies are not multiples of the first or the record
        holds no sample.
    """
    p = np.asarray(amplitude)
    passage_hz = passage_frequency(np.asarray(frequency_hz, float))
    passages = max(1, round(duration * passage_hz))
    n = round(passages * sample_rate / passage_hz)
    if not (duration > 0 and n > 0):
        raise ValueError(f"duration of a record must be positive [s]; got {duration:g}")
    fits = passages * np.arange(1, p.shape[-1] + 1) < n / 2
    spectrum = np.zeros((*p.shape[:-1], n // 2 + 1), complex)
    # irfft sums exp(+1j ...), the tones exp(-1j ...)
    spectrum[..., passages * np.arange(1, fits.sum() + 1)] = n * np.conj(p[..., fits])
    return np.fft.irfft(spectrum, n)


def looped_record(
    pressure: ArrayLike, period: float, duration: float, sample_rate: int = SAMPLE_RATE
) -> Floats:
    """Record that repeats one period of any pressure history, whatever its own time step.

    Parameters
    ----------
    pressure : (..., n_samples) array_like
        Pressure over one period, evenly sampled, the first value not repeated at the end [Pa].
    period : float
        Length of the period: a blade passage or a turn [s].
    duration : float
        Duration of the record [s]; the nearest whole number of periods is taken.
    sample_rate : int
        Samples per second [Hz].

    Returns
    -------
    (..., n_times) array
        Pressure without its mean [Pa].

    Raises
    ------
    ValueError
        If the period has fewer than 3 samples or is infinite, or the record holds no sample.
    """
    p = np.asarray(pressure, float)
    if p.shape[-1] < 3:
        raise ValueError(f"a period needs at least 3 samples to be repeated; got {p.shape[-1]}")
    amplitude = np.conj(np.fft.rfft(p)) / p.shape[-1]
    harmonics = np.arange(1, (p.shape[-1] + 1) // 2)
    return tone_record(harmonics / period, amplitude[..., harmonics], duration, sample_rate)


def broadband_record(
    center_hz: ArrayLike,
    mean_square: ArrayLike,
    n_times: int,
    sample_rate: int = SAMPLE_RATE,
    seed: int = 0,
) -> Floats:
    """Record of random noise with given third octaves that can be repeated seamlessly.

    Parameters
    ----------
    center_hz : (n_bands,) array_like
        Mid-band frequencies of neighbouring bands [Hz].
    mean_square : (..., n_bands) array_like
        Mean-square pressures [Pa^2].
    n_times : int
        Number of samples, the same as that of the tones to which the noise is added.
    sample_rate : int
        Samples per second [Hz].
    seed : int
        Seed of the random noise; another seed gives another noise of the same spectrum.

    Returns
    -------
    (..., n_times) array
        Pressure [Pa]; bands that reach above half the sample rate are not in it.

    Raises
    ------
    ValueError
        If all bands reach above half the sample rate, the record is too short to resolve the
        lowest band, or the bands are not neighbours.
    """
    center, wanted = np.asarray(center_hz, float), np.asarray(mean_square, float)
    fits = center * HALF_BAND < sample_rate / 2
    if not np.any(fits):
        raise ValueError(
            f"sample rate of {sample_rate} Hz is too low for the band around {center[0]:.4g} Hz"
        )
    bins = np.arange(1, (n_times + 1) // 2) * sample_rate / n_times
    energy = bands_in_bins(center[fits], wanted[..., fits], bins)
    phase = np.random.default_rng(seed).uniform(0, 2 * np.pi, energy.shape)
    spectrum = np.zeros((*energy.shape[:-1], n_times // 2 + 1), complex)
    # a line of mean square s is 2 |X / n|^2
    spectrum[..., 1 : bins.size + 1] = n_times * np.sqrt(energy / 2) * np.exp(1j * phase)
    return np.fft.irfft(spectrum, n_times)


def common_full_scale(*pressures: ArrayLike) -> float:
    """Full scale for files to be compared: their highest peak, rounded up to two digits.

    Parameters
    ----------
    *pressures : arrays
        Records of the pressure [Pa].

    Returns
    -------
    float
        Pressure of the full scale [Pa].

    Raises
    ------
    ValueError
        If all records are silent.
    """
    peak = max(float(np.abs(np.asarray(p, float)).max()) for p in pressures)
    if not peak > 0:
        raise ValueError("there is nothing to be heard: all pressures are zero")
    digit = 10 ** (np.floor(np.log10(peak)) - 1)
    return float(f"{np.ceil(peak / digit * (1 - 1e-12)) * digit:.2g}")

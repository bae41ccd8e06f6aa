"""Narrowband spectra of pressure records at a chosen bin width."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.levels.bands import third_octaves_of_spectrum


def narrowband(
    pressure: ArrayLike, sample_rate: float, bin_width_hz: float, window: str = "hann"
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Narrowband spectrum of a record, averaged over segments (Welch).

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure [Pa]; its mean is no sound and is left out.
    sample_rate : float
        Samples per second [Hz].
    bin_width_hz : float
        Bin width [Hz]; the nearest that a whole number of samples gives is taken.
    window : str
        Window of `scipy.signal.get_window`: "hann", or "boxcar" for records whose tones fit a whole
        number of times into 1 / bin width.

    Returns
    -------
    frequency_hz : (n_bins,) array
        Frequencies from one bin width up to half the sample rate [Hz].
    mean_square : (..., n_bins) array
        Mean-square pressure in each bin [Pa^2]: the bins together hold that of the record. A tone
        is spread over three bins by "hann", the highest of which has up to 2/3 of it.

    Raises
    ------
    ValueError
        If the record is shorter than one segment, 1 / bin width.
    """
    from scipy.signal import welch  # here: loading it takes as long as all the rest

    p = np.asarray(pressure, float)
    n = round(sample_rate / bin_width_hz) if bin_width_hz > 0 else 0
    if not 2 <= n <= p.shape[-1]:
        raise ValueError(
            f"bin width must be between {sample_rate / p.shape[-1]:.4g} Hz (one over the record's "
            f"length) and {sample_rate / 2:.4g} Hz; got {bin_width_hz:g}"
        )
    p = p - p.mean(axis=-1, keepdims=True)
    frequency, density = welch(p, sample_rate, window, nperseg=n, detrend=False)
    return frequency[1:], density[..., 1:] * sample_rate / n


def third_octaves_of_record(
    pressure: ArrayLike, sample_rate: float
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Third octaves of a whole record.

    Parameters
    ----------
    pressure : (..., n_times) array_like
        Record of the pressure [Pa].
    sample_rate : float
        Samples per second [Hz].

    Returns
    -------
    center_hz : (n_bands,) array
        Exact mid-band frequencies up to half the sample rate [Hz].
    mean_square : (..., n_bands) array
        Mean-square pressures of the bands [Pa^2]; together they hold that of the record without its
        mean.
    """
    resolution = sample_rate / np.shape(pressure)[-1]
    return third_octaves_of_spectrum(*narrowband(pressure, sample_rate, resolution, "boxcar"))

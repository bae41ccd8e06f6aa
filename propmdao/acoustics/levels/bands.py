"""Third octaves: tones and spectra put into bands, and bands spread over a spectrum again.

All functions work on mean-square pressures, for those add: `decibels.mean_square` makes them from
amplitudes, `decibels.level_db` makes levels of them.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray
from scipy.interpolate import PchipInterpolator

from propmdao.acoustics.levels.decibels import level_db, mean_square
from propmdao.runtime.compilation import compiled

#: From the middle of a third octave to its edge, as a factor (IEC 61260-1, base ten).
HALF_BAND = 10**0.05
_ROUNDS = 30  # each leaves of the error the share of a band that is in bins across its edges


def tones_in_bands(frequency_hz: ArrayLike, mean_square: ArrayLike, center_hz: ArrayLike) -> Array:
    """Mean squares of tones in given third octaves; traceable by JAX.

    Parameters
    ----------
    frequency_hz : (n_tones,) array
        Frequencies of the tones [Hz].
    mean_square : (..., n_tones) array
        Mean-square pressures of the tones [Pa^2].
    center_hz : (n_bands,) array
        Mid-band frequencies [Hz], see `broadband.third_octave_centers`.

    Returns
    -------
    (..., n_bands) array
        Mean-square pressures of the bands [Pa^2]; tones outside all bands are left out.

    Notes
    -----
    A tone jumps from band to band when the rotor's speed takes it over an edge: smooth in the
    pressures, not in the frequencies.
    """
    number = jnp.round(10 * jnp.log10(jnp.asarray(center_hz, float) / 1000))
    return _sort_in(mean_square, band_number(frequency_hz), number)


def tones_in_bins(frequency_hz: ArrayLike, mean_square: ArrayLike, bin_hz: ArrayLike) -> Array:
    """Mean squares of tones in the bins of a narrowband spectrum; traceable by JAX.

    Parameters
    ----------
    frequency_hz : (n_tones,) array
        Frequencies of the tones [Hz].
    mean_square : (..., n_tones) array
        Mean-square pressures of the tones [Pa^2].
    bin_hz : (n_bins,) array
        Frequencies of the bins, multiples of their width [Hz].

    Returns
    -------
    (..., n_bins) array
        Mean-square pressures [Pa^2].
    """
    bins = jnp.asarray(bin_hz, float)
    width = bins[1] - bins[0]
    tone = jnp.round(jnp.asarray(frequency_hz, float) / width)
    return _sort_in(mean_square, tone, jnp.round(bins / width))


def third_octaves_of_spectrum(
    frequency_hz: ArrayLike, mean_square: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Third octaves of a narrowband spectrum.

    A bin that lies across an edge is divided, as if its energy were spread evenly over its width,
    so that the bands together hold what the bins hold.

    Parameters
    ----------
    frequency_hz : (n_bins,) array
        Frequencies of the bins, evenly spaced, the first one at least half a bin above 0 [Hz].
    mean_square : (..., n_bins) array
        Mean-square pressure of each bin [Pa^2].

    Returns
    -------
    center_hz : (n_bands,) array
        Exact mid-band frequencies 1000 * 10**(k/10) of all bands that the bins touch [Hz].
    mean_square : (..., n_bands) array
        Mean-square pressures [Pa^2].

    Raises
    ------
    ValueError
        If the bins are not evenly spaced or start less than half a bin above 0.
    """
    bins = np.asarray(frequency_hz, float)
    edges = _bin_edges(bins)
    first, last = (int(k) for k in np.asarray(band_number(edges[[0, -1]])))
    center = middle_hz(np.arange(first, last + 1))
    return center, _energy(np.asarray(mean_square, float), edges, center)


def bands_in_bins(
    center_hz: ArrayLike, mean_square: ArrayLike, bin_hz: ArrayLike
) -> NDArray[np.float64]:
    """Spread third octaves over the bins of a narrowband spectrum, smoothly.

    The spectral density is a smooth curve over log frequency that gives every band its energy;
    where neighbours differ by more than such a curve can follow (one of them silent), it has a
    step at the edge.

    Parameters
    ----------
    center_hz : (n_bands,) array_like
        Mid-band frequencies of neighbouring bands, rising [Hz].
    mean_square : (..., n_bands) array_like
        Mean-square pressures [Pa^2].
    bin_hz : (n_bins,) array_like
        Frequencies of the bins, evenly spaced, the first one at least half a bin above 0 [Hz].

    Returns
    -------
    (..., n_bins) array
        Mean-square pressure of each bin [Pa^2]; none outside the bands.

    Raises
    ------
    ValueError
        If the bands are not neighbours, the bins are wider than a band or do not cover the bands.
    """
    center = np.asarray(center_hz, float)
    number = np.round(10 * np.log10(center / 1000))
    if np.any(np.diff(number) != 1):
        raise ValueError(f"bands must be neighbouring third octaves; got {center} Hz")
    bins = np.asarray(bin_hz, float)
    edges = _bin_edges(bins)
    narrowest = center[0] * (HALF_BAND - 1 / HALF_BAND)
    if bins[1] - bins[0] > narrowest:
        raise ValueError(
            f"bins of {bins[1] - bins[0]:g} Hz are wider than the band around {center[0]:.4g} Hz, "
            f"{narrowest:.3g} Hz"
        )
    low, high = center[0] / HALF_BAND, center[-1] * HALF_BAND
    if not edges[0] <= low <= high <= edges[-1]:
        raise ValueError(
            f"bins from {edges[0]:.4g} to {edges[-1]:.4g} Hz do not cover the bands, "
            f"{low:.4g} to {high:.4g} Hz"
        )
    wanted = np.asarray(mean_square, float)
    spread = [_spread(center, levels, bins, edges) for levels in wanted.reshape(-1, center.size)]
    return np.reshape(spread, (*wanted.shape[:-1], bins.size))


def _spread(center: NDArray, wanted: NDArray, bins: NDArray, edges: NDArray) -> NDArray:
    if not np.any(wanted > 0):
        return np.zeros_like(bins)
    owner = np.searchsorted(center * HALF_BAND, bins, side="right")
    within = (bins >= center[0] / HALF_BAND) & (owner < center.size)
    owner = np.minimum(owner, center.size - 1)
    log_f = np.log(np.clip(bins, center[0] / HALF_BAND, center[-1] * HALF_BAND))
    nodes = np.log(np.r_[center[0] / HALF_BAND, center, center[-1] * HALF_BAND])
    # A curve need not reach below 100 dB under the loudest band: the gain below does the rest.
    floor = np.log(1e-10 * wanted.max())
    target = np.maximum(np.log(wanted, out=np.full_like(wanted, floor), where=wanted > 0), floor)
    log_density = target - np.log(center)
    for _ in range(40):
        curve = PchipInterpolator(nodes, np.pad(log_density, 1, "edge"))
        energy = np.where(within, np.exp(curve(log_f)), 0.0)
        held = _energy(energy, edges, center)
        excess = np.log(held) - target
        if np.abs(excess).max() < 1e-4:  # 0.0004 dB
            break
        # Neighbours may rule a quiet band; it must not run away below them.
        log_density = np.maximum(log_density - np.clip(excess, -2.0, 2.0), floor - 25.0)
    return np.asarray(energy * _gains(energy, edges, center, owner, wanted)[owner])


def _gains(
    energy: NDArray, edges: NDArray, center: NDArray, owner: NDArray, wanted: NDArray
) -> NDArray:
    """Factors of the bands' own bins by which bands hold what is wanted, shared bins divided."""
    # held[b, o]: what band b holds of the bins that are mostly band o's.
    held = np.diag(np.bincount(owner, energy, center.size))
    limits = np.append(center / HALF_BAND, center[-1] * HALF_BAND)
    position = (limits - edges[0]) / (edges[1] - edges[0])
    shared = np.minimum(position.astype(int), energy.size - 1)
    for upper, (k, below) in enumerate(zip(shared, position - shared, strict=True)):
        own = owner[k]
        other, part = (upper, 1 - below) if own < upper else (upper - 1, below)
        held[own, own] -= part * energy[k]
        if 0 <= other < center.size:
            held[other, own] += part * energy[k]
    gain = np.ones(center.size)
    for _ in range(_ROUNDS):  # stays positive where a silent band has loud neighbours
        gain *= wanted / np.maximum(held @ gain, np.finfo(float).tiny)
    return gain


def _energy(mean_square: NDArray, edges: NDArray, center: NDArray) -> NDArray:
    """Mean squares in bands, bins across an edge divided."""
    n = edges.size - 1
    limits = np.append(center / HALF_BAND, center[-1] * HALF_BAND)
    # In bins, from the lower edge of the first one; nothing is outside of them.
    limits = np.clip((limits - edges[0]) / (edges[-1] - edges[0]) * n, 0, n)
    bands = []
    # Not as differences of a cumulative sum, which would leave quiet bands no digits.
    for low, high in zip(limits[:-1], limits[1:], strict=True):
        first, end = int(low), int(np.ceil(high))
        share = np.ones(end - first)
        if share.size:
            share[0] -= low - first
            share[-1] -= end - high
        bands.append(mean_square[..., first:end] @ share)
    return np.stack(bands, axis=-1)


def _bin_edges(bins: NDArray) -> NDArray:
    if bins.ndim != 1 or bins.size < 2:
        raise ValueError(f"a spectrum needs at least 2 bins; got {bins.size}")
    width = (bins[-1] - bins[0]) / (bins.size - 1)
    if not width > 0 or np.abs(np.diff(bins) - width).max() > 1e-6 * width:
        raise ValueError("frequencies of a narrowband spectrum must be evenly spaced and rise")
    if bins[0] < 0.5 * width * (1 - 1e-9):
        raise ValueError(f"a spectrum must start above 0 Hz, for the mean is no sound: {bins[0]:g}")
    return np.append(bins - 0.5 * width, bins[-1] + 0.5 * width)


def _sort_in(mean_square: ArrayLike, where: Array, slots: Array) -> Array:
    membership = (where[:, None] == slots).astype(float)
    return jnp.asarray(mean_square) @ membership


def third_octave(
    frequency_hz: ArrayLike, amplitude: ArrayLike
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Third-octave band levels of tones; not traceable by JAX, the bands depend on the values.

    Parameters
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies of the tones [Hz].
    amplitude : (..., n_harmonics) complex array
        Amplitudes P_m [Pa].

    Returns
    -------
    center_hz : (n_bands,) array
        Exact mid-band frequencies 1000 * 10**(k/10) of the bands that hold a tone [Hz]; no band
        where nothing turns.
    level_db : (..., n_bands) array
        Band levels [dB re 20 uPa], at least -200.

    References
    ----------
    IEC 61260-1:2014: base-ten mid-band and band-edge frequencies.
    """
    frequency, energy = np.asarray(frequency_hz), np.asarray(mean_square(amplitude))
    turning = frequency > 0
    number = np.asarray(band_number(frequency[turning]))
    bands, band_of_tone = np.unique(number, return_inverse=True)
    membership = np.eye(bands.size)[band_of_tone]
    return middle_hz(bands), np.asarray(level_db(energy[..., turning] @ membership))


@compiled
def band_number(frequency_hz: ArrayLike) -> Array:
    """Number of the third octave that holds a frequency: k of the band around 1000 * 10**(k/10) Hz.

    Parameters
    ----------
    frequency_hz : array
        Frequencies [Hz]; 0 is in band minus infinity.

    Returns
    -------
    array
        Whole band numbers, as floats; the lower edge belongs to the band. Steps have no slope: the
        derivative is zero.

    References
    ----------
    IEC 61260-1:2014, base-ten system, 5.4 and 5.5.
    """
    frequency = jax.lax.stop_gradient(jnp.asarray(frequency_hz, float))
    return jnp.floor(10 * jnp.log10(frequency / 1000) + 0.5)


def middle_hz(number: ArrayLike) -> NDArray[np.float64]:
    """Exact mid-band frequencies of third octaves.

    Parameters
    ----------
    number : array
        Band numbers, those of `band_number`.

    Returns
    -------
    array
        Frequencies 1000 * 10**(k/10) [Hz].
    """
    return np.asarray(1000.0 * 10.0 ** (np.asarray(number) / 10.0))

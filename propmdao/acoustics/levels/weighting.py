"""A-weighting, and the levels that it gives."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.levels.decibels import level_db, mean_square


def oaspl_dba(frequency_hz: ArrayLike, amplitude: ArrayLike) -> Array:
    """A-weighted overall level of all tones together.

    Parameters
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies of the tones [Hz].
    amplitude : (..., n_harmonics) complex array
        Amplitudes P_m [Pa].

    Returns
    -------
    (...,) array
        Levels [dBA re 20 uPa], at least -200.
    """
    return level_dba(frequency_hz, mean_square(amplitude))


def level_dba(frequency_hz: ArrayLike, mean_square: ArrayLike) -> Array:
    """A-weighted overall level of mean squares at frequencies: tones, bins or bands together.

    Parameters
    ----------
    frequency_hz : (n,) array
        Frequencies of tones or bins, mid-band frequencies of third octaves [Hz].
    mean_square : (..., n) array
        Mean-square pressures [Pa^2].

    Returns
    -------
    (...,) array
        Levels [dBA re 20 uPa], at least -200.
    """
    return level_db(jnp.sum(a_weighting(frequency_hz) ** 2 * jnp.asarray(mean_square), axis=-1))


def a_weighting(frequency_hz: ArrayLike) -> Array:
    """Factor by which A-weighting multiplies the pressure of a tone.

    Parameters
    ----------
    frequency_hz : array
        Frequencies [Hz], any shape; 0 at 0 Hz, 1 at 1 kHz.

    Returns
    -------
    array
        Factor, of the shape of the frequencies; ``20 log10`` of it is the weighting in dB.

    References
    ----------
    IEC 61672-1:2013, annex E: the analytical expression and its four pole frequencies.
    """
    return _a_response(jnp.asarray(frequency_hz) ** 2) / _a_response(jnp.asarray(1e6))


def _a_response(f2: Array) -> Array:
    poles = 20.598997, 107.65265, 737.86223, 12194.217  # Hz
    low, mid1, mid2, high = (f2 + pole**2 for pole in poles)
    return f2**2 / (low * jnp.sqrt(mid1 * mid2) * high)

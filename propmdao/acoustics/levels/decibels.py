"""Levels in decibels re 20 uPa, and the pressure that tones add up to.

Amplitudes are complex P_m as `Tones` holds them, p(t) = 2 Re sum_m P_m exp(-2j pi f_m t), so that
a tone has the mean square 2 |P_m|^2. Levels are finite and differentiable everywhere, because
silence is -200 dB instead of minus infinity. That also hides what 64 bit leaves of the highest
harmonics of a slow rotor: rounding errors of about 1e-16 of the fundamental.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.runtime.compilation import compiled

REFERENCE_PRESSURE = 20e-6  # Pa, root mean square
#: Level of silence, so that levels are finite.
SILENCE_DB = -200.0
_SILENCE = 10 ** (SILENCE_DB / 10)  # of the reference mean square


def spl_db(amplitude: ArrayLike) -> Array:
    """Sound pressure level of each tone.

    Parameters
    ----------
    amplitude : (..., n_harmonics) complex array
        Amplitudes P_m [Pa].

    Returns
    -------
    (..., n_harmonics) array
        Levels [dB re 20 uPa], at least -200.
    """
    return level_db(mean_square(amplitude))


def oaspl_db(amplitude: ArrayLike) -> Array:
    """Overall sound pressure level of all tones together.

    Parameters
    ----------
    amplitude : (..., n_harmonics) complex array
        Amplitudes P_m [Pa].

    Returns
    -------
    (...,) array
        Levels [dB re 20 uPa], at least -200.
    """
    return level_db(jnp.sum(mean_square(amplitude), axis=-1))


def energy_sum_db(level_db: ArrayLike, axis: int = -1) -> Array:
    """Level of sounds that are not correlated, or of bands, together: their mean squares add.

    Parameters
    ----------
    level_db : array
        Levels [dB].
    axis : int
        Axis along which the sounds are added.

    Returns
    -------
    array
        Levels [dB], one axis less.
    """
    return 10 / np.log(10) * jax.nn.logsumexp(np.log(10) / 10 * jnp.asarray(level_db), axis=axis)


def pressure_history(
    frequency_hz: ArrayLike, amplitude: ArrayLike, n_times: int
) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
    """Pressure over one blade passage, starting with blade 1 at azimuth 0.

    Parameters
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies of the tones, multiples of the first [Hz].
    amplitude : (..., n_harmonics) complex array
        Amplitudes P_m [Pa].
    n_times : int
        Number of equally spaced times, more than 2 n_harmonics.

    Returns
    -------
    time : (n_times,) array
        Times from 0 up to, not including, the passage 1 / f_1 [s].
    pressure : (..., n_times) array
        Pressure without its mean [Pa].

    Raises
    ------
    ValueError
        If there are too few times for the harmonics, the frequencies are not multiples of the
        first, or the rotor stands still.
    """
    passage_hz = passage_frequency(frequency_hz)
    amplitude = np.asarray(amplitude)
    n_harmonics = amplitude.shape[-1]
    if n_times <= 2 * n_harmonics:
        raise ValueError(
            f"n_times must be more than twice the {n_harmonics} harmonics; got {n_times}"
        )
    spectrum = np.zeros((*amplitude.shape[:-1], n_times // 2 + 1), complex)
    # irfft sums exp(+1j ...), the tones exp(-1j ...)
    spectrum[..., 1 : n_harmonics + 1] = n_times * np.conj(amplitude)
    return np.arange(n_times) / (n_times * passage_hz), np.fft.irfft(spectrum, n_times)


def passage_frequency(frequency_hz: ArrayLike) -> float:
    """Blade passage frequency of tones that repeat with every passage.

    Parameters
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies of the tones [Hz].

    Returns
    -------
    float
        First frequency [Hz].

    Raises
    ------
    ValueError
        If the first frequency is not positive, or the others are not its multiples 2, 3 ... in
        turn, as those of a sum of different rotors are not.
    """
    frequency = np.asarray(frequency_hz, float)
    passage_hz = float(frequency[0])
    if not passage_hz > 0:
        raise ValueError(f"the blade passage frequency must be positive [Hz]; got {passage_hz:g}")
    order = np.arange(1, frequency.size + 1)
    wrong = np.flatnonzero(~(np.abs(frequency / passage_hz - order) < 1e-6 * order))
    if wrong.size:
        raise ValueError(
            f"frequencies must be the multiples of the first, {passage_hz:g} Hz, in turn; number "
            f"{wrong[0] + 1} is {frequency[wrong[0]]:g} Hz"
        )
    return passage_hz


@compiled
def mean_square(amplitude: ArrayLike) -> Array:
    """Mean-square pressure of each tone.

    Parameters
    ----------
    amplitude : complex array
        Amplitudes P_m [Pa], any shape.

    Returns
    -------
    array
        ``2 |P_m|^2`` [Pa^2], the same shape.
    """
    p = jnp.asarray(amplitude)
    return 2 * (p.real**2 + p.imag**2)  # abs() has no derivative at silence


@compiled
def level_db(mean_square: ArrayLike) -> Array:
    """Level of mean-square pressures.

    Parameters
    ----------
    mean_square : array
        Mean-square pressures [Pa^2], any shape.

    Returns
    -------
    array
        Levels [dB re 20 uPa], at least -200, the same shape.
    """
    return 10 * jnp.log10(jnp.asarray(mean_square) / REFERENCE_PRESSURE**2 + _SILENCE)

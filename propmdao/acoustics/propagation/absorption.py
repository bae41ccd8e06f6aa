"""Absorption of sound by the air on its way to the observer (ISO 9613-1).

Pure JAX, differentiable. The spreading of sound is not in it: the formulas of the sources have it.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.signals import Tones
from propmdao.records.air import Air
from propmdao.runtime.compilation import compiled


@compiled
def absorption_db_per_m(frequency_hz: ArrayLike, air: Air) -> Array:
    """Attenuation of pure tones by still air.

    Parameters
    ----------
    frequency_hz : array
        Frequencies [Hz], any shape.
    air : Air
        State of the air; the standard states alpha to 10 % from -20 to 50 degrees Celsius.

    Returns
    -------
    array
        Attenuation alpha [dB/m], of the shape of the frequencies.

    References
    ----------
    ISO 9613-1:1993, equations 3 to 5 and annex B (vapour pressure).
    """
    f2 = jnp.asarray(frequency_hz, float) ** 2
    t = air.temperature / 293.15
    p = air.pressure / 101325.0
    saturation = 10 ** (4.6151 - 6.8346 * (273.16 / air.temperature) ** 1.261)
    h = 100 * air.relative_humidity * saturation / p  # molar concentration of water vapour, %
    oxygen = p * (24 + 4.04e4 * h * (0.02 + h) / (0.391 + h))  # relaxation frequencies, Hz
    nitrogen = p / jnp.sqrt(t) * (9 + 280 * h * jnp.exp(-4.170 * (t ** (-1 / 3) - 1)))
    relaxation = 0.01275 * jnp.exp(-2239.1 / air.temperature) * oxygen / (oxygen**2 + f2)
    relaxation += 0.1068 * jnp.exp(-3352.0 / air.temperature) * nitrogen / (nitrogen**2 + f2)
    return 8.686 * f2 * (1.84e-11 * jnp.sqrt(t) / p + relaxation / t**2.5)


def absorb(mean_square: ArrayLike, frequency_hz: ArrayLike, distance: ArrayLike, air: Air) -> Array:
    """Mean squares of tones, bins or bands after their way through the air.

    Parameters
    ----------
    mean_square : (..., n) array
        Mean-square pressures [Pa^2] without absorption.
    frequency_hz : (n,) or (..., n) array
        Frequencies (mid-band frequencies of third octaves) as fixed observers hear them [Hz].
    distance : (...,) array
        Distance that the sound travels from emission to reception [m].
    air : Air
        State of the air.

    Returns
    -------
    (..., n) array
        Mean-square pressures after the way through the air [Pa^2].

    Notes
    -----
    A band is treated as a tone in its middle. Its lower half comes through better than that: a
    quarter of a decibel more where the middle loses 15 dB, 1.2 dB where it loses 30 dB.
    """
    travelled = jnp.asarray(distance, float)[..., None]
    return jnp.asarray(mean_square) * 10 ** (
        -0.1 * absorption_db_per_m(frequency_hz, air) * travelled
    )


def absorb_tones(tones: Tones, distance: ArrayLike, air: Air, doppler: ArrayLike = 1.0) -> Tones:
    """Tones after their way through the air.

    Parameters
    ----------
    tones : Tones
        Tones at (n_observers,) without absorption.
    distance : (n_observers,) array
        Distance that the sound travels from emission to reception [m].
    air : Air
        State of the air.
    doppler : float or (n_observers,) array
        Frequency in the air over that which the observers hear, see `way_flying_along`.

    Returns
    -------
    Tones
        Attenuated tones; the phase is not changed, for the dispersion of air is below 0.1 m/s.
    """
    travelled = jnp.asarray(distance, float)[..., None]
    frequency_hz = tones.frequency_hz * jnp.asarray(doppler, float)[..., None]
    factor = 10 ** (-0.05 * absorption_db_per_m(frequency_hz, air) * travelled)
    return tones.each(lambda amplitude: amplitude * factor)

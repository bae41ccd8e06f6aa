"""Reflection by hard ground: the sound at the observer and at the mirrored place, together."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.levels.bands import HALF_BAND
from propmdao.acoustics.signals import Tones


def mirrored(
    positions: ArrayLike, height: ArrayLike, up: tuple[float, float, float] = (0.0, 0.0, 1.0)
) -> Array:
    """Images of observers in a hard, plane ground, which hear what the ground reflects.

    A rotor and its image below the ground are heard here as the rotor alone is heard here and at
    the mirrored place: so reflection needs no second rotor, but the same sources at twice as many
    observers. Tones and records of pressure of the two ways add in phase (``direct + reflected``);
    broadband noise, whose two ways may differ by many wavelengths, by `bands_with_reflection`.

    Parameters
    ----------
    positions : (..., 3) array
        Positions of the observers [m], from the rotor centre or, with height 0, from a point of the
        ground.
    height : float
        Height of the origin above the ground [m].
    up : (3,) sequence
        Unit vector away from the ground, in the axes of `positions`: the default is for a rotor
        that hovers; for a propeller in level flight it is perpendicular to the rotor axis.

    Returns
    -------
    (..., 3) array
        Mirrored positions of the observers [m].
    """
    x, n = jnp.asarray(positions, float), jnp.asarray(up, float)
    return x - 2 * (x @ n + height)[..., None] * n


def bands_with_reflection(
    direct: ArrayLike, reflected: ArrayLike, band_hz: ArrayLike, delay: ArrayLike
) -> Array:
    """Broadband noise over hard ground: the two ways together, as far as they interfere.

    Parameters
    ----------
    direct, reflected : (..., n_bands) arrays
        Mean squares in third octaves at the observers and at their `mirrored` positions [Pa^2].
    band_hz : (n_bands,) or (..., n_bands) array
        Mid-band frequencies [Hz].
    delay : (...,) array
        Time by which the reflected sound comes later [s].

    Returns
    -------
    (..., n_bands) array
        Mean squares of both ways together [Pa^2].

    Notes
    -----
    Noise of even density over a band, from a point: 6 dB where the delay is short beside the
    period, 3 dB where it is long, waves in between.
    """
    first, second = jnp.asarray(direct, float), jnp.asarray(reflected, float)
    f, late = jnp.asarray(band_hz, float), jnp.asarray(delay, float)[..., None]
    width, middle = f * (HALF_BAND - 1 / HALF_BAND), 0.5 * f * (HALF_BAND + 1 / HALF_BAND)
    together = jnp.cos(2 * jnp.pi * middle * late) * jnp.sinc(width * late)
    return first + second + 2 * jnp.sqrt(first * second) * together


def on_hard_ground(tones: Tones) -> Tones:
    """Tones at microphones flush with a hard ground: twice the pressure, 6 dB at any frequency.

    Parameters
    ----------
    tones : Tones
        Tones without ground.

    Returns
    -------
    Tones
        Tones with the ground. Mean squares of broadband noise are four times as high there.
    """
    return tones + tones

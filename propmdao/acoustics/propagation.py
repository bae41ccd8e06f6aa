"""What the way to the observer does to sound: absorption by the air, reflection by the ground.

Pure JAX, differentiable. Spreading is none of it: the sources' formulas have it.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.formulation1a import Tones
from propmdao.records import Scalar, record

_HALF_BAND = 10**0.05  # from the middle of a third octave to its edge


@record
class Air:
    """State of the air between the rotor and the observer; the international standard's, humid.

    Attributes
    ----------
    temperature : scalar
        [K].
    relative_humidity : scalar
        0 ... 1, of the vapour pressure over water.
    pressure : scalar
        [Pa].
    """

    temperature: Scalar = 288.15
    relative_humidity: Scalar = 0.7
    pressure: Scalar = 101325.0


def require_known_air(air: Air) -> None:
    """Refuse air of which the standard does not say how it absorbs; not traceable by JAX.

    Parameters
    ----------
    air : Air
        Its state.

    Raises
    ------
    ValueError
        If it is outside -20 to 50 degrees Celsius, 0 to 100 % and 1 to 200 kPa.
    """
    for name, value, low, high, unit in (
        ("temperature", air.temperature - 273.15, -20.0, 50.0, "degrees Celsius"),
        ("relative humidity", 100 * air.relative_humidity, 0.0, 100.0, "%"),
        ("pressure", air.pressure, 1e3, 200e3, "Pa"),
    ):
        if not low - 1e-9 <= float(value) <= high + 1e-9:
            raise ValueError(
                f"absorption: {name} must be within {low:g} ... {high:g} {unit}; it is {value:g}"
            )


def absorption_db_per_m(frequency_hz: ArrayLike, air: Air) -> Array:
    """Attenuation of pure tones by still air.

    Parameters
    ----------
    frequency_hz : array
        Frequencies [Hz], any shape.
    air : Air
        Its state; the standard gives 10 % in alpha from -20 to 50 degrees Celsius.

    Returns
    -------
    array
        alpha [dB/m], the same shape.

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
        Their frequencies, mid-band ones of third octaves, as fixed observers hear them [Hz].
    distance : (...,) array
        Way of the sound from emission to reception [m].
    air : Air
        Its state.

    Returns
    -------
    (..., n) array
        Mean-square pressures [Pa^2].

    Notes
    -----
    A band is treated as a tone in its middle. Its lower half comes through better than that: a
    quarter of a decibel more where the middle loses 15 dB, 1.2 dB where it loses 30 dB.
    """
    way = jnp.asarray(distance, float)[..., None]
    return jnp.asarray(mean_square) * 10 ** (-0.1 * absorption_db_per_m(frequency_hz, air) * way)


def way_flying_along(positions: ArrayLike, mach: Scalar) -> tuple[Array, Array]:
    """Way of the sound to observers that fly along with its source, along +z.

    Parameters
    ----------
    positions : (..., 3) array
        From the source, at the same time [m].
    mach : float
        Of the flight, below 1.

    Returns
    -------
    distance : (...,) array
        From the source at emission to the observer at reception [m].
    doppler : (...,) array
        Frequency in the air at rest over that which the observers hear, who move like the source.
    """
    x = jnp.asarray(positions, float)
    # While the sound travels the observer flies on: d is the root of d = |x + M d e_z|.
    ahead, beta2 = mach * x[..., 2], 1 - mach**2
    d = (ahead + jnp.sqrt(ahead**2 + beta2 * jnp.sum(x**2, axis=-1))) / beta2
    return d, 1 / (1 - mach * (x[..., 2] / d + mach))


def absorb_tones(tones: Tones, distance: ArrayLike, air: Air, doppler: ArrayLike = 1.0) -> Tones:
    """Tones after their way through the air.

    Parameters
    ----------
    tones : Tones
        At (n_observers,) without absorption.
    distance : (n_observers,) array
        Way of the sound from emission to reception [m].
    air : Air
        Its state.
    doppler : float or (n_observers,) array
        Frequency in the air over that which the observers hear, see `way_flying_along`.

    Returns
    -------
    Tones
        Attenuated; the phase is not changed, for the dispersion of air is below 0.1 m/s.
    """
    way = jnp.asarray(distance, float)[..., None]
    frequency_hz = tones.frequency_hz * jnp.asarray(doppler, float)[..., None]
    factor = 10 ** (-0.05 * absorption_db_per_m(frequency_hz, air) * way)
    return Tones(tones.frequency_hz, tones.thickness * factor, tones.loading * factor)


def mirrored(
    positions: ArrayLike, height: ArrayLike, up: tuple[float, float, float] = (0.0, 0.0, 1.0)
) -> Array:
    """Images of observers in a hard, plane ground: what they hear is what the ground reflects.

    A rotor and its image below the ground are heard here as the rotor alone is heard here and at
    the mirrored place: so reflection needs no second rotor, but the same sources at twice as many
    observers. The sums are `with_reflection` for tones and records of pressure, in phase, and of
    the mean squares for broadband noise, whose two ways differ by many wavelengths.

    Parameters
    ----------
    positions : (..., 3) array
        Observers [m], from the rotor centre or, with height 0, from a point of the ground.
    height : float
        Of the origin above the ground [m].
    up : (3,) sequence
        Unit vector away from the ground, in the axes of `positions`: the default is for a rotor
        that hovers; a propeller in level flight has it across its axis.

    Returns
    -------
    (..., 3) array
        Mirrored positions [m].
    """
    x, n = jnp.asarray(positions, float), jnp.asarray(up, float)
    return x - 2 * (x @ n + height)[..., None] * n


def with_reflection(direct: Tones, reflected: Tones) -> Tones:
    """Tones over hard ground: pressures of the two ways together, each with its own phase.

    Parameters
    ----------
    direct, reflected : Tones
        At the observers and at their `mirrored` positions.

    Returns
    -------
    Tones
        Their sum: up to 6 dB more, or next to nothing where the ways differ by half a wave.
    """
    return Tones(
        direct.frequency_hz,
        direct.thickness + reflected.thickness,
        direct.loading + reflected.loading,
    )


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
        By which the reflected sound comes later [s].

    Returns
    -------
    (..., n_bands) array
        Mean squares [Pa^2].

    Notes
    -----
    Noise of even density over a band, from a point: 6 dB where the delay is short beside the
    period, 3 dB where it is long, waves in between.
    """
    one, other = jnp.asarray(direct, float), jnp.asarray(reflected, float)
    f, late = jnp.asarray(band_hz, float), jnp.asarray(delay, float)[..., None]
    width, middle = f * (_HALF_BAND - 1 / _HALF_BAND), 0.5 * f * (_HALF_BAND + 1 / _HALF_BAND)
    together = jnp.cos(2 * jnp.pi * middle * late) * jnp.sinc(width * late)
    return one + other + 2 * jnp.sqrt(one * other) * together


def on_hard_ground(tones: Tones) -> Tones:
    """Tones at microphones flush with a hard ground: twice the pressure, 6 dB at any frequency.

    Parameters
    ----------
    tones : Tones
        Without ground.

    Returns
    -------
    Tones
        With it. Mean squares of broadband noise are four times as high there.
    """
    return with_reflection(tones, tones)

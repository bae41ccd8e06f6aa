"""Noise of a flat plate in turbulence: strips of a blade or wing, one by one (Amiet, 1975)."""

from __future__ import annotations

import math

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.boundary_layer import nonzero_chord, nonzero_speed
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.smooth import at_least
from propmdao.acoustics.inflow.gust_response import response_squared
from propmdao.records.air import Air, Turbulence

#: Width of a third octave over its mid-band frequency.
_BANDWIDTH = 10**0.05 - 10**-0.05
#: Wavenumber of the energy-containing eddies times the length scale, 0.7468.
_ENERGY = math.sqrt(math.pi) * math.gamma(5 / 6) / math.gamma(1 / 3)
_LEAST_APPROACH = 0.01  # 1 - M cos xi of a section near the speed of sound


def upwash_spectrum(chordwise: ArrayLike, spanwise: ArrayLike, turbulence: Turbulence) -> Array:
    """Spectrum of the velocity normal to a plate in isotropic turbulence, of two wavenumbers.

    Parameters
    ----------
    chordwise, spanwise : array
        Wavenumbers along the chord and along the span [rad/m].
    turbulence : Turbulence
        Intensity and length scale of the turbulence.

    Returns
    -------
    array
        Spectrum that gives the squared intensity when it is integrated over all wavenumbers, of
        both signs [m^4/s^2].

    References
    ----------
    Von Karman's spectrum of energy, integrated as R. K. Amiet, J. Sound Vib. 41 (1975).
    """
    intensity, length = turbulence.turbulence_intensity, turbulence.turbulence_length_scale
    # Without turbulence its scale does not matter and may be 0.
    energy = _ENERGY / jnp.where(length > 0.0, length, 1.0)
    square = (jnp.square(chordwise) + jnp.square(spanwise)) / energy**2
    return 4 / (9 * np.pi) * jnp.square(intensity / energy) * square / (1 + square) ** (7 / 3)


def inflow_noise(
    frequency_hz: ArrayLike,
    section: Section,
    turbulence: Turbulence,
    sight: tuple[ArrayLike, ArrayLike, ArrayLike],
    approach: ArrayLike,
    air: Air,
) -> Array:
    """Third-octave mean squares of strips in turbulence.

    Parameters
    ----------
    frequency_hz : array
        Mid-band frequencies at the source, positive [Hz].
    section : Section
        Strips and the flow over them; chord, span and speed count.
    turbulence : Turbulence
        Turbulence that flows in.
    sight : tuple of three arrays
        Components of the vector from the strip, at its place at emission, to the observer: along
        the chord (from leading to trailing edge), along the span, and normal to both [m].
    approach : array
        1 - M cos xi, with the Mach number M at which the strip moves through the undisturbed air
        and the angle xi between this motion and the way to the observer; of an airfoil at rest in
        a stream ``1 + M x / r``.
    air : Air
        The undisturbed air.

    Returns
    -------
    array
        Mean-square pressure [Pa^2], of the shape to which frequency, section and sight broadcast.

    Notes
    -----
    Each strip is a flat plate without thickness at no incidence, long against the eddies and the
    sound. The middle of a band stands for all of it: against nine frequencies in each band a plate
    of many wavelengths is 1.2 dB off at its interference, a small rotor 0.1 dB.

    References
    ----------
    R. K. Amiet, Acoustic radiation from an airfoil in a turbulent stream, J. Sound Vib. 41 (1975).
    """
    x, y, z = (jnp.asarray(component) for component in sight)
    distance = jnp.sqrt(x * x + y * y + z * z)
    speed, semichord = nonzero_speed(section.speed), 0.5 * nonzero_chord(section.chord)
    mach = speed / air.sound_speed
    # Amiet's observer is seen from where the plate would be when he hears it, sigma in a stretched
    # frame away from it: the distance at emission times 1 - M cos xi.
    toward = at_least(1 + mach * x / distance, _LEAST_APPROACH)
    along, across = (x / distance + mach) / toward, y / (distance * toward)
    sigma2 = jnp.square(distance * at_least(approach, _LEAST_APPROACH))

    omega = 2 * np.pi * jnp.asarray(frequency_hz)
    spectrum = upwash_spectrum(omega / speed, omega / air.sound_speed * across, turbulence)
    response = response_squared(omega * semichord / speed, mach, along, across)
    dipole = omega * air.density * semichord * z / (air.sound_speed * sigma2)
    # Two-sided in angular frequency, per rad/s; in a band it is 4 pi times its width in Hz.
    density = dipole**2 * np.pi * speed * 0.5 * section.span * spectrum * response
    return 4 * np.pi * _BANDWIDTH * jnp.asarray(frequency_hz) * density

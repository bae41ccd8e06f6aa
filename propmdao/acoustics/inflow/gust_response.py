"""Lift of a flat plate in gusts, as it is heard: Amiet's response in closed form.

Symbols are Amiet's: lengths over the semi-chord b, K = omega b / U, beta^2 = 1 - M^2,
mu = M K / beta^2, sigma^2 = x^2 + beta^2 (y^2 + z^2) with the observer seen from where the plate
would be when he hears it.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.smooth import at_least, smooth_step

# Amiet changes at mu = 0.4 from the one response to the other, where they differ by up to 1.3 dB.
# They cross between 0.2 and 0.45: here one goes over into the other from 0.19 to 0.48.
_CHANGE, _CHANGE_WIDTH = 0.3, np.log(1.6)
_LEAST_PHASE = 1e-4  # of a phase by which something is divided that vanishes with it
_LEAST_BETA2 = 0.01  # of a section next to the speed of sound
_N_TERMS = 16  # of the Faddeeva function: error 9e-8


def fresnel(x: ArrayLike) -> Array:
    """Conjugate of the complex Fresnel integral, ``int_0^x exp(-i t) / sqrt(2 pi t) dt``.

    Parameters
    ----------
    x : array
        Positive numbers.

    Returns
    -------
    array
        Complex values, within 1e-7.

    Notes
    -----
    (1 - i) / 2 erf(sqrt(i x)), with erf from the Faddeeva function.

    References
    ----------
    J. A. C. Weideman, Computation of the complex error function, SIAM J. Numer. Anal. 31 (1994).
    """
    x = jnp.asarray(x, float)
    i_zeta = np.exp(0.75j * np.pi) * jnp.sqrt(x)
    inverse = 1 / (_SCALE - 1j * i_zeta)
    ratio = (_SCALE + 1j * i_zeta) * inverse
    series = jnp.full_like(ratio, _TERMS[0])
    for term in _TERMS[1:]:
        series = series * ratio + term
    faddeeva = (2 * series * inverse + 1 / np.sqrt(np.pi)) * inverse
    return (0.5 - 0.5j) * (1 - jnp.exp(-1j * x) * faddeeva)


def _faddeeva_terms(n: int) -> tuple[float, tuple[float, ...]]:
    """Scale and coefficients, highest power first, of Weideman's series with n terms."""
    scale = float(np.sqrt(n / np.sqrt(2)))
    theta = np.arange(-2 * n + 1, 2 * n) * np.pi / (2 * n)
    t = scale * np.tan(theta / 2)
    values = np.concatenate([[0.0], np.exp(-(t**2)) * (scale**2 + t**2)])
    transform = np.fft.fft(np.fft.fftshift(values)).real / (4 * n)
    return scale, tuple(float(term) for term in transform[n:0:-1])


_SCALE, _TERMS = _faddeeva_terms(_N_TERMS)


def sears_squared(reduced_frequency: ArrayLike) -> Array:
    """Square of the modulus of Sears' function, the lift of a plate in an incompressible gust.

    Parameters
    ----------
    reduced_frequency : array
        omega b / U, positive.

    Returns
    -------
    array
        1 in slow gusts, 1 / (2 pi K) in fast ones; within 1 % of Sears' own.

    References
    ----------
    The interpolation is that of P. Moriarty, P. Migliore, NREL/TP-500-34478 (2003).
    """
    k = jnp.asarray(reduced_frequency)
    return 1 / (2 * np.pi * k + 1 / (1 + 2.4 * k))


def response_squared(
    reduced_frequency: ArrayLike, mach: ArrayLike, chordwise: ArrayLike, spanwise: ArrayLike
) -> Array:
    """Square of the modulus of a plate's acoustic response to the gusts that an observer hears.

    Of all gusts the one is heard whose spanwise wavenumber is that of the sound toward the
    observer, ``omega y / (c0 sigma)``: the plate is long against it.

    Parameters
    ----------
    reduced_frequency : array
        K = omega b / U, positive.
    mach : array
        Mach number of the flow along the chord.
    chordwise, spanwise : array
        x / sigma and y / sigma of the observer.

    Returns
    -------
    array
        |L|^2, of the shape to which the arguments broadcast.

    Notes
    -----
    Of slow gusts, against which the chord is compact, Sears' function with the compressible
    correction of the plane gust; of fast ones the solution of the half plane with a leading edge
    and the first correction by the trailing edge. Between them the square of one goes over into the
    other's, for kappa, which is mu of the plane gust that an oblique one is similar to, from 0.19
    to 0.48; the two are never more than 1.5 dB apart there.

    References
    ----------
    R. K. Amiet, Acoustic radiation from an airfoil in a turbulent stream, J. Sound Vib. 41 (1975);
    for oblique gusts M. Roger, S. Moreau, Int. J. Aeroacoustics 9 (2010), and J. M. R. Graham,
    Similarity rules for thin aerofoils in non-stationary subsonic flows, J. Fluid Mech. 43 (1970).
    """
    k, x = jnp.asarray(reduced_frequency), jnp.asarray(chordwise)
    beta2 = at_least(1 - jnp.square(mach), _LEAST_BETA2)
    mu = jnp.asarray(mach) * k / beta2
    # An observer straight along the span hears nothing, but at a slope.
    kappa = mu * jnp.sqrt(at_least(1 - beta2 * jnp.square(spanwise), _LEAST_PHASE**2))
    fast = smooth_step(jnp.log(kappa / _CHANGE), _CHANGE_WIDTH)
    return (1 - fast) * _slow(k, beta2, mu * x) + fast * _fast(k, beta2, kappa, mu * x)


def _slow(k: Array, beta2: Array, phase: Array) -> Array:
    """|L|^2 of slow gusts: |S(K / beta^2)|^2 / beta^2 (J0^2 + J1^2)(mu x / sigma)."""
    # Half the chord is less than a radian here, so that three terms of the series are exact.
    p = jnp.square(jnp.clip(phase, -1.0, 1.0))
    bessel = 1 - p / 4 + p**2 / 32 - 5 * p**3 / 2304
    return sears_squared(k / beta2) / beta2 * bessel


def _fast(k: Array, beta2: Array, kappa: Array, phase: Array) -> Array:
    """|L|^2 of fast gusts."""
    ahead = at_least(kappa - phase, _LEAST_PHASE)  # Theta_1
    behind = at_least(kappa + phase, _LEAST_PHASE)
    turned = jnp.exp(-2j * ahead)
    leading = jnp.sqrt(4 * np.pi * ahead) * fresnel(2 * ahead)
    trailing = fresnel(4 * kappa) - jnp.sqrt(2 * kappa / behind) * turned * fresnel(2 * behind)
    trailing = 1j * (1 - turned) + (1 - 1j) * trailing
    both = (leading + trailing) / ahead
    square = jnp.square(both.real) + jnp.square(both.imag)
    return square / (2 * np.pi**3 * (k + beta2 * kappa))

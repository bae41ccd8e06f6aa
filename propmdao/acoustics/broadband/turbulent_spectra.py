"""Spectral shapes A and B and amplitudes K1, delta K1, K2 of trailing-edge noise.

Symbols and equation numbers are those of Brooks, Pope and Marcolini, NASA RP-1218 (1989). Their
pieces of A and B miss each other by up to 0.002 dB and are moved to meet; the others are rounded by
less than 0.15 dB where not said otherwise. Angles are in degrees, levels in dB.
"""

from __future__ import annotations

from math import sqrt
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.broadband.smooth import ramp

_LOG_RE_CORNER = 0.02
_LOW_RE, _HIGH_RE = 9.52e4, 8.57e5
_ANGLE_CORNER = 0.25  # deg
_START = 0.02  # of the ellipse's height, where its vertical start is cut off
_END_OF_K2 = -12.0  # dB, far beyond the stall
_LEVEL_CORNER = 1.0  # dB


class _Curve(NamedTuple):
    """Line (start, slope, intercept) that follows the arc of a shape, and a cubic beyond `end`."""

    line: tuple[float, float, float]
    end: float
    cubic: tuple[float, float, float, float]


class Shape(NamedTuple):
    """Spectral shape between its curves at the lowest and at the highest Reynolds number.

    Attributes
    ----------
    height, offset : float
        Numbers of the arc around the peak.
    low, high : curve
        Line and cubic at the lowest and at the highest Reynolds number, A_min and A_max.
    reference : (2,) tuple of float
        Abscissa at which the shape is -20 dB, at the lowest and at the highest Reynolds number.
    """

    height: float
    offset: float
    low: _Curve
    high: _Curve
    reference: tuple[float, float]

    def level(self, x: Array, interpolation: Array) -> Array:
        """Level relative to the peak (equations 40, 46).

        Parameters
        ----------
        x : array
            log10 of the Strouhal number over its peak value, of either sign (37, 43).
        interpolation : array
            Interpolation factor of the Reynolds number.

        Returns
        -------
        array
            Level [dB], 0 at the peak.
        """
        x = jnp.abs(x)
        low, high = (self._at(x, curve) for curve in (self.low, self.high))
        return low + interpolation * (high - low)

    def interpolation(self, reynolds: Array) -> Array:
        """Interpolation factor between the two curves (equations 38, 39 and 44, 45).

        Parameters
        ----------
        reynolds : array
            Reynolds number of the chord.

        Returns
        -------
        array
            Factor A_R(a0) or B_R(b0): 0 at the lower curve, 1 at the higher one.
        """
        x = _between_reynolds(reynolds, *self.reference)
        low, high = self.level(x, jnp.asarray(0.0)), self.level(x, jnp.asarray(1.0))
        return (-20.0 - low) / (high - low)

    def _at(self, x: Array, curve: _Curve) -> Array:
        start, slope, intercept = curve.line
        # The arc is evaluated where its root is real: the branch not taken must not make a NaN.
        root = jnp.sqrt(self.height - 886.788 * jnp.square(jnp.minimum(x, start)))
        c3, c2, c1, c0 = curve.cubic
        tail = ((c3 * x + c2) * x + c1) * x + c0
        # The report's pieces miss each other by its rounding: each begins where the last one ends.
        end = curve.end
        to_arc = sqrt(self.height - 886.788 * start**2) - self.offset - (slope * start + intercept)
        to_line = slope * end + intercept + to_arc - (((c3 * end + c2) * end + c1) * end + c0)
        line_and_cubic = jnp.where(x < end, slope * x + intercept + to_arc, tail + to_line)
        return jnp.where(x < start, root - self.offset, line_and_cubic)


#: Shape A of attached flow (equations 35, 36).
SHAPE_A = Shape(
    67.552,
    8.219,
    low=_Curve((0.204, -32.665, 3.981), 0.244, (-142.795, 103.656, -57.757, 6.006)),
    high=_Curve((0.13, -15.901, 1.098), 0.321, (-4.669, 3.491, -16.699, 1.149)),
    reference=(0.57, 1.13),
)
#: Shape B of separated flow (equations 41, 42).
SHAPE_B = Shape(
    16.888,
    4.109,
    low=_Curve((0.13, -83.607, 8.138), 0.145, (-817.810, 355.210, -135.024, 10.619)),
    high=_Curve((0.10, -31.330, 1.854), 0.187, (-80.541, 44.174, -39.381, 2.344)),
    reference=(0.30, 0.56),
)


def _between_reynolds(reynolds: Array, low: float, high: float) -> Array:
    """Constant, a parabola, constant.

    The report's parabola of a0 misses the lower constant by 0.005; this one meets it. That changes
    the interpolation factor by 0.03 at most.
    """
    floor = _LOW_RE + ramp(reynolds - _LOW_RE, 0.1 * _LOW_RE)
    rest = jnp.maximum(_HIGH_RE - floor, 0.0) / (_HIGH_RE - _LOW_RE)
    return high - (high - low) * rest**2


def strouhal_peaks(mach: Array, degrees: Array) -> tuple[Array, Array, Array]:
    """Peak Strouhal numbers (equations 32 to 34).

    Parameters
    ----------
    mach : array
        Mach number of the section.
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    st1, st1_mean, st2 : array
        Peak Strouhal numbers of the pressure side, of the suction side and of the separation.
    """
    st1 = 0.02 * mach**-0.6
    excess = jnp.maximum(12.5 - ramp(12.5 - degrees, _ANGLE_CORNER) - 1.333, 0.0)
    st2 = st1 * 10 ** (0.0054 * excess**2)
    return st1, (st1 + st2) / 2, st2


def amplitude_k1(log_reynolds: Array) -> Array:
    """Amplitude K1 (equation 47).

    Parameters
    ----------
    log_reynolds : array
        log10 of the Reynolds number of the chord.

    Returns
    -------
    array
        Level [dB].
    """
    # The pieces meet at Re 2.48e5 and 7.94e5, where the report prints 2.47e5 and 8.0e5.
    first, second = (181.6 - 156.3) / (9.0 - 4.31), (181.6 - 128.5) / 9.0
    x = log_reynolds
    bend = (4.31 - 9.0) * ramp(x - first, _LOG_RE_CORNER) + 9.0 * ramp(x - second, _LOG_RE_CORNER)
    return 156.3 - 4.31 * x + bend


def pressure_side_correction(log_reynolds_displacement: Array, degrees: Array) -> Array:
    """Level taken from the pressure side at an angle, delta K1 (equation 48).

    Parameters
    ----------
    log_reynolds_displacement : array
        log10 of the Reynolds number of the pressure side's displacement thickness.
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    array
        Level [dB], not positive.
    """
    return -degrees * ramp(5.29 - 1.43 * log_reynolds_displacement, 0.05)


def separation_amplitude(mach: Array, degrees: Array) -> Array:
    """Amplitude of the angle-dependent noise, K2 - K1 (equations 49, 50).

    An ellipse over the angle. The report steps from nothing to its vertical start and, at its
    vertical end, up to -12 dB. Here the start is a tangent that falls steeply (2 dB too much at the
    report's step, where this noise is 15 dB and more below that of the suction side), and at the
    end the ellipse stops falling at -12 dB instead of returning to it.

    Parameters
    ----------
    mach : array
        Mach number of the section.
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    array
        Level above K1 [dB].
    """
    gamma, gamma_0 = 27.094 * mach + 3.31, stall_angle_of_ellipse(mach)
    beta, beta_0 = 72.650 * mach + 10.74, -34.190 * mach - 13.820
    u = 1 - ((degrees - gamma_0) / gamma) ** 2
    root = jnp.sqrt(jnp.maximum(u, _START)) + jnp.minimum(u - _START, 0.0) / (2 * _START**0.5)
    ellipse = beta * root + beta_0
    floored = _END_OF_K2 + ramp(ellipse - _END_OF_K2, _LEVEL_CORNER)
    return jnp.where(degrees > gamma_0, floored, ellipse)


def stall_angle_of_ellipse(mach: Array) -> Array:
    """Angle of the largest K2, gamma_0 (equation 50).

    Parameters
    ----------
    mach : array
        Mach number of the section.

    Returns
    -------
    array
        Angle [deg].
    """
    return 23.430 * mach + 4.651


def stall_angle(mach: Array) -> Array:
    """Angle at which the noise of separation replaces that of the attached layers (page 62).

    Parameters
    ----------
    mach : array
        Mach number of the section.

    Returns
    -------
    array
        Stall angle [deg]: gamma_0, at most 12.5.
    """
    return 12.5 - ramp(12.5 - stall_angle_of_ellipse(mach), _ANGLE_CORNER)

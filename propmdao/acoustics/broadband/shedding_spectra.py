"""Shapes G1 to G5: laminar vortex shedding and vortices shed by a blunt trailing edge.

Symbols and equation numbers are those of Brooks, Pope and Marcolini, NASA RP-1218 (1989). Where
their pieces meet at an angle, the corner is rounded, by less than 0.15 dB; the bound of G5 for a
thin trailing edge by 1.25 % of its level. Angles are in degrees, levels in dB.
"""

from __future__ import annotations

from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.broadband.smooth import ramp, smooth_step

_LOG_CORNER = 0.01
_RATIO_CORNER = 0.01  # of h / delta*
_SHARE_CORNER = 0.05  # of the level at which a shape is bounded
_LARGEST_ANGLE, _ANGLE_CORNER = 30.0, 10.0  # of a trailing edge [deg]
_PLATE_CORNER = 2.0  # of the same [deg]
_LARGEST_RATIO = 2.0  # h / delta*, far above 1.2, where the curves stop changing


def laminar_shape(x: Array) -> Array:
    """Spectral shape G1 (equation 57).

    Parameters
    ----------
    x : array
        log10 of the Strouhal number over its peak value.

    Returns
    -------
    array
        Level [dB].
    """
    x = jnp.abs(x)
    inner = jnp.minimum(x, 0.0683)  # arc and line meet there with one slope
    arc = -5.076 + jnp.sqrt(2.484 - 506.25 * inner**2)
    return arc - 98.409 * (x - inner) + (98.409 - 39.8) * ramp(x - 0.22375, _LOG_CORNER)


def laminar_reynolds_level(log_reynolds: Array, degrees: Array) -> Array:
    """Level over the Reynolds number, G2 (equations 58, 59).

    Parameters
    ----------
    log_reynolds : array
        log10 of the Reynolds number of the chord.
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    array
        Level [dB], 0 at the Reynolds number of the strongest shedding.
    """
    log_loudest = 4.978 + 0.215 * degrees - (0.215 - 0.120) * ramp(degrees - 3.0, 0.25)
    x = jnp.abs(log_reynolds - log_loudest)
    excess = ramp(x - 0.245, _LOG_CORNER)
    steep = -65.188 * excess - (77.852 - 65.188) * ramp(x - 0.4898, _LOG_CORNER)
    return -114.052 * (x - excess) ** 2 + steep


def laminar_angle_level(degrees: Array) -> Array:
    """Level over the angle, G3 (equation 60).

    Parameters
    ----------
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    array
        Level [dB].
    """
    return 171.04 - 3.03 * degrees


def laminar_strouhal_peak(log_reynolds: Array, degrees: Array) -> Array:
    """log10 of the peak Strouhal number St' (equations 55, 56).

    Parameters
    ----------
    log_reynolds : array
        log10 of the Reynolds number of the chord.
    degrees : array
        Angle of attack [deg], not negative.

    Returns
    -------
    array
        log10 of the peak Strouhal number St'_peak.
    """
    start = jnp.log10(1.3e5)
    end = start + jnp.log10(0.28 / 0.18) / 0.3931  # Re 4.0e5
    rise = ramp(log_reynolds - start, _LOG_CORNER) - ramp(log_reynolds - end, _LOG_CORNER)
    return jnp.log10(0.18) + 0.3931 * rise - 0.04 * degrees


def bounded_edge_angle(edge_degrees: Array) -> Array:
    """Trailing-edge angle as far as the formulas of bluntness noise go.

    The report measured 0 and 14 deg and interpolates linearly between them. Beyond, its lines are
    continued, but not for ever: the peak Strouhal number would be zero at 39 deg for a thin edge.

    Parameters
    ----------
    edge_degrees : array
        Angle between the surfaces at the trailing edge, Psi [deg].

    Returns
    -------
    array
        Angle [deg], the same from 0 to 20, then bending smoothly toward 30, and toward -2 where
        the thickness grows toward the edge.
    """
    from_above = _LARGEST_ANGLE - ramp(_LARGEST_ANGLE - edge_degrees, _ANGLE_CORNER)
    return ramp(from_above + _PLATE_CORNER, _PLATE_CORNER) - _PLATE_CORNER


def blunt_strouhal_peak(ratio: Array, edge_degrees: Array) -> Array:
    """Peak Strouhal number St''' (equation 72).

    Parameters
    ----------
    ratio : array
        Trailing-edge thickness over the mean displacement thickness, h / delta*.
    edge_degrees : array
        Angle between the surfaces at the trailing edge, Psi, from `bounded_edge_angle` [deg].

    Returns
    -------
    array
        Peak Strouhal number St'''_peak, positive.
    """
    inverse = 1 / jnp.maximum(ratio, 0.15)  # not used below 0.19
    thick = (0.212 - 0.0045 * edge_degrees) / (1 + 0.235 * inverse - 0.0132 * inverse**2)
    thin = 0.1 * ratio + 0.095 - 0.00243 * edge_degrees
    return thin + smooth_step(ratio - 0.2, _RATIO_CORNER) * (thick - thin)


def blunt_level(ratio: Array, edge_degrees: Array) -> Array:
    """Peak level G4 (equation 74).

    Parameters
    ----------
    ratio : array
        Trailing-edge thickness over the mean displacement thickness, h / delta*, positive.
    edge_degrees : array
        Angle Psi between the surfaces at the trailing edge [deg].

    Returns
    -------
    array
        Level [dB].
    """
    short_of = (169.7 - 157.5) / 17.5 - jnp.log10(ratio)  # of h / delta* = 5
    return 169.7 - 1.114 * edge_degrees - 17.5 * ramp(short_of, _LOG_CORNER)


class BluntCurve(NamedTuple):
    """Parameters of the shape of bluntness noise, one set for each strip.

    Attributes
    ----------
    mu, m, eta_0 : array
        Width, slope of the rising line, and the abscissa at which line and arc meet (equations 78
        to 80).
    """

    mu: Array | float
    m: Array | float
    eta_0: Array | float


def blunt_curve(ratio: Array) -> BluntCurve:
    """Curve of a trailing edge with Psi = 14 deg (equations 78 to 80).

    Parameters
    ----------
    ratio : array
        Ratio h / delta*; for Psi = 0 the one from `plate_ratio`.

    Returns
    -------
    BluntCurve
        Parameters of the curve.
    """
    # One ramp over all corners: (corners, ...) is a tenth of the code that eight of them make.
    corners = jnp.array([1.35 / 68.724, 0.25, 0.5, 0.62, 1.15, 1.2])
    # Large ratios would leave of the bends, which cancel there, what rounding leaves.
    within = jnp.minimum(ratio, _LARGEST_RATIO)
    bend = ramp(within[..., None] - corners, _RATIO_CORNER)
    mu = 0.1211 + bend @ jnp.array([0.0, -0.2175, 0.0, 0.2175 - 0.0308, 0.0308, 0.0])
    m = bend @ jnp.array(
        [68.724, 0.0, 308.475 - 68.724, 224.811 - 308.475, 1583.28 - 224.811, -1583.28]
    )
    return BluntCurve(mu, m, -m * mu**2 / jnp.sqrt(6.25 + (m * mu) ** 2))


def plate_ratio(ratio: Array) -> Array:
    """Ratio h / delta* of the curve that stands for a plate, Psi = 0 (equation 82).

    Parameters
    ----------
    ratio : array
        Trailing-edge thickness over the mean displacement thickness, h / delta*.

    Returns
    -------
    array
        Ratio to be given to `blunt_curve`.
    """
    return 6.724 * ratio**2 - 4.019 * ratio + 1.107


def blunt_shape(eta: Array, wedge: BluntCurve, plate: BluntCurve, edge_degrees: Array) -> Array:
    """Spectral shape G5, interpolated between Psi = 0 and 14 deg (equations 75 to 77, 81).

    Parameters
    ----------
    eta : array
        log10 of the Strouhal number over its peak value.
    wedge, plate : BluntCurve
        Curves of Psi = 14 and 0 deg.
    edge_degrees : array
        Angle Psi between the surfaces at the trailing edge [deg].

    Returns
    -------
    array
        Level [dB], which, as in the report's program, is neither above 0 nor above the curve of
        h / delta* = 0.25.
    """
    falling = _falling_flank(eta)
    at_plate, at_wedge = _rising_flank(eta, plate), _rising_flank(eta, wedge)
    shape = at_plate + 0.0714 * edge_degrees * (at_wedge - at_plate)  # 75
    broadest = _rising_flank(eta, _BROADEST)
    # Rounded in proportion to the level: all curves meet at the peak, which must stay 0.
    shape = broadest - ramp(broadest - shape, _SHARE_CORNER * jnp.abs(broadest) + 1e-9)
    shape = jnp.minimum(shape, 0.0)  # only wedges of more than 14 deg reach above
    return jnp.where(eta < 0, shape, falling)


def _rising_flank(eta: Array, curve: BluntCurve) -> Array:
    """Line and arc below the peak (76), 0 above it."""
    mu, m, eta_0 = curve
    within = jnp.clip(eta, eta_0, 0.0)  # below, the tangent m eta + k (81)
    return 2.5 * jnp.sqrt(1 - (within / mu) ** 2) - 2.5 + m * jnp.minimum(eta - eta_0, 0.0)


def _falling_flank(eta: Array) -> Array:
    """Arc and line above the peak (76), the same for all curves.

    The report's arc drops vertically onto its line at 0.03616. It is left where its slope is the
    line's, 0.137 dB above, and led down to the line.
    """
    leave, slope = 0.035298, -155.543
    arc = jnp.sqrt(1.5625 - 1194.99 * jnp.square(jnp.clip(eta, 0.0, leave))) - 1.25
    gap = 0.1366 * (1 - smooth_step(eta - leave - 0.0015, 0.0015))
    return jnp.where(eta < leave, arc, slope * eta + 4.375 + gap)


# At h / delta* = 0.25, as plain numbers: nothing is computed on import.
_BROADEST = BluntCurve(0.1211, 15.831, -0.0736924)

"""Directivity of the noise of a trailing edge over the squared distance."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.smooth import at_least
from propmdao.records.pytrees import record

_CONVECTION = 0.8  # eddies convect at this share of the flow's Mach number
# Of an observer ahead of a section near the speed of sound; the report measured up to Mach 0.21.
_LEAST_CONVECTION = 0.01
_ON_THE_EDGE = 1e-12  # of the squared distance: an observer straight ahead has no angle phi


@record
class Radiation:
    """Directivity over squared distance [1/m^2].

    Attributes
    ----------
    high : array
        D_h / r_e^2, at high frequency, the chord being many wavelengths long.
    low : array
        D_l / r_e^2, at low frequency, a compact dipole; only separated flow uses it.
    """

    high: Array
    low: Array


def radiation(
    chordwise: ArrayLike, spanwise: ArrayLike, normal: ArrayLike, mach: ArrayLike
) -> Radiation:
    """Directivity of the trailing edge of an airfoil at rest in a stream, as in a wind tunnel.

    Parameters
    ----------
    chordwise, spanwise, normal : array
        Components of the vector from the trailing edge, at its place at emission, to the observer:
        along the chord (from leading to trailing edge), along the span, and normal to both [m].
    mach : array
        Mach number of the flow over the section.

    Returns
    -------
    Radiation
        Directivities, of the shape to which the arguments broadcast.

    References
    ----------
    Brooks, Pope, Marcolini, NASA RP-1218, equations B1 and B2, with theta_e and phi_e in cosines.
    """
    x, y, z = jnp.asarray(chordwise), jnp.asarray(spanwise), jnp.asarray(normal)
    cos_theta = x / jnp.sqrt(x * x + y * y + z * z)
    moving = at_least(1 + mach * cos_theta, _LEAST_CONVECTION)
    sliding = at_least(1 + (1 - _CONVECTION) * mach * cos_theta, _LEAST_CONVECTION)
    return _convected(x, y, z, moving * sliding**2, moving**4)


def moving_radiation(
    chordwise: ArrayLike, spanwise: ArrayLike, normal: ArrayLike, approach: ArrayLike
) -> Radiation:
    """Directivity of a trailing edge that moves through air at rest, as on a rotor.

    Parameters
    ----------
    chordwise, spanwise, normal : array
        Components of the vector from the trailing edge, at its place at emission, to the observer:
        along the chord (from leading to trailing edge), along the span, and normal to both [m].
    approach : array
        1 - M cos xi, with the Mach number M at which the edge moves through the undisturbed air and
        the angle xi between this motion and the way to the observer.

    Returns
    -------
    Radiation
        Directivities, of the shape to which the arguments broadcast.

    References
    ----------
    T. F. Brooks, C. L. Burley, AIAA 2001-2210, equations 19 and 20: both directivities carry
    (1 - M cos xi)^-4.
    """
    x, y, z = jnp.asarray(chordwise), jnp.asarray(spanwise), jnp.asarray(normal)
    amplification = at_least(approach, _LEAST_CONVECTION) ** 4
    return _convected(x, y, z, amplification, amplification)


def _convected(x: Array, y: Array, z: Array, high: Array, low: Array) -> Radiation:
    """Directivities of an edge over the convective factors of high and low frequency."""
    across = y * y + z * z
    r2 = x * x + across
    cos_theta = x / jnp.sqrt(r2)
    sin2_phi = z * z / (across + _ON_THE_EDGE * r2)
    return Radiation(
        high=(1 - cos_theta) * sin2_phi / (high * r2),  # 2 sin^2(theta / 2)
        low=(z * z / r2) / (low * r2),  # sin^2 theta sin^2 phi = z^2 / r^2
    )

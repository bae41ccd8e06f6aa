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
    """Directivity of a trailing edge toward an observer.

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
    across = y * y + z * z
    r2 = x * x + across
    cos_theta = x / jnp.sqrt(r2)
    sin2_phi = z * z / (across + _ON_THE_EDGE * r2)
    moving = at_least(1 + mach * cos_theta, _LEAST_CONVECTION)
    sliding = at_least(1 + (1 - _CONVECTION) * mach * cos_theta, _LEAST_CONVECTION)
    return Radiation(
        high=(1 - cos_theta) * sin2_phi / (moving * sliding**2 * r2),  # 2 sin^2(theta / 2)
        low=(z * z / r2) / (moving**4 * r2),  # sin^2 theta sin^2 phi = z^2 / r^2
    )

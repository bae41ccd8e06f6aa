"""Compressibility of section lift, moment and drag."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np

#: Mach number up to which the correction of lift and moment grows; beyond, shocks make it
#: meaningless.
MACH_LIMIT = 0.7
#: Mach number up to which the drag rise grows: Lock's law is for the first shocks.
DRAG_RISE_LIMIT = 0.8
#: Korn's factor of conventional sections, those of the NACA 6 series (supercritical ones: 0.95).
KORN_FACTOR = 0.87
#: From the critical Mach number to that of drag divergence, where Lock's drag has the slope 0.1.
DIVERGENCE_MARGIN = (0.1 / 80.0) ** (1.0 / 3.0)
#: The corrections are whole up to the first angle of attack and gone from the second [rad].
ATTACHED, SEPARATED = np.radians(12.0), np.radians(30.0)
# Lift coefficient below which the onset of drag rise no longer feels the sign of lift.
_LITTLE_LIFT = 0.05


def prandtl_glauert(mach: jax.Array | float, alpha: jax.Array) -> jax.Array:
    """Compute the factor by which compressibility raises section lift and moment.

    Parameters
    ----------
    mach : (n,) array or number
        Mach number of the section; held at `MACH_LIMIT` beyond it, C1.
    alpha : (n,) array
        Angle of attack [rad].

    Returns
    -------
    (n,) array
        Factor 1 / sqrt(1 - M^2) where the flow is attached, fading to 1 between 12 and 30 deg: the
        rule is for small disturbances and says nothing about separated flow.

    Notes
    -----
    Glauert, Proc. R. Soc. A 118 (1928). The rule of Karman and Tsien, J. Aeronaut. Sci. 8 (1941),
    corrects the pressure at a point and needs its distribution: it raises suction by more than
    Prandtl and Glauert and pressure by less. Put on the lift coefficient in place of the pressure
    coefficient, as is often seen, it does the opposite.
    """
    return 1.0 + attached_share(alpha) * attached_gain(mach)


def attached_gain(mach: jax.Array | float) -> jax.Array:
    """Compute what `prandtl_glauert` adds to 1 where the flow is attached.

    Parameters
    ----------
    mach : (n,) array or number
        Mach number of the section.

    Returns
    -------
    (n,) array
        1 / sqrt(1 - M^2) - 1, held from `MACH_LIMIT` on.
    """
    return 1.0 / jnp.sqrt(1.0 - _held(mach, MACH_LIMIT) ** 2) - 1.0


def attached_share(alpha: jax.Array) -> jax.Array:
    """Compute how far the corrections hold at an angle of attack.

    Parameters
    ----------
    alpha : (n,) array
        Angle of attack [rad].

    Returns
    -------
    (n,) array
        1 where the flow is attached, 0 where it is separated.
    """
    # The angle of the flow to the chord line, whichever end is the front.
    angle = jnp.abs(alpha - jnp.pi * jnp.round(alpha / jnp.pi))
    fade = jnp.clip((angle - ATTACHED) / (SEPARATED - ATTACHED), 0.0, 1.0)
    return 1.0 - fade**2 * (3.0 - 2.0 * fade)


def beyond_critical(mach: jax.Array | float, thickness: jax.Array) -> jax.Array:
    """Compute by how much a section without lift is beyond its critical Mach number.

    Parameters
    ----------
    mach : (n,) array or number
        Mach number of the section; held at `DRAG_RISE_LIMIT` beyond it, C1.
    thickness : (n,) array
        Maximum thickness over chord.

    Returns
    -------
    (n,) array
        M - M_crit, negative below it.
    """
    return _held(mach, DRAG_RISE_LIMIT) - (KORN_FACTOR - thickness) + DIVERGENCE_MARGIN


def drag_rise(beyond: jax.Array, cl: jax.Array) -> jax.Array:
    """Compute the drag that shocks add to a section in attached flow.

    Parameters
    ----------
    beyond : (n,) array
        Mach number over the critical one without lift, by `beyond_critical`.
    cl : (n,) array
        Lift coefficient at this Mach number.

    Returns
    -------
    (n,) array
        Drag coefficient to be added, 20 (M - M_crit)^4 above the critical Mach number and 0 below,
        C3; times `attached_share`, for the drag of separated flow is not that of a shock.

    Notes
    -----
    Drag diverges, at a slope of 0.1, at Korn's Mach number 0.87 - t/c - |cl|/10; Lock's fourth
    power, The ideal drag due to a shock wave, ARC R&M 2512 (1951), starts 0.108 before it. Both as
    Mason, Configuration Aerodynamics, chapter 7, Virginia Tech (2006), puts them together, without
    sweep. Korn's equation is good to about 0.02 in Mach number for sections of 6 to 18 % thickness
    and lift coefficients up to 0.8; it is held to nothing beyond.
    """
    over = jnp.maximum(beyond + 0.1 * jnp.sqrt(cl**2 + _LITTLE_LIFT**2), 0.0)
    return 20.0 * over**4


def _held(mach: jax.Array | float, limit: float) -> jax.Array:
    """Mach number that levels off at a limit, within 0.05 before it."""
    mach, start = jnp.asarray(mach), limit - 0.05
    over = jnp.maximum(mach - start, 0.0)
    return jnp.minimum(mach, start) + 0.05 * jnp.tanh(over / 0.05)

"""Compressibility of section lift and moment."""

from __future__ import annotations

import jax
import jax.numpy as jnp

#: Mach number up to which the correction grows; beyond, drag rise makes it meaningless.
MACH_LIMIT = 0.7
#: The correction is whole up to the first angle of attack and gone from the second [rad].
ATTACHED, SEPARATED = jnp.radians(12.0), jnp.radians(30.0)


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
    mach = jnp.asarray(mach)
    start = MACH_LIMIT - 0.05
    over = jnp.maximum(mach - start, 0.0)
    held = jnp.minimum(mach, start) + 0.05 * jnp.tanh(over / 0.05)
    # The angle of the flow to the chord line, whichever end is the front.
    angle = jnp.abs(alpha - jnp.pi * jnp.round(alpha / jnp.pi))
    fade = jnp.clip((angle - ATTACHED) / (SEPARATED - ATTACHED), 0.0, 1.0)
    attached = 1.0 - fade**2 * (3.0 - 2.0 * fade)
    return 1.0 + attached * (1.0 / jnp.sqrt(1.0 - held**2) - 1.0)

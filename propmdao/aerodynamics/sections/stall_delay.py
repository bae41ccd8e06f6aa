"""Stall delay: on a rotating blade sections hold more lift past stall than in two dimensions."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.records.pytrees import Scalar

# Rotation adds lift up to the first angle and none beyond the second.
_FADES = np.radians(30.0), np.radians(50.0)
_CORNER = 1.0e-2  # width over which the factor turns to zero near the tip, where it would be < 0


def delay_factor(chord_over_r: Array, r_over_R: Array, turning_share: Scalar) -> Array:
    """Share of the lift missing to potential flow that rotation gives back.

    Parameters
    ----------
    chord_over_r : (n,) array
        Chord over local radius.
    r_over_R : (n,) array
        Local radius over tip radius.
    turning_share : float
        Lambda, rotational speed of the tip over its resultant with the axial speed.

    Returns
    -------
    (n,) array
        f_L of Du and Selig, A 3-D stall-delay model for horizontal axis wind turbine performance
        prediction, AIAA 98-0021, eq. 5 with a = b = d = 1, and not below 0.
    """
    power = chord_over_r ** (1.0 / (turning_share * r_over_R))
    f = (1.6 * chord_over_r / 0.1267 * (1.0 - power) / (1.0 + power) - 1.0) / (2.0 * jnp.pi)
    return 0.5 * (f + jnp.sqrt(f * f + _CORNER**2))


def delayed_stall(
    cl: Array, cd: Array, alpha: Array, zero_lift_angle: Array, factor: Array
) -> tuple[Array, Array]:
    """Coefficients of a section that rotates, from those in two dimensions.

    Lift rises by ``factor (2 pi sin(alpha - alpha_0) - cl)``. The suction that rotation adds acts
    normal to the chord, so drag rises by this times tan(alpha) (Lindenburg, Investigation into
    rotor blade aerodynamics, ECN-C--03-025, 2003); Du and Selig take drag off, which measured
    blades do not show.

    Parameters
    ----------
    cl, cd : (n,) arrays
        Lift and drag coefficients of the section in two dimensions.
    alpha, zero_lift_angle : (n,) arrays
        Angle of attack, and the angle at which the potential flow that agrees with the attached
        part of the polar has no lift [rad].
    factor : (n,) array
        Share of the missing lift that rotation gives back, from `delay_factor`; 0 leaves the
        coefficients as they are.

    Returns
    -------
    cl, cd : (n,) arrays
        Lift and drag coefficients of the section on the rotating blade.
    """
    first, last = _FADES
    progress = jnp.clip((jnp.abs(alpha) - first) / (last - first), 0.0, 1.0)
    fade = 1.0 - progress * progress * (3.0 - 2.0 * progress)
    potential = 2.0 * jnp.pi * jnp.sin(alpha - zero_lift_angle)
    more = factor * fade * (potential - cl)
    # Where nothing is added the tangent must not be looked at: it has poles.
    tangent = jnp.tan(jnp.clip(alpha, -last, last))
    return cl + more, cd + more * tangent

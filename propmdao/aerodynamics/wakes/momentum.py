"""Momentum theory: the induced velocity at the disk of a rotor from its thrust."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar


def momentum_induced_velocity(
    thrust: Scalar, speed: Scalar, tip_speed: Scalar, density: Scalar, disk_area: Scalar
) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    thrust : float
        Thrust of all blades, negative when windmilling [N].
    speed : float
        Axial flight speed [m/s].
    tip_speed : float
        Rotational speed of the tip [m/s].
    density : float
        Air density [kg/m^3].
    disk_area : float
        Area of the disk [m^2].

    Returns
    -------
    float
        Induced velocity w, positive downstream, root of T = 2 rho A w (V + w) [m/s].
    """
    x = 0.25 * speed**2 + thrust / (2.0 * density * disk_area)
    floor = (_LEAST_SPEED_FRACTION * tip_speed) ** 2
    return -0.5 * speed + jnp.sqrt(0.5 * (x + jnp.sqrt(x * x + 4.0 * floor * floor)))


# The discriminant of momentum theory is kept above this (fraction of tip speed)^2, smoothly, so
# that a wake always leaves the disk: thrust below the windmilling limit, or none at all in hover.
_LEAST_SPEED_FRACTION = 5.0e-3

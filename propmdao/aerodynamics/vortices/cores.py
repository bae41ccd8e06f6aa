"""Cores of vortices and how they grow."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar


def core_radius(
    ages: Array, rotation_speed: Scalar, kinematic_viscosity: Scalar, initial: Scalar
) -> Array:
    """Core radius of the wake segments, growing by (eddy) diffusion.

    rc^2 = rc0^2 + 4 alpha delta nu t with alpha = 1.25643 (Lamb-Oseen) and the eddy viscosity
    ratio delta of Squire 1965, held at 10 (Bhagwat and Leishman 2002 measure 1 to 100 on small
    rotors).

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuths of the wake nodes behind the blade [rad].
    rotation_speed : float
        Rotation speed [rad/s].
    kinematic_viscosity : float
        Kinematic viscosity [m^2/s].
    initial : float
        Core radius at the blade [m].

    Returns
    -------
    (n_nodes - 1,) array
        Core radius at the middle of each segment [m].
    """
    time = 0.5 * (ages[1:] + ages[:-1]) / rotation_speed
    return jnp.sqrt(initial**2 + 4.0 * 1.25643 * 10.0 * kinematic_viscosity * time)

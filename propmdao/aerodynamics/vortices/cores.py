"""Cores of vortices and how they grow."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState


def core_radius(ages: Array, state: RotorState, initial: Scalar) -> Array:
    """Core radius of wake segments, growing by (eddy) diffusion.

    rc^2 = rc0^2 + 4 alpha delta nu t with alpha = 1.25643 (Lamb-Oseen) and the eddy viscosity
    ratio delta of Squire 1965, held at 10 (Bhagwat and Leishman 2002 measure 1 to 100 on small
    rotors).

    Parameters
    ----------
    ages : (n,) array
        Azimuths behind the blade [rad]; `middles` of the nodes' for trailing segments.
    state : RotorState
        Rotation speed and air of the rotor.
    initial : float
        Core radius at the blade [m].

    Returns
    -------
    (n,) array
        Core radius at each age [m].
    """
    time = ages / state.rotation_speed
    return jnp.sqrt(initial**2 + 4.0 * 1.25643 * 10.0 * state.air.kinematic_viscosity * time)


def middles(ages: Array) -> Array:
    """Ages of the middle of the segments between nodes.

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuths of the wake nodes behind the blade [rad].

    Returns
    -------
    (n_nodes - 1,) array
        Azimuths of the middles [rad].
    """
    return 0.5 * (ages[1:] + ages[:-1])

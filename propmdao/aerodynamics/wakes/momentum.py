"""Momentum theory: the induced velocity at the disk of a rotor from its thrust.

    T = 2 rho A w (V + w)                                           (Glauert 1935, eq. I 1.13)

In hover nothing tells up from down: a rotor that pushes the air up, at negative thrust, is the
mirror image of one that pushes it down, and so is its induced velocity.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState

# The discriminant of momentum theory is kept above this (fraction of tip speed)^2, smoothly, so
# that a wake always leaves the disk: thrust below the windmilling limit, or none at all in hover.
_LEAST_SPEED_FRACTION = 5.0e-3


def momentum_induced_velocity(thrust: Scalar, state: RotorState, radius: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    thrust : float
        Thrust of all blades, negative when windmilling [N].
    state : RotorState
        Rotation speed, flight speed and air of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    float
        Induced velocity w, positive downstream, root of T = 2 rho A w (V + w) [m/s]; in hover
        negative where the thrust is.
    """
    disk_area = jnp.pi * radius**2
    upward = (state.speed == 0.0) & (jnp.asarray(thrust) < 0.0)
    sign = jnp.where(upward, -1.0, 1.0)
    x = 0.25 * state.speed**2 + sign * thrust / (2.0 * state.air.density * disk_area)
    floor = (_LEAST_SPEED_FRACTION * (state.rotation_speed * radius)) ** 2
    w = -0.5 * state.speed + jnp.sqrt(0.5 * (x + jnp.sqrt(x * x + 4.0 * floor * floor)))
    return sign * w

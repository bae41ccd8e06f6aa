"""Propeller coefficients, per n and D (UIUC and thesis convention, n in rev/s)."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


@record
class Coefficients:
    """Dimensionless performance; all are 0 where the propeller does not turn.

    Attributes
    ----------
    J : float
        Advance ratio V / (n D).
    CT, CQ, CP : float
        T / (rho n^2 D^4), Q / (rho n^2 D^5), P / (rho n^3 D^5) = 2 pi CQ.
    eta : float
        Propulsive efficiency J CT / CP = T V / P, 0 in hover.
    """

    J: Array
    CT: Array
    CQ: Array
    CP: Array
    eta: Array


@compiled
def coefficients(
    thrust: Scalar, torque: Scalar, state: RotorState, diameter: Scalar
) -> Coefficients:
    """Coefficients of a propeller.

    Parameters
    ----------
    thrust, torque : float
        Thrust and torque of all blades [N], [N m].
    state : RotorState
        Rotation speed, flight speed and air of the propeller.
    diameter : float
        Diameter from tip to tip [m].

    Returns
    -------
    Coefficients
        J, CT, CQ, CP and eta.
    """
    turning = state.rotation_speed > 0.0
    n = jnp.where(turning, state.rotation_speed, 2.0 * jnp.pi) / (2.0 * jnp.pi)
    switch = jnp.where(turning, 1.0, 0.0)
    force = state.air.density * n**2 * diameter**4
    J = switch * state.speed / (n * diameter)
    CT = switch * thrust / force
    CQ = switch * torque / (force * diameter)
    CP = 2.0 * jnp.pi * CQ
    absorbs = CP != 0.0
    eta = jnp.where(absorbs, J * CT / jnp.where(absorbs, CP, 1.0), 0.0)
    return Coefficients(J, CT, CQ, CP, eta)

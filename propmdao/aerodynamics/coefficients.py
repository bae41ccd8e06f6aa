"""Propeller coefficients, per n and D (UIUC and thesis convention, n in rev/s)."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar, record
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
    thrust: Scalar,
    torque: Scalar,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
    diameter: Scalar,
) -> Coefficients:
    """Coefficients of a propeller.

    Parameters
    ----------
    thrust, torque : float
        Of all blades [N], [N m].
    rotation_speed, speed, density, diameter : float
        Rotation speed [rad/s], flight speed [m/s], air density [kg/m^3], diameter [m].

    Returns
    -------
    Coefficients
        J, CT, CQ, CP and eta.
    """
    turning = rotation_speed > 0.0
    n = jnp.where(turning, rotation_speed, 2.0 * jnp.pi) / (2.0 * jnp.pi)
    on = jnp.where(turning, 1.0, 0.0)
    force = density * n**2 * diameter**4
    J = on * speed / (n * diameter)
    CT = on * thrust / force
    CQ = on * torque / (force * diameter)
    CP = 2.0 * jnp.pi * CQ
    absorbs = CP != 0.0
    eta = jnp.where(absorbs, J * CT / jnp.where(absorbs, CP, 1.0), 0.0)
    return Coefficients(J, CT, CQ, CP, eta)

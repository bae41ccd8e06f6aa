"""Propeller coefficients, per n and D (UIUC and thesis convention, n in rev/s)."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

_NO_LOSS = 1.0e-9  # power coefficient that is lost at least, so that 0/0 is 0
# Useful power coefficient of a brake beyond which its losses count less and less, see `_share`.
_BRAKING = 0.05


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
        Propulsive efficiency J CT / CP = T V / P, at most 1 and 0 in hover; below 0, down to -1,
        for a propeller that brakes, whether it takes power or gives it. At an incidence V is the
        part of the flight along the shaft.
    figure_of_merit : float
        Ideal power of hover, T^1.5 / sqrt(2 rho A), over shaft power, at most 1; below 0, down to
        -1, for negative thrust. It means something at speed 0.
    """

    J: Array
    CT: Array
    CQ: Array
    CP: Array
    eta: Array
    figure_of_merit: Array


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
        J, CT, CQ, CP, eta and figure of merit.
    """
    turning = state.rotation_speed > 0.0
    n = jnp.where(turning, state.rotation_speed, 2.0 * jnp.pi) / (2.0 * jnp.pi)
    switch = jnp.where(turning, 1.0, 0.0)
    force = state.air.density * n**2 * diameter**4
    J = switch * state.speed / (n * diameter)
    CT = switch * thrust / force
    CQ = switch * torque / (force * diameter)
    CP = 2.0 * jnp.pi * CQ
    # T^1.5 / sqrt(2 rho A) per rho n^3 D^5, with A = pi D^2 / 4 and the sign of the thrust.
    hover = jnp.sqrt(2.0 / jnp.pi) * CT * _sqrt(jnp.abs(CT))
    # The part of the flight against which the thrust works.
    along = J * jnp.cos(state.incidence)
    return Coefficients(J, CT, CQ, CP, _share(along * CT, CP), _share(hover, CP))


def _share(useful: Array, shaft: Array) -> Array:
    """Useful over shaft power for a propeller; for a brake what falls from 0 to -1.

    With L = shaft - useful, the power that is lost and never negative, useful / (useful + L) is the
    efficiency. Where the useful power is negative, shaft power goes through 0 and means nothing
    beside it: useful / (|useful| + L) goes on with the same slope at 0, and stays above -1. A
    deep windmill loses as much as it brakes, so that this would rise again toward a standstill,
    and an optimiser would stay there: losses count less the more useful power is negative.
    """
    braking = jnp.minimum(useful, 0.0)
    # Of the ideal power of hover, no part of the shaft power in flight, the rest may be negative.
    smooth = jnp.hypot(_NO_LOSS, 2.0 * braking)
    rest = shaft - useful
    lost = 0.5 * (rest + jnp.sqrt(rest**2 + smooth**2))
    return useful / (jnp.abs(useful) + lost / (1.0 + (braking / _BRAKING) ** 2))


def _sqrt(x: Array) -> Array:
    """Square root whose derivative at 0 is 0, for products with what vanishes there."""
    positive = x > 0.0
    return jnp.where(positive, jnp.sqrt(jnp.where(positive, x, 1.0)), 0.0)

"""Solutions at the root that a search has found, for derivatives by the implicit function theorem.

`axial.solve` and `trim.solve_for_thrust` can be differentiated as they are. Where their root is
known and many derivatives are wanted, their searches need not be repeated: all that the theorem
needs is the derivatives of solution and residual, with the root as one more argument, from one
evaluation of the lattice.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import RotorLoads, unless_still
from propmdao.records.pytrees import Scalar


def steady_at(induced_velocity: Scalar, case: RotorCase) -> tuple[RotorLoads, Array]:
    """Loads in the wake of a given induced velocity.

    Parameters
    ----------
    induced_velocity : float
        Induced velocity at the disk, that of `axial.solve` [m/s].
    case : RotorCase
        Case that `axial.solve` has solved.

    Returns
    -------
    loads, residual : RotorLoads, float
        Loads, and the induced velocity of their thrust less the given one, 0 at the root [m/s].
    """
    rotation_speed = case.state.rotation_speed
    turning = jnp.asarray(rotation_speed > 0.0)
    flow = axial.flow_at(case.turning(jnp.where(turning, rotation_speed, 1.0)))
    w = jnp.asarray(induced_velocity, float)
    loads = axial.loads_at(flow, w)
    momentum = axial.induced_velocity(flow, case.rotor.n_blades * loads.thrust)
    residual = jnp.where(turning, momentum, 0.0) - w
    return unless_still(turning, axial.rotor_loads(flow, w, loads)), residual


def trimmed_at(
    rotation_speed: Scalar, case: RotorCase, thrust_required: Scalar
) -> tuple[RotorLoads, Array]:
    """Loads at a given rotation speed, in the wake of the thrust required.

    Parameters
    ----------
    rotation_speed : float
        Rotation speed, that of `trim.solve_for_thrust` [rad/s].
    case : RotorCase
        Case that was trimmed; its own rotation speed does not matter.
    thrust_required : float
        Thrust of all blades [N].

    Returns
    -------
    loads, residual : RotorLoads, float
        Loads, and the thrust that is missing, 0 at the root [N].
    """
    flow = axial.flow_at(case)
    thrust, loads = axial.evaluate(flow, thrust_required, rotation_speed)
    return axial.solution(flow, thrust_required, rotation_speed, loads), thrust_required - thrust

"""Solutions at the root that a search has found, for derivatives by the implicit function theorem.

A solver's `solve` and `trim.solve_for_thrust` can be differentiated as they are. Where their root
is known and many derivatives are wanted, their searches need not be repeated: all that the theorem
needs is the derivatives of solution and residual, with the root as one more argument, from one
evaluation of the lattice.
"""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.solutions import axial, blade_element, periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.period import tilted_elements
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads, unless_still
from propmdao.records.pytrees import Scalar

_ASSEMBLED: dict[Any, Callable[..., RotorLoads | TiltedLoads]] = {
    axial: axial.rotor_loads,
    periodic: periodic.tilted_loads,
}


def solved_at(
    solver: Any, induced_velocity: Scalar, case: RotorCase
) -> tuple[RotorLoads | TiltedLoads, Array]:
    """Loads in the wake of a given induced velocity.

    Parameters
    ----------
    solver : module
        `solutions.axial`, `solutions.periodic`, or `solutions.blade_element` and
        `solutions.period.tilted_elements`, whose elements find their inflow without it.
    induced_velocity : float
        Induced velocity at the disk, that of the solver's `solve` [m/s].
    case : RotorCase
        Case that the solver has solved.

    Returns
    -------
    loads, residual : RotorLoads or TiltedLoads, float
        Loads, and the induced velocity of their thrust less the given one, 0 at the root [m/s].
    """
    if solver in (blade_element, tilted_elements):
        elements = solver.solve(case)
        return elements, elements.induced_velocity - induced_velocity
    turning, moving = case.never_still()
    flow = solver.flow_at(moving)
    w = jnp.asarray(induced_velocity, float)
    loads: Any = _ASSEMBLED[solver](flow, w, solver.loads_at(flow, w))
    residual = jnp.where(turning, solver.induced_velocity(flow, loads.thrust), 0.0) - w
    return unless_still(turning, loads), residual


def trimmed_at(
    solver: Any, rotation_speed: Scalar, case: RotorCase, thrust_required: Scalar
) -> tuple[RotorLoads | TiltedLoads, Array]:
    """Loads at a given rotation speed, in the wake of the thrust required.

    Parameters
    ----------
    solver : module
        One of these.
    rotation_speed : float
        Rotation speed, that of `trim.solve_for_thrust` [rad/s].
    case : RotorCase
        Case that was trimmed; its own rotation speed does not matter.
    thrust_required : float
        Thrust of all blades [N].

    Returns
    -------
    loads, residual : RotorLoads or TiltedLoads, float
        Loads, and the thrust that is missing, 0 at the root [N].
    """
    flow = solver.flow_at(case)
    thrust, loads = solver.evaluate(flow, thrust_required, rotation_speed)
    return (
        solver.solution(flow, thrust_required, rotation_speed, loads),
        thrust_required - thrust,
    )

"""Solutions at the root that a search has found, for derivatives by the implicit function theorem.

`solve_steady` and `steady_for_thrust` can be differentiated as they are. Who has their root and
asks for many derivatives does without their searches: the derivatives of solution and residual,
with the root as one more argument, are all that the theorem needs, from one evaluation of the
lattice.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.solutions.axial import (
    flow_at,
    induced_velocity,
    loads_at,
    steady_solution,
    unless_still,
)
from propmdao.aerodynamics.solutions.result import SteadySolution
from propmdao.records.pytrees import Scalar


def steady_at(
    induced_velocity_at_disk: Scalar,
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
    sections: ViscousSections | None = None,
) -> tuple[SteadySolution, Array]:
    """Loads in the wake of a given induced velocity.

    Parameters
    ----------
    induced_velocity_at_disk : float
        That of `propmdao.aerodynamics.solutions.axial.solve_steady` [m/s].
    nodes, n_blades, radius, rotation_speed, speed, density, sections
        As `solve_steady` takes them.

    Returns
    -------
    solution, residual : SteadySolution, float
        Loads, and the induced velocity of their thrust less the given one, 0 at the root [m/s].
    """
    turning = jnp.asarray(rotation_speed > 0.0)
    omega = jnp.where(turning, rotation_speed, 1.0)
    flow = flow_at(nodes, n_blades, radius, omega, speed, density, sections)
    w = jnp.asarray(induced_velocity_at_disk, float)
    loads = loads_at(flow, n_blades, w)
    residual = jnp.where(turning, induced_velocity(flow, n_blades * loads.thrust), 0.0) - w
    return unless_still(turning, steady_solution(flow, n_blades, w, loads)), residual


def trimmed_at(
    rotation_speed: Scalar,
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    speed: Scalar,
    density: Scalar,
    thrust_required: Scalar,
    sections: ViscousSections | None = None,
) -> tuple[SteadySolution, Array]:
    """Loads at a given rotation speed, in the wake of the thrust required.

    Parameters
    ----------
    rotation_speed : float
        That of `propmdao.aerodynamics.trim.steady_for_thrust` [rad/s].
    nodes, n_blades, radius, speed, density, thrust_required, sections
        As `steady_for_thrust` takes them.

    Returns
    -------
    solution, residual : SteadySolution, float
        Loads, and the thrust that is missing, 0 at the root [N].
    """
    flow = flow_at(nodes, n_blades, radius, rotation_speed, speed, density, sections)
    w = induced_velocity(flow, thrust_required)
    loads = loads_at(flow, n_blades, w)
    residual = thrust_required - n_blades * loads.thrust
    return steady_solution(flow, n_blades, w, loads), residual

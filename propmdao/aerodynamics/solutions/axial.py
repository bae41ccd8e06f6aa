"""Steady lattice in the rotating frame: loads at a rotation speed and a flight speed.

The wake is carried by the free stream and by the induced velocity w, w follows from the thrust by
momentum theory, and the thrust from the lattice in that wake: one scalar equation,
w = momentum(thrust(w)), whatever the flight speed; hover is V = 0.
"""

from __future__ import annotations

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.solutions.lattice_loads import (
    LatticeGeometry,
    LatticeLoads,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.aerodynamics.solutions.result import SETTLED, SteadySolution, strip_loads
from propmdao.aerodynamics.solutions.roots import at_root, decreasing_root
from propmdao.aerodynamics.vortices.cores import core_radius
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.momentum import momentum_induced_velocity
from propmdao.records.loads import PointLoads
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime.compilation import compiled

# Six turns from 10 deg steps at the blade to 30 deg. Against sixteen turns at 2 to 10 deg, with
# seven times the segments: thrust and torque within 0.15 %, in hover, where the wake leaves slowly,
# 1.4 % and 0.9 % (docs/verification.md).
WAKE_AGES = wake_azimuths(
    turns=6.0, first_step=np.radians(10.0), growth=1.1, last_step=np.radians(30.0)
)
_KINEMATIC_VISCOSITY = 1.46e-5  # air at 15 C [m^2/s]; only the wake's core knows it
_TOLERANCE = 1.0e-9  # relative, in the induced velocity
_GUESS = 0.05  # of the tip speed


@record
class Flow:
    """A lattice at an operating point.

    Attributes
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    radius, rotation_speed, speed, density : float
        Tip radius [m], rotation speed, not 0 [rad/s], axial flight speed [m/s], air density
        [kg/m^3].
    sections : ViscousSections or None
        Polars that the lattice is held to; None for inviscid flow.
    """

    lattice: LatticeGeometry
    radius: Scalar
    rotation_speed: Scalar
    speed: Scalar
    density: Scalar
    sections: ViscousSections | None


_Params = tuple[Flow, Array, Array]  # with the wake's ages and the thrust guessed


def flow_at(
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
    sections: ViscousSections | None,
) -> Flow:
    """Lattice at an operating point.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1 [m].
    n_blades : int
        Number of equally spaced blades.
    radius, rotation_speed, speed, density, sections
        As in `Flow`.

    Returns
    -------
    Flow
        With the geometry of the lattice.
    """
    return Flow(
        lattice=lattice_geometry(nodes, n_blades, radius),
        radius=jnp.asarray(radius, float),
        rotation_speed=jnp.asarray(rotation_speed, float),
        speed=jnp.asarray(speed, float),
        density=jnp.asarray(density, float),
        sections=sections,
    )


def induced_velocity(flow: Flow, thrust: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    flow : Flow
        Lattice and operating point.
    thrust : float
        Thrust of all blades [N].

    Returns
    -------
    float
        Induced velocity [m/s].
    """
    tip_speed, disk_area = flow.rotation_speed * flow.radius, jnp.pi * flow.radius**2
    return momentum_induced_velocity(thrust, flow.speed, tip_speed, flow.density, disk_area)


def loads_at(
    flow: Flow, n_blades: int, induced_velocity: Scalar, wake_ages: Array | np.ndarray = WAKE_AGES
) -> LatticeLoads:
    """Loads of blade 1 in the wake that a given induced velocity transports.

    Parameters
    ----------
    flow : Flow
        Lattice and operating point.
    n_blades : int
        Number of equally spaced blades.
    induced_velocity : float
        Induced velocity at the disk [m/s].
    wake_ages : (n_nodes,) array
        Azimuth of the wake nodes behind the blade [rad].

    Returns
    -------
    LatticeLoads
        Loads of blade 1.
    """
    ages = jnp.asarray(wake_ages)
    radius, omega = flow.radius, flow.rotation_speed
    trailing = flow.lattice.rings.corner[-1]
    wake = helical_wake(trailing, ages, n_blades, radius, omega, flow.speed, induced_velocity)
    core = core_radius(ages, omega, _KINEMATIC_VISCOSITY, BOUND_CORE * radius)
    return loads_with_wake(
        flow.lattice,
        wake,
        core,
        omega,
        flow.speed,
        induced_velocity,
        flow.density,
        flow.sections,
    )


@partial(compiled, static_argnames="n_blades")
def solve_steady(
    nodes: Array,
    n_blades: int,
    radius: Scalar,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
    sections: ViscousSections | None = None,
    wake_ages: Array | np.ndarray = WAKE_AGES,
    thrust_guess: Scalar = 0.0,
) -> SteadySolution:
    """Solve the steady lattice with its own wake.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1 [m].
    n_blades : int
        Number of equally spaced blades.
    radius, rotation_speed, speed, density : float
        Tip radius [m], rotation speed, 0 gives zero loads [rad/s], axial flight speed, 0 is hover
        [m/s], air density [kg/m^3].
    sections : ViscousSections, optional
        Polars that the lattice is held to; without any the flow is inviscid.
    wake_ages : (n_nodes,) array
        Azimuth of the wake nodes behind the blade [rad].
    thrust_guess : float
        Thrust of all blades where it is nearly known, as after a trim: it saves half of the work
        and does not change the result. 0 is no guess [N].

    Returns
    -------
    SteadySolution
        Loads, exactly differentiable in every argument but `n_blades` and the guess.
    """
    turning = jnp.asarray(rotation_speed > 0.0)
    # Where nothing turns, the flow of 1 rad/s stands in, for the shapes.
    flow = flow_at(
        nodes, n_blades, radius, jnp.where(turning, rotation_speed, 1.0), speed, density, sections
    )
    ages, thrust_guess = jnp.asarray(wake_ages), jnp.asarray(thrust_guess, float)

    def evaluate(params: _Params, w: Array) -> LatticeLoads:
        flow, ages, _ = params
        return loads_at(flow, n_blades, w, ages)

    def residual(params: _Params, w: Array, loads: LatticeLoads) -> Array:
        return induced_velocity(params[0], n_blades * loads.thrust) - w

    def solve(params: _Params) -> tuple[Array, LatticeLoads, None]:
        flow, _, thrust_guess = params
        tip_speed = flow.rotation_speed * flow.radius
        known = induced_velocity(flow, thrust_guess)

        def trial(w: Array) -> tuple[Array, LatticeLoads]:
            loads = evaluate(params, w)
            return residual(params, w, loads), loads

        w, loads = decreasing_root(
            trial,
            -0.5 * flow.speed + 1.0e-6 * tip_speed,
            tip_speed,
            jnp.where(thrust_guess == 0.0, _GUESS * tip_speed, known),
            _TOLERANCE,
        )
        return w, loads, None

    w, loads, _ = at_root(solve, evaluate, residual, (flow, ages, thrust_guess))
    return unless_still(turning, steady_solution(flow, n_blades, w, loads))


def steady_solution(
    flow: Flow, n_blades: int, induced_velocity_at_disk: Array, loads: LatticeLoads
) -> SteadySolution:
    """What the loads of a blade amount to.

    Parameters
    ----------
    flow : Flow
        Lattice and operating point.
    n_blades : int
        Number of equally spaced blades.
    induced_velocity_at_disk : float
        By which the wake was transported [m/s].
    loads : LatticeLoads
        Loads of blade 1 in that wake.

    Returns
    -------
    SteadySolution
        Of all blades; `converged` where momentum theory has the same induced velocity.
    """
    thrust, w = n_blades * loads.thrust, induced_velocity_at_disk
    tip_speed, area = flow.rotation_speed * flow.radius, jnp.pi * flow.radius**2
    agrees = jnp.abs(induced_velocity(flow, thrust) - w) < 1.0e-6 * tip_speed
    within_momentum_theory = thrust > -0.5 * area * flow.density * flow.speed**2
    settled = jnp.abs(loads.sections.residual).max() < SETTLED
    strip_thrust, strip_torque = strip_loads(loads)
    return SteadySolution(
        thrust=thrust,
        torque=n_blades * loads.torque,
        induced_velocity=w,
        circulation=loads.circulation,
        strip_thrust=strip_thrust,
        strip_torque=strip_torque,
        point_loads=PointLoads(loads.position, -loads.force),
        strips=flow.lattice.strips,
        sections=loads.sections,
        converged=agrees & within_momentum_theory & settled,
    )


def unless_still(turning: Array, solution: SteadySolution) -> SteadySolution:
    """Solution without any load where the propeller does not turn.

    Parameters
    ----------
    turning : bool
        Whether it does.
    solution : SteadySolution
        Of the propeller that turns.

    Returns
    -------
    SteadySolution
        The same, or zeros, which count as converged.
    """
    still = jax.tree.map(jnp.zeros_like, solution)
    still = dataclasses.replace(
        still,
        point_loads=PointLoads(solution.point_loads.position, still.point_loads.force),
        strips=solution.strips,
        converged=jnp.asarray(True),
    )
    return jax.tree.map(lambda moving, still: jnp.where(turning, moving, still), solution, still)

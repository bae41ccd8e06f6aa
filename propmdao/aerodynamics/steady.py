"""Steady lattice in the rotating frame: loads at a rotation speed and a flight speed.

The wake is carried by the free stream and by the induced velocity w, w follows from the thrust by
momentum theory, and the thrust from the lattice in that wake: one scalar equation,
w = momentum(thrust(w)), whatever the flight speed; hover is V = 0.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice_loads import (
    LatticeGeometry,
    LatticeLoads,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.aerodynamics.roots import decreasing_root
from propmdao.aerodynamics.wake import (
    core_radius,
    helical_wake,
    momentum_induced_velocity,
    wake_azimuths,
)
from propmdao.records import PointLoads, record

# Six turns from 10 deg steps at the blade to 30 deg. Against sixteen turns at 2 to 10 deg, with seven
# times the segments: thrust within 0.1 %, torque within 0.2 %, in hover 1.2 % (docs/verification.md).
WAKE_AGES = wake_azimuths(
    turns=6.0, first_step=np.radians(10.0), growth=1.1, last_step=np.radians(30.0)
)
_INITIAL_CORE = 1.0e-4  # of the radius
_KINEMATIC_VISCOSITY = 1.46e-5  # air at 15 C [m^2/s]; only the wake's core knows it
_TOLERANCE = 1.0e-9  # relative, in the induced velocity
_GUESS = 0.05  # of the tip speed


@record
class SteadySolution:
    """Loads of the propeller in steady axial flow.

    Attributes
    ----------
    thrust, torque : float
        Of all blades [N], [N m].
    induced_velocity : float
        At the disk, by which the wake is transported [m/s].
    circulation : (nc, ns) array
        Circulation of the rings of a blade [m^2/s].
    strip_thrust, strip_torque : (ns,) array
        Share of each strip of a blade; divide by the strip's width for loads per span
        [N], [N m].
    point_loads : PointLoads
        Forces of blade 1 on the fluid, for acoustics.
    converged : bool
        Whether thrust and induced velocity agree with momentum theory: False beyond its
        windmilling limit.
    """

    thrust: Array
    torque: Array
    induced_velocity: Array
    circulation: Array
    strip_thrust: Array
    strip_torque: Array
    point_loads: PointLoads
    converged: Array


def loads_at(
    lattice: LatticeGeometry,
    n_blades: int,
    radius: Array,
    rotation_speed: Array,
    speed: Array,
    density: Array,
    induced_velocity: Array,
    wake_ages: Array = WAKE_AGES,
) -> LatticeLoads:
    """Loads of blade 1 in the wake that a given induced velocity transports.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    n_blades : int
        Number of equally spaced blades.
    radius, rotation_speed, speed, density, induced_velocity : float
        Tip radius [m], rotation speed [rad/s], flight speed [m/s], air density [kg/m^3],
        induced velocity at the disk [m/s].
    wake_ages : (n_nodes,) array
        Azimuth of the wake nodes behind the blade [rad].

    Returns
    -------
    LatticeLoads
        Loads of blade 1.
    """
    ages = jnp.asarray(wake_ages)
    wake = helical_wake(
        lattice.rings.corner[-1], ages, n_blades, radius, rotation_speed, speed, induced_velocity
    )
    core = core_radius(ages, rotation_speed, _KINEMATIC_VISCOSITY, _INITIAL_CORE * radius)
    return loads_with_wake(lattice, wake, core, rotation_speed, speed, density)


@partial(jax.jit, static_argnames="n_blades")
def solve_steady(
    nodes: Array,
    n_blades: int,
    radius: Array,
    rotation_speed: Array,
    speed: Array,
    density: Array,
    wake_ages: Array = WAKE_AGES,
    induced_velocity_guess: Array = 0.0,
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
    wake_ages : (n_nodes,) array
        Azimuth of the wake nodes behind the blade [rad].
    induced_velocity_guess : float
        Where to start, as momentum theory has it for a thrust that is nearly known; it saves
        half of the work and does not change the result. 0 is no guess [m/s].

    Returns
    -------
    SteadySolution
        Loads, exactly differentiable in every argument but `n_blades` and the guess.
    """
    turning = rotation_speed > 0.0
    omega = jnp.where(turning, rotation_speed, 1.0)
    lattice = lattice_geometry(nodes, n_blades, radius)
    area, tip_speed = jnp.pi * radius**2, omega * radius

    def momentum(thrust: Array) -> Array:
        return momentum_induced_velocity(thrust, speed, tip_speed, density, area)

    def loads_in_wake_of(w: Array) -> LatticeLoads:
        return loads_at(lattice, n_blades, radius, omega, speed, density, w, wake_ages)

    def residual(w: Array) -> Array:
        return momentum(n_blades * loads_in_wake_of(w).thrust) - w

    least = -0.5 * speed + 1.0e-6 * tip_speed
    known = jnp.abs(induced_velocity_guess) > 0.0
    guess = jnp.where(known, induced_velocity_guess, _GUESS * tip_speed)
    w = decreasing_root(residual, least, tip_speed, guess, _TOLERANCE)
    loads = loads_in_wake_of(w)
    thrust = n_blades * loads.thrust
    agrees = jnp.abs(momentum(thrust) - w) < 1.0e-6 * tip_speed
    within_momentum_theory = thrust > -0.5 * density * area * speed**2
    on = jnp.where(turning, 1.0, 0.0)
    strip_thrust, strip_torque = strip_loads(loads)
    return SteadySolution(
        thrust=on * thrust,
        torque=on * n_blades * loads.torque,
        induced_velocity=on * w,
        circulation=on * loads.circulation,
        strip_thrust=on * strip_thrust,
        strip_torque=on * strip_torque,
        point_loads=PointLoads(loads.position, -on * loads.force),
        converged=~turning | (agrees & within_momentum_theory),
    )


def strip_loads(loads: LatticeLoads) -> tuple[Array, Array]:
    """Thrust and torque of each strip; a chordwise segment belongs half to either side.

    Parameters
    ----------
    loads : LatticeLoads
        Loads of blade 1, ns strips.

    Returns
    -------
    thrust, torque : (ns,) array
        They add up to the blade's [N], [N m].
    """
    nc, ns = loads.circulation.shape
    x, y = loads.position[:, 0], loads.position[:, 1]
    torque = y * loads.force[:, 0] - x * loads.force[:, 1]

    def by_strip(of_segment: Array) -> Array:
        bound = of_segment[: nc * ns].reshape(nc, ns).sum(axis=0)
        edge = of_segment[nc * ns :].reshape(nc, ns + 1).sum(axis=0)
        # The outermost edges have one strip only.
        share = edge * jnp.full(ns + 1, 0.5).at[jnp.array([0, ns])].set(1.0)
        return bound + share[:-1] + share[1:]

    return by_strip(loads.force[:, 2]), by_strip(torque)

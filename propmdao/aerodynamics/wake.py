"""Prescribed helical wake, transported by the free stream and by the induced velocity.

Momentum theory gives the induced velocity w at the disk from the thrust,

    T = 2 rho A w (V + w)                                           (Glauert 1935, eq. I 1.13)

and 2 w far downstream. Inside the stream the induced velocity grows from w to 2 w as on the axis of
the semi-infinite vortex cylinder, w (1 + s / sqrt(1 + s^2)) (McCormick 1967, eq. 4-48), and the
stream contracts by continuity, with s the distance travelled in radii. The vortices themselves lie
on the edge of the stream and move at the mean of both sides: V + w far downstream, where the air
outside is at rest, and so all along. Carried as fast as the air inside, the power of hover would
fall below that of the ideal disk (docs/verification.md). Limits: w is uniform over the disk, swirl
and roll-up of the tip vortex are left out.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.records import Scalar

# The discriminant of momentum theory is kept above this (fraction of tip speed)^2, smoothly, so
# that a wake always leaves the disk: thrust below the windmilling limit, or none at all in hover.
_LEAST_SPEED_FRACTION = 5.0e-3


def momentum_induced_velocity(
    thrust: Scalar, speed: Scalar, tip_speed: Scalar, density: Scalar, disk_area: Scalar
) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    thrust : float
        Thrust of all blades, negative when windmilling [N].
    speed : float
        Axial flight speed [m/s].
    tip_speed : float
        Rotational speed of the tip [m/s].
    density : float
        Air density [kg/m^3].
    disk_area : float
        Area of the disk [m^2].

    Returns
    -------
    float
        Induced velocity w, positive downstream, root of T = 2 rho A w (V + w) [m/s].
    """
    x = 0.25 * speed**2 + thrust / (2.0 * density * disk_area)
    floor = (_LEAST_SPEED_FRACTION * tip_speed) ** 2
    return -0.5 * speed + jnp.sqrt(0.5 * (x + jnp.sqrt(x * x + 4.0 * floor * floor)))


def wake_azimuths(turns: float, first_step: float, growth: float, last_step: float) -> np.ndarray:
    """Azimuth behind the blade of the wake nodes, finely spaced near the blade.

    Parameters
    ----------
    turns : float
        Length of the wake in revolutions.
    first_step, last_step : float
        Smallest (at the blade) and largest azimuth step [rad].
    growth : float
        Ratio of one step to the one before.

    Returns
    -------
    (n_nodes,) array
        Ages from 0 to 2 pi turns [rad].
    """
    ages = [0.0]
    step = first_step
    while ages[-1] < 2.0 * np.pi * turns:
        ages.append(ages[-1] + step)
        step = min(step * growth, last_step)
    return np.array(ages) * (2.0 * np.pi * turns / ages[-1])


def helical_wake(
    trailing_nodes: Array,
    ages: Array,
    n_blades: int,
    radius: Scalar,
    rotation_speed: Scalar,
    speed: Scalar,
    induced_velocity: Scalar,
) -> Array:
    """Trailing filaments of all blades.

    Parameters
    ----------
    trailing_nodes : (n_filaments, 3) array
        Where the filaments leave blade 1 [m].
    ages : (n_nodes,) array
        Azimuth behind the blade, from 0 [rad].
    n_blades : int
        Number of equally spaced blades.
    radius, rotation_speed, speed, induced_velocity : float
        Tip radius [m], rotation speed [rad/s], flight speed [m/s], induced velocity at
        the disk [m/s].

    Returns
    -------
    (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, blade by blade [m].
    """
    transport = speed + induced_velocity
    axial = transport * ages / rotation_speed
    s = axial / radius
    contraction = jnp.sqrt(transport / (transport + induced_velocity * s / jnp.sqrt(1.0 + s * s)))

    r0 = jnp.hypot(trailing_nodes[:, 0], trailing_nodes[:, 1])
    psi0 = jnp.arctan2(trailing_nodes[:, 1], trailing_nodes[:, 0])
    blade_angle = 2.0 * jnp.pi / n_blades * jnp.arange(n_blades)
    psi = psi0[:, None, None] + blade_angle[None, :, None] - ages[None, None, :]
    r = r0[:, None, None] * contraction[None, None, :]
    z = trailing_nodes[:, 2][:, None, None] - axial[None, None, :]
    return jnp.stack([r * jnp.cos(psi), r * jnp.sin(psi), jnp.broadcast_to(z, psi.shape)], axis=-1)


def core_radius(
    ages: Array, rotation_speed: Scalar, kinematic_viscosity: Scalar, initial: Scalar
) -> Array:
    """Core radius of the wake segments, growing by (eddy) diffusion.

    rc^2 = rc0^2 + 4 alpha delta nu t with alpha = 1.25643 (Lamb-Oseen) and the eddy viscosity
    ratio delta of Squire 1965, held at 10 (Bhagwat and Leishman 2002 measure 1 to 100 on small
    rotors).

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuth of the wake nodes behind the blade [rad].
    rotation_speed : float
        Rotation speed [rad/s].
    kinematic_viscosity : float
        Kinematic viscosity [m^2/s].
    initial : float
        Core radius at the blade [m].

    Returns
    -------
    (n_nodes - 1,) array
        Core radius at the middle of each segment [m].
    """
    time = 0.5 * (ages[1:] + ages[:-1]) / rotation_speed
    return jnp.sqrt(initial**2 + 4.0 * 1.25643 * 10.0 * kinematic_viscosity * time)

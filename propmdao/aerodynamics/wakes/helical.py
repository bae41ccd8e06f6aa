"""Prescribed helical wake, transported by the free stream and by the induced velocity.

Momentum theory gives the induced velocity w at the disk from the thrust,

    T = 2 rho A w (V + w)                                           (Glauert 1935, eq. I 1.13)

and V + 2 w far downstream, where the stream has contracted by continuity. The sheet that a blade
leaves has two parts, as Landgrebe saw them in hover (J. American Helicopter Society 17(4), 1972).
The inner one is carried by the air inside the stream, here at V + 2 w. The outer one rolls up into
the tip vortex on the edge of the stream: until the next of the B blades passes over it, it moves
slowly, V + 0.7 w / B, and then at the mean of both sides of the edge, V + w. His correlation, too,
has a first speed that falls with the number of blades (as CT over solidity) and a second one near w
for twisted blades.

The numbers 0.7, 1 and 2 are those at which sheets in hover move as they themselves and the blades
induce: `studies/wake_transport.py` lets the two parts drift until they do, with two to four
blades, in hover and in flight, where V counts for more (docs/verification.md). Limits: w is
uniform over the disk; swirl and the roll-up itself are left out.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar

# Speed of the sheet relative to the free stream, in induced velocities w: of its outer part before
# the next blade has passed, times the number of blades, and after; of its inner part.
_BEFORE_PASSAGE, _AFTER_PASSAGE, _INSIDE = 0.7, 1.0, 2.0
_PASSAGE_WIDTH = 0.2  # of the change between the two, in blade passages
_INNER_EDGE = 0.7  # r/R inward of which the sheet is carried by the air inside


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
    time, w = ages / rotation_speed, induced_velocity
    passage_time = 2.0 * jnp.pi / (n_blades * rotation_speed)
    outer = speed * time + w * passage_time * _outer_drift(time / passage_time, n_blades)
    inner = (speed + _INSIDE * w) * time

    # Continuity, with the velocity on the axis of the semi-infinite vortex cylinder,
    # V + w (1 + s / sqrt(1 + s^2)) (McCormick 1967, eq. 4-48), s in radii downstream.
    s = (speed + 1.5 * w) * time / radius
    contraction = jnp.sqrt((speed + w) / (speed + w + w * s / jnp.sqrt(1.0 + s * s)))

    outward = outer_part(jnp.hypot(trailing_nodes[:, 0], trailing_nodes[:, 1]) / radius)[:, None]
    axial = (1.0 - outward) * inner + outward * outer
    return helices(trailing_nodes, ages, n_blades, axial, contraction)


def outer_part(r_over_R: Array) -> Array:
    """How much of the sheet shed at a radius goes with the tip vortex.

    Parameters
    ----------
    r_over_R : (n_filaments,) array
        Where the filaments leave the blade.

    Returns
    -------
    (n_filaments,) array
        From 0, carried by the air inside, to 1 at the tip; smooth.
    """
    x = jnp.clip((r_over_R - _INNER_EDGE) / (1.0 - _INNER_EDGE), 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


def helices(
    trailing_nodes: Array, ages: Array, n_blades: int, axial: Array, contraction: Array
) -> Array:
    """Filaments of all blades, standing still in azimuth while the blades turn on.

    Parameters
    ----------
    trailing_nodes, ages, n_blades
        As for `helical_wake`.
    axial : (n_filaments, n_nodes) array
        Way downstream [m].
    contraction : (n_nodes,) array
        Radius over that at the blade.

    Returns
    -------
    (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, blade by blade [m].
    """
    r0 = jnp.hypot(trailing_nodes[:, 0], trailing_nodes[:, 1])
    psi0 = jnp.arctan2(trailing_nodes[:, 1], trailing_nodes[:, 0])
    blade_angle = 2.0 * jnp.pi / n_blades * jnp.arange(n_blades)
    psi = psi0[:, None, None] + blade_angle[None, :, None] - ages[None, None, :]
    r = r0[:, None, None] * contraction[None, None, :]
    z = trailing_nodes[:, 2][:, None, None] - axial[:, None, :]
    return jnp.stack([r * jnp.cos(psi), r * jnp.sin(psi), jnp.broadcast_to(z, psi.shape)], axis=-1)


def _outer_drift(passages: Array, n_blades: int) -> Array:
    """Way of the outer sheet relative to the free stream, in w times the time of a passage."""
    # log(1 + exp(x)): two straight lines with a rounded corner where the next blade passes.
    later = _PASSAGE_WIDTH * (
        jax.nn.softplus((passages - 1.0) / _PASSAGE_WIDTH) - jax.nn.softplus(-1.0 / _PASSAGE_WIDTH)
    )
    before = _BEFORE_PASSAGE / n_blades
    return before * passages + (_AFTER_PASSAGE - before) * later

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

The numbers 0.7, 1 and 2, the defaults of `WakeLaw`, are those at which sheets in hover move as they
themselves and the blades induce: `studies/validation/wake_transport.py` lets the two parts drift
until they do, with two to four blades, in hover and in flight, where V counts for more
(docs/verification.md).
Limits: w is uniform over the disk; swirl and the roll-up itself are left out.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.records.pytrees import Scalar, record, static
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw
from propmdao.runtime.compilation import compiled

_NEAR_DEG = 45.0


@record
class WakeTransport:
    """Law by which the wake moves, and the ages that its nodes have reached.

    Attributes
    ----------
    law : WakeLaw
        Speed of the wake's parts.
    ages : (n_nodes,) array
        Azimuths behind the blade, from 0 [rad]; `wakes.ages.wake_azimuths` spaces them.
    n_near : int
        Rings behind a blade that are near to it: those younger than an eighth of a turn.
    n_turn : int
        Rings behind a blade that are younger than a turn.
    """

    law: WakeLaw
    ages: Array | np.ndarray
    n_near: int = static(1)
    n_turn: int = static(1)


def wake_transport(law: WakeLaw = WakeLaw(), grid: WakeGrid = WakeGrid()) -> WakeTransport:  # noqa: B008 - frozen
    """Make the transport of a wake from its law and its grid.

    Parameters
    ----------
    law : WakeLaw
        Speed of the wake's parts.
    grid : WakeGrid
        Length of the wake and the steps of its nodes.

    Returns
    -------
    WakeTransport
        Law and ages, as the solutions take them.
    """
    ages = wake_azimuths(grid)
    n_near, n_turn = (
        max(int(np.searchsorted(ages[1:-1], np.radians(age_deg))), 1)
        for age_deg in (_NEAR_DEG, 360.0)
    )
    return WakeTransport(law, ages, n_near, n_turn)


@compiled
def helical_wake(
    trailing_nodes: Array,
    transport: WakeTransport,
    rotor: RotorGeometry,
    state: RotorState,
    induced_velocity: Scalar,
) -> Array:
    """Trailing filaments of all blades.

    Parameters
    ----------
    trailing_nodes : (n_filaments, 3) array
        Points at which the filaments leave blade 1 [m].
    transport : WakeTransport
        Law by which the wake moves, and the ages of its nodes.
    rotor : RotorGeometry
        Rotor that the wake leaves.
    state : RotorState
        Rotation speed, flight speed and air of the rotor.
    induced_velocity : float
        Induced velocity at the disk [m/s].

    Returns
    -------
    (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, blade by blade [m].
    """
    law, ages = transport.law, jnp.asarray(transport.ages)
    speed, w, radius = state.axial_speed, induced_velocity, rotor.radius
    time = ages / state.rotation_speed
    passage_time = 2.0 * jnp.pi / (rotor.n_blades * state.rotation_speed)
    drift = _outer_drift(law, time / passage_time, rotor.n_blades)
    outer = speed * time + w * passage_time * drift
    inner = (speed + law.inside * w) * time

    # Continuity, with the velocity on the axis of the semi-infinite vortex cylinder,
    # V + w (1 + s / sqrt(1 + s^2)) (McCormick 1967, eq. 4-48), s in radii downstream: above the
    # rotor where it hovers at negative thrust. At an angle V is a vector, and the stream along
    # which s counts is the resultant.
    def stream(induced: Scalar | Array) -> Array:
        return jnp.sqrt(state.edgewise_speed**2 + (speed + induced) ** 2)

    s = stream(1.5 * w) * time / radius
    contraction = jnp.sqrt(stream(w) / stream(w + w * s / jnp.sqrt(1.0 + s * s)))

    r_over_R = jnp.sqrt(trailing_nodes[:, 0] ** 2 + trailing_nodes[:, 1] ** 2) / radius
    outward = outer_part(r_over_R, law)[:, None]
    axial = (1.0 - outward) * inner + outward * outer
    return helices(trailing_nodes, ages, rotor.n_blades, axial, contraction)


def outer_part(r_over_R: Array, law: WakeLaw) -> Array:
    """Share of the sheet shed at a radius that goes with the tip vortex.

    Parameters
    ----------
    r_over_R : (n_filaments,) array
        Radius over tip radius at which the filaments leave the blade.
    law : WakeLaw
        Law of the wake, whose `inner_edge` counts here.

    Returns
    -------
    (n_filaments,) array
        Share of the outer part, which rises smoothly from 0 (carried by the air inside) to 1 at the
        tip.
    """
    x = jnp.clip((r_over_R - law.inner_edge) / (1.0 - law.inner_edge), 0.0, 1.0)
    return x * x * (3.0 - 2.0 * x)


def helices(
    trailing_nodes: Array, ages: Array, n_blades: int, axial: Array, contraction: Array
) -> Array:
    """Filaments of all blades, standing still in azimuth while the blades turn on.

    Parameters
    ----------
    trailing_nodes : (n_filaments, 3) array
        Points at which the filaments leave blade 1 [m].
    ages : (n_nodes,) array
        Azimuths behind the blade [rad].
    n_blades : int
        Number of equally spaced blades.
    axial : (n_filaments, n_nodes) array
        Distance that the nodes have moved downstream [m].
    contraction : (n_nodes,) array
        Radius of the nodes over that at the blade.

    Returns
    -------
    (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, blade by blade [m].
    """
    r0 = jnp.sqrt(trailing_nodes[:, 0] ** 2 + trailing_nodes[:, 1] ** 2)
    psi0 = jnp.arctan2(trailing_nodes[:, 1], trailing_nodes[:, 0])
    blade_angle = 2.0 * jnp.pi / n_blades * jnp.arange(n_blades)
    psi = psi0[:, None, None] + blade_angle[None, :, None] - ages[None, None, :]
    r = r0[:, None, None] * contraction[None, None, :]
    z = trailing_nodes[:, 2][:, None, None] - axial[:, None, :]
    return jnp.stack([r * jnp.cos(psi), r * jnp.sin(psi), jnp.broadcast_to(z, psi.shape)], axis=-1)


def _outer_drift(law: WakeLaw, passages: Array, n_blades: int) -> Array:
    """Distance of the outer sheet from the free stream's, in w times the time of a passage."""
    # log(1 + exp(x)): two straight lines with a rounded corner where the next blade passes.
    width = law.passage_width
    later = width * (jax.nn.softplus((passages - 1.0) / width) - jax.nn.softplus(-1.0 / width))
    before = law.before_passage / n_blades
    return before * passages + (law.after_passage - before) * later

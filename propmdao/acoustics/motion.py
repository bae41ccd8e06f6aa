"""Rigid motion of sources: a chain of frames, each turning and moving in the one before it.

A point that is at rest at ``x`` in the innermost frame is on the ground at::

    y(tau) = F_1(F_2(... F_n(x))),    F_k(x) = T_k(tau) + R_k(tau) x

which is the chain of "changes of base" of PSU-WOPWOP, outermost first. Blades, rotors and aircraft
are chains that share their outer frames.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike

from propmdao.records import record


@record
class Frame:
    """A frame that turns about a fixed axis and moves with a constant acceleration.

    Attributes
    ----------
    axis : (3,) array
        Unit vector of the rotation, in the outer frame.
    angle : scalar
        Rotation at time 0 [rad].
    rate : scalar
        Rotation rate [rad/s].
    offset, velocity, acceleration : (3,) arrays
        Of the origin at time 0, in the outer frame [m], [m/s], [m/s^2].
    """

    axis: Array
    angle: Array
    rate: Array
    offset: Array
    velocity: Array
    acceleration: Array


#: A chain of frames, outermost first; the empty chain is the ground.
Motion = tuple[Frame, ...]


@record
class Poses:
    """Where the innermost frame is at several times: y = origin + rotation x, and its derivatives.

    Attributes
    ----------
    rotation, rotation_rate, rotation_acceleration : (n_times, 3, 3) arrays
        R, dR/dtau [1/s] and d2R/dtau2 [1/s^2]; the columns of R are the frame's axes.
    origin, velocity, acceleration : (n_times, 3) arrays
        Of the frame's origin [m], [m/s], [m/s^2].
    """

    rotation: Array
    rotation_rate: Array
    rotation_acceleration: Array
    origin: Array
    velocity: Array
    acceleration: Array


def rotation(axis: ArrayLike, angle: ArrayLike = 0.0, rate: ArrayLike = 0.0) -> Frame:
    """Frame that is turned by `angle` and turns at a constant rate.

    Parameters
    ----------
    axis : (3,) array_like
        Direction of the axis; its length does not matter.
    angle : float
        Rotation at time 0 [rad].
    rate : float
        Rotation rate [rad/s], right-handed about the axis; negative turns the other way.

    Returns
    -------
    Frame
        Origin at rest.

    Raises
    ------
    ValueError
        If the axis has no length.
    """
    direction = np.asarray(axis, float)
    length = np.linalg.norm(direction)
    if direction.shape != (3,) or not (np.isfinite(length) and length > 0):
        raise ValueError(f"rotation axis must be three numbers, not all zero; got {direction}")
    rest = jnp.zeros(3)
    return Frame(
        jnp.asarray(direction / length),
        jnp.asarray(angle, float),
        jnp.asarray(rate, float),
        *(rest, rest, rest),
    )


def translation(
    offset: ArrayLike = (0.0, 0.0, 0.0),
    velocity: ArrayLike = (0.0, 0.0, 0.0),
    acceleration: ArrayLike = (0.0, 0.0, 0.0),
) -> Frame:
    """Frame whose origin is at ``offset + velocity tau + acceleration tau^2 / 2``.

    Parameters
    ----------
    offset, velocity, acceleration : (3,) array_like
        In the outer frame [m], [m/s], [m/s^2].

    Returns
    -------
    Frame
        Without rotation.
    """
    moves = (jnp.asarray(q, float) for q in (offset, velocity, acceleration))
    return Frame(jnp.array([0.0, 0.0, 1.0]), jnp.zeros(()), jnp.zeros(()), *moves)


def blade_motions(
    azimuths: ArrayLike, rotation_speed: ArrayLike, outer: Motion = ()
) -> list[Motion]:
    """Motion of every blade of a rotor that turns about +z of the frame around it.

    Parameters
    ----------
    azimuths : (n_blades,) array_like
        Azimuth of each blade at time 0 [rad]; any spacing.
    rotation_speed : float
        Omega [rad/s]; negative for a rotor that turns the other way (its blade is mirrored).
    outer : Motion
        Hub position, shaft tilt and flight of the rotor.

    Returns
    -------
    list of Motion
        One per blade; blade 1 of the geometry lies along +x at azimuth 0.
    """
    z = (0.0, 0.0, 1.0)
    angles = np.atleast_1d(np.asarray(azimuths, float))
    return [(*outer, rotation(z, azimuth, rotation_speed)) for azimuth in angles]


@jax.jit
def poses(motion: Motion, times: ArrayLike) -> Poses:
    """Position and orientation of the innermost frame, with exact first and second derivatives.

    Parameters
    ----------
    motion : Motion
        The chain of frames.
    times : (n_times,) array_like
        Source times tau [s].

    Returns
    -------
    Poses
        At each time.
    """

    def pose(time: Array) -> tuple[Array, Array]:
        return _pose(motion, time)

    def rates(time: Array) -> tuple[tuple[Array, Array], tuple[Array, Array]]:
        return jax.jvp(pose, (time,), (jnp.ones_like(time),))

    def at(time: Array) -> Poses:
        (here, first), (_, second) = jax.jvp(rates, (time,), (jnp.ones_like(time),))
        return Poses(here[0], first[0], second[0], here[1], first[1], second[1])

    return jax.vmap(at)(jnp.asarray(times, float))


def place(pose: Poses, points: ArrayLike) -> tuple[Array, Array, Array]:
    """Motion of points that are at rest in the innermost frame.

    Parameters
    ----------
    pose : Poses
        Of the frame.
    points : (n, 3) array_like
        In the frame [m].

    Returns
    -------
    position, velocity, acceleration : (n_times, n, 3) arrays
        On the ground [m], [m/s], [m/s^2].
    """
    x = jnp.asarray(points, float)

    def moved(origin: Array, matrix: Array) -> Array:
        return origin[:, None] + jnp.einsum("tij,nj->tni", matrix, x)

    return (
        moved(pose.origin, pose.rotation),
        moved(pose.velocity, pose.rotation_rate),
        moved(pose.acceleration, pose.rotation_acceleration),
    )


def _pose(motion: Motion, time: Array) -> tuple[Array, Array]:
    turn, origin = jnp.eye(3), 0.0 * time * jnp.ones(3)
    for frame in motion:
        step = frame.offset + (frame.velocity + 0.5 * frame.acceleration * time) * time
        origin = origin + turn @ step
        turn = turn @ _rotation_matrix(frame.axis, frame.angle + frame.rate * time)
    return turn + 0.0 * time, origin


def _rotation_matrix(axis: Array, angle: Array) -> Array:
    """Rodrigues' formula."""
    x, y, z = axis
    cross = jnp.array([[0.0, -z, y], [z, 0.0, -x], [-y, x, 0.0]])
    return jnp.eye(3) + jnp.sin(angle) * cross + (1 - jnp.cos(angle)) * cross @ cross

"""Microphones on the ground and rotors that fly past them.

Here the ground is the plane z = 0 of the frame at rest, z up, and rotors fly along +x.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.kinematics.motion import Motion, poses, rotation, translation
from propmdao.acoustics.kinematics.observers import directions
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.records.pytrees import record


@record
class Sight:
    """Line of sight to a moving rotor at each time of reception, arrays (n_observers, n_times).

    Attributes
    ----------
    emission_time : array
        Time at which the rotor centre emitted the sound that is heard [s].
    distance : array
        Distance from the rotor centre at emission to the observer at reception [m].
    elevation_deg, azimuth_deg : array
        Direction in which the sound left, in the rotor's frame without its rotation [deg].
    doppler : array
        Frequency heard over frequency emitted.
    """

    emission_time: Array
    distance: Array
    elevation_deg: Array
    azimuth_deg: Array
    doppler: Array


def fixed_observers(positions: ArrayLike) -> Observers:
    """Observers that stand still.

    Parameters
    ----------
    positions : (n_observers, 3) array_like
        Positions on the ground frame [m].

    Returns
    -------
    Observers
        Observers without velocity.
    """
    return Observers(jnp.asarray(positions, float).reshape(-1, 3), jnp.zeros(3))


def ground_line(start: ArrayLike, end: ArrayLike, n: int, height: float = 0.0) -> Observers:
    """Microphones evenly spaced on a straight line on the ground.

    Parameters
    ----------
    start, end : (2,) array_like
        Coordinates x and y of the first and the last microphone [m].
    n : int
        Number of microphones.
    height : float
        Height of the microphones above the ground [m]; 1.2 m in certification.

    Returns
    -------
    Observers
        Observers that stand still.

    Raises
    ------
    ValueError
        If there are fewer than two microphones or they are below the ground.
    """
    if n < 2:
        raise ValueError(f"a line needs at least 2 observers; got {n}")
    if not height >= 0:
        raise ValueError(f"height of observers must not be negative [m]; got {height:g}")
    ends = np.array([[*np.asarray(q, float), height] for q in (start, end)])
    return fixed_observers(np.linspace(ends[0], ends[1], n))


def flyover_track(height: float, speed: float, shaft_angle_deg: float = 90.0) -> Motion:
    """Level flight of a rotor over the ground, overhead of the origin at time 0.

    Parameters
    ----------
    height : float
        Height of the rotor centre above the ground [m].
    speed : float
        Flight speed along +x [m/s].
    shaft_angle_deg : float
        Angle from the vertical forward to the rotor axis [deg]: 90 for a propeller, whose axis is
        the direction of flight, 0 for a lifting rotor.

    Returns
    -------
    Motion
        Motion of the rotor's frame without its rotation: the `outer` of `blade_motions`.

    Raises
    ------
    ValueError
        If the height is not positive or the speed not finite.
    """
    if not (np.isfinite(height) and height > 0):
        raise ValueError(f"height of flight must be positive [m]; got {height:g}")
    if not np.isfinite(speed):
        raise ValueError(f"speed of flight must be finite [m/s]; got {speed:g}")
    path = translation(offset=(0.0, 0.0, height), velocity=(speed, 0.0, 0.0))
    return path, rotation((0.0, 1.0, 0.0), float(np.radians(shaft_angle_deg)))


def line_of_sight(
    motion: Motion, observers: Observers, times: ArrayLike, sound_speed: float
) -> Sight:
    """Directions, distances, emission times and Doppler factors at which a moving rotor is heard.

    Parameters
    ----------
    motion : Motion
        Motion of the rotor's frame, without the rotation of the blades.
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Observer times [s].
    sound_speed : float
        Speed of sound [m/s].

    Returns
    -------
    Sight
        Line of sight from the rotor centre to each observer at each time.

    Raises
    ------
    ValueError
        If the rotor centre or the observers are not slower than sound.
    """
    t = np.asarray(times, float)
    start, velocity = (np.asarray(q, float) for q in (observers.position, observers.velocity))
    heard_at = start[:, None] + velocity * t[:, None]  # (n_observers, n_times, 3)

    tau = np.broadcast_to(t, heard_at.shape[:2])
    for _ in range(40):
        toward, d, m_r, turn = _toward(motion, tau, heard_at, sound_speed)
        if not np.all(m_r < 1):
            raise ValueError(
                f"rotors must be slower than sound ({sound_speed:g} m/s); "
                f"their Mach number toward an observer is {m_r.max():.3f}"
            )
        late = tau + d / sound_speed - t
        if np.abs(late).max() < 1e-12 * (1 + np.abs(t).max()):
            break
        tau = tau - late / (1 - m_r)  # Newton; d / dtau = 1 - M_r
    observer_mach = np.einsum("i,oti->ot", velocity, toward) / (sound_speed * d)
    if not np.all(np.abs(observer_mach) < 1):
        raise ValueError(
            f"observers must be slower than sound ({sound_speed:g} m/s); "
            f"their Mach number is {np.abs(observer_mach).max():.3f}"
        )
    _, elevation, azimuth = directions(np.einsum("otij,oti->otj", turn, toward))
    doppler = (1 - observer_mach) / (1 - m_r)
    return Sight(*(jnp.asarray(q) for q in (tau, d, elevation, azimuth, doppler)))


def _toward(
    motion: Motion, tau: NDArray, heard_at: NDArray, sound_speed: float
) -> tuple[NDArray, NDArray, NDArray, NDArray]:
    """Way to the observer and its length, Mach number of the centre toward it, frame's axes."""
    pose = jax.tree.map(np.asarray, poses(motion, tau.ravel()))
    toward = heard_at - pose.origin.reshape(heard_at.shape)
    d = np.linalg.norm(toward, axis=-1)
    velocity = pose.velocity.reshape(heard_at.shape)
    m_r = np.sum(velocity * toward, axis=-1) / (sound_speed * d)
    return toward, d, m_r, pose.rotation.reshape(*tau.shape, 3, 3)

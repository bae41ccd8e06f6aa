"""Formulation 1A in general motion: pressure histories by marching through source time.

Every source time tau is heard at t = tau + d / c (Casalino's advanced time), so nothing has to be
solved; what arrives is interpolated to the observer's clock and summed.

The integrand is not shared with `formulation1a`: there all is seen from the turning frame, where
only the observer moves and the panels' v_n dS never changes, which saves half of the arithmetic of
the periodic case. Here surfaces may deform, loads may change and the frames move as they like.
"""

from __future__ import annotations

from functools import partial
from math import comb

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.motion import Motion, Poses, poses
from propmdao.acoustics.kinematics.reception import Observers, hear, observer_clock
from propmdao.acoustics.sources.moving_sources import Sources, UnsteadySources, frame_sources
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled

# Panels times source times worked on at once: a megabyte per array, which a core's cache holds.
_AT_ONCE = 1 << 16


def thickness_history(
    panels: Panels | UnsteadySources,
    motion: Motion,
    emission_times: ArrayLike,
    observers: Observers,
    times: ArrayLike,
    density: Scalar,
    sound_speed: float,
) -> Array:
    """Thickness noise of a surface in motion.

    Parameters
    ----------
    panels : Panels or UnsteadySources
        Closed surface in its frame, rigid or deforming.
    motion : Motion
        Of that frame.
    emission_times : (n_source_times,) array_like
        Increasing source times tau [s], see `source_times`.
    observers : Observers
        Who listens.
    times : (n_times,) array_like
        Uniform observer times t [s].
    density : float
        Of the undisturbed air [kg/m^3].
    sound_speed : float
        [m/s].

    Returns
    -------
    (n_observers, n_times) array
        Pressure [Pa]; NaN at times to which not all panels are heard.

    Raises
    ------
    ValueError
        If times are not as described or the observers are not slower than sound.

    Notes
    -----
    Interpolation is cubic in reception time: 30 steps per period of the highest tone of interest
    leave an error below 1e-4 of it.

    References
    ----------
    F. Farassat, Derivation of Formulations 1 and 1A of Farassat, NASA TM-2007-214853.
    D. Casalino, An advanced time approach for acoustic analogy predictions, J. Sound Vib. 261
    (2003) 583-612.
    """
    return density * _history(
        True, frame_sources(panels), motion, emission_times, observers, times, sound_speed
    )


def loading_history(
    loads: PointLoads | UnsteadySources,
    motion: Motion,
    emission_times: ArrayLike,
    observers: Observers,
    times: ArrayLike,
    sound_speed: float,
) -> Array:
    """Loading noise of point forces in motion.

    Parameters
    ----------
    loads : PointLoads or UnsteadySources
        Forces ON THE FLUID in their frame, constant there or given at the emission times.
    motion, emission_times, observers, times, sound_speed
        As in `thickness_history`.

    Returns
    -------
    (n_observers, n_times) array
        Pressure [Pa]; NaN at times to which not all forces are heard.

    Raises
    ------
    ValueError
        As in `thickness_history`.
    """
    return _history(
        False, frame_sources(loads), motion, emission_times, observers, times, sound_speed
    )


def _history(
    thickness: bool,
    sources: Sources,
    motion: Motion,
    emission_times: ArrayLike,
    observers: Observers,
    times: ArrayLike,
    sound_speed: float,
) -> Array:
    tau, (clock, step) = np.asarray(emission_times, float), observer_clock(times)
    if tau.ndim != 1 or tau.size < 4 or not np.all(np.diff(tau) > 0):
        raise ValueError(f"source times must be 4 or more that increase; got {tau.size}")
    lengths = {a.shape[2] for a in (*sources.position, *sources.vector)} - {1, tau.size}
    if lengths:
        raise ValueError(f"sources are given at {lengths.pop()} times; there are {tau.size}")
    mach = float(np.linalg.norm(observers.velocity) / sound_speed)
    if not mach < 1:
        raise ValueError(f"observers must be slower than sound; their Mach number is {mach:.3f}")
    # dt/dtau = (1 - M_r) / (1 - M_observer,r) is below 2 / (1 - M_observer)
    each = int(np.ceil(2 * np.diff(tau).max() / (1 - mach) / step))
    pose = poses(motion, tau)
    clock_of = (jnp.asarray(clock[0]), jnp.asarray(step))
    return _march(
        thickness,
        sources,
        pose,
        jnp.asarray(tau),
        observers,
        clock_of,
        sound_speed,
        clock.size,
        each,
    )


@partial(compiled, static_argnames=("thickness", "n_times", "each"))
def _march(
    thickness: bool,
    sources: Sources,
    pose: Poses,
    tau: Array,
    observers: Observers,
    clock: tuple[Array, Array],
    sound_speed: Scalar,
    n_times: int,
    each: int,
) -> Array:
    n = sources.vector[0].shape[1]
    chunk = -(-n // -(-n * tau.size // _AT_ONCE))
    # The last chunk is filled up with sources of no strength where its last one is.
    chunks = Sources(
        tuple(_in_chunks(x, chunk, "edge") for x in sources.position),
        tuple(_in_chunks(q, chunk, "constant") for q in sources.vector),
    )
    start, step = clock
    ticks = start + step * jnp.arange(n_times)

    def listen(position: Array) -> Array:
        @jax.checkpoint  # reverse derivatives recompute a chunk: memory stays bounded
        def add(sofar: tuple[Array, Array, Array], part: Sources) -> tuple[tuple, None]:
            heard, latest_start, earliest_end = sofar
            distance, pressure, _ = emit(
                thickness, part, pose, tau, position, observers.velocity, sound_speed
            )
            # Behind a barrier, for XLA would compute all of it again for each neighbour in `hear`.
            arrival, pressure = jax.lax.optimization_barrier(
                (tau + distance / sound_speed, pressure)
            )
            heard = heard + hear(arrival, pressure, start, step, n_times, each)
            latest_start = jnp.maximum(latest_start, arrival[:, 1].max())
            return (heard, latest_start, jnp.minimum(earliest_end, arrival[:, -2].min())), None

        nothing = (jnp.zeros(n_times), jnp.asarray(-jnp.inf), jnp.asarray(jnp.inf))
        (heard, first, last), _ = jax.lax.scan(add, nothing, chunks)
        return jnp.where((ticks >= first) & (ticks < last), heard, jnp.nan)

    return jax.lax.map(listen, jnp.asarray(observers.position, float)) / (4 * np.pi)


def _in_chunks(array: Array, chunk: int, mode: str) -> Array:
    """Split (3, n, times) into (n_chunks, 3, chunk, times)."""
    n = array.shape[1]
    padded = jnp.pad(array, ((0, 0), (0, -n % chunk), (0, 0)), mode=mode)
    return padded.reshape(3, -1, chunk, array.shape[2]).transpose(1, 0, 2, 3)


_Vector = tuple[Array, Array, Array]


def emit(
    thickness: bool,
    sources: Sources,
    pose: Poses,
    tau: Array,
    observer: Array,
    observer_velocity: Array,
    sound_speed: Scalar,
) -> tuple[Array, Array, Array]:
    """Sound of moving sources that leaves at given times, as one observer hears it.

    Parameters
    ----------
    thickness : bool
        Whether the sources are panels; otherwise they are forces (static).
    sources : Sources
        In their frame.
    pose : Poses
        Of the frame at the source times.
    tau : (n_times,) array
        Source times [s].
    observer, observer_velocity : (3,) arrays
        Position at time 0 [m] and velocity [m/s].
    sound_speed : float
        [m/s].

    Returns
    -------
    distance : (n, n_times) array
        d from the source at emission to the observer at reception, t = tau + d / c [m].
    pressure : (n, n_times) array
        4 pi p of forces [Pa], 4 pi p / rho of panels.
    rate : (n, n_times) array
        dt/dtau.
    """
    c = sound_speed
    turns = tuple(map(jnp.asarray, (pose.rotation, pose.rotation_rate, pose.rotation_acceleration)))
    y, v, a = (
        _add(_derivative(turns, sources.position, k), tuple(origin.T))
        for k, origin in enumerate((pose.origin, pose.velocity, pose.acceleration))
    )
    q, q_dot = (_derivative(turns, sources.vector, k) for k in range(2))

    # While the sound travels the observer flies on: d is the root of d = |D + M d| (Casalino).
    apart = tuple(observer[i] + observer_velocity[i] * tau - y[i] for i in range(3))
    m_o = tuple(observer_velocity[i] / c for i in range(3))
    beta2 = 1 - _dot(m_o, m_o)
    along = _dot(m_o, apart)
    d = (along + jnp.sqrt(along**2 + beta2 * _dot(apart, apart))) / beta2
    r = tuple(apart[i] / d + m_o[i] for i in range(3))

    m_r = _dot(v, r) / c
    doppler = 1 / (1 - m_r)
    rate = (1 - m_r) / (1 - _dot(m_o, r))
    # d Mdot_r + c (M_r - M^2)
    near = d * _dot(a, r) / c + c * m_r - _dot(v, v) / c
    if thickness:
        # rho v_n_dot / (d (1 - M_r)^2) + rho v_n near / (d^2 (1 - M_r)^3)
        v_n, v_n_dot = _dot(v, q), _dot(a, q) + _dot(v, q_dot)
        return d, (v_n_dot + v_n * near * doppler / d) * doppler**2 / d, rate
    # ldot_r / (c d (1 - M_r)^2) + (l_r - l_M) / (d^2 (1 - M_r)^2)
    #   + l_r near / (c d^2 (1 - M_r)^3)
    l_r, l_m = _dot(q, r), _dot(q, v) / c
    bracket = _dot(q_dot, r) / c + (l_r - l_m + l_r * near * doppler / c) / d
    return d, bracket * doppler**2 / d, rate


def _derivative(turns: tuple[Array, ...], local: tuple[Array, ...], order: int) -> _Vector:
    """Return the derivative of R x of an order by Leibniz' rule, by components (n, n_times)."""
    total: _Vector | None = None
    for k in range(min(order + 1, len(local))):
        factor, matrix, x = comb(order, k), turns[order - k], local[k]
        tx, ty, tz = (factor * _dot(tuple(matrix[:, i].T), tuple(x)) for i in range(3))
        total = (tx, ty, tz) if total is None else _add(total, (tx, ty, tz))
    assert total is not None
    return total


def _dot(a: tuple[Array, ...], b: tuple[Array, ...]) -> Array:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _add(a: tuple[Array, ...], b: tuple[Array, ...]) -> _Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]

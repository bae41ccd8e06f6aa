"""Formulation 1A in general motion: pressure histories by marching through source time.

Every source time tau is heard at t = tau + d / c (Casalino's advanced time), so nothing has to be
solved; what arrives is interpolated to the observer's clock and summed.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.motion import Motion, Poses, poses
from propmdao.acoustics.kinematics.reception import (
    Observers,
    observer_clock,
    require_slower_than_sound,
    sum_on_clock,
)
from propmdao.acoustics.sources.kernels import TONAL_SOURCES, Kernel, emission
from propmdao.acoustics.sources.moving_sources import Sources, UnsteadySources, frame_sources
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled

# Panels times source times worked on at once: a megabyte per array, which a core's cache holds.
_AT_ONCE = 1 << 16


def source_history(
    name: str,
    sources: Panels | PointLoads | UnsteadySources,
    motion: Motion,
    emission_times: ArrayLike,
    observers: Observers,
    times: ArrayLike,
    air: Air,
) -> Array:
    """Pressure history of one kind of sources in motion.

    Parameters
    ----------
    name : {"thickness", "loading"}
        Name of the source in `TONAL_SOURCES`.
    sources : Panels, PointLoads or UnsteadySources
        Closed surface, rigid or deforming, or forces ON THE FLUID, in their frame; changing ones
        are given at the emission times.
    motion : Motion
        Motion of the sources' frame.
    emission_times : (n_source_times,) array_like
        Increasing source times tau [s], see `source_times`.
    observers : Observers
        Observers at rest or in uniform motion.
    times : (n_times,) array_like
        Uniform observer times t [s].
    air : Air
        The undisturbed air.

    Returns
    -------
    (n_observers, n_times) array
        Pressure [Pa]; NaN at times to which not all sources are heard.

    Raises
    ------
    ValueError
        If the emission times do not increase, the observer times are not uniform or the observers
        are not slower than sound.

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
    in_frame = frame_sources(sources)
    tau, (clock, step) = np.asarray(emission_times, float), observer_clock(times)
    if tau.ndim != 1 or tau.size < 4 or not np.all(np.diff(tau) > 0):
        raise ValueError(f"source times must be 4 or more that increase; got {tau.size}")
    lengths = {a.shape[2] for a in (*in_frame.position, *in_frame.vector)} - {1, tau.size}
    if lengths:
        raise ValueError(f"sources are given at {lengths.pop()} times; there are {tau.size}")
    mach = require_slower_than_sound(observers, float(air.sound_speed))
    source = TONAL_SOURCES[name]
    # dt/dtau = (1 - M_r) / (1 - M_observer,r) is below 2 / (1 - M_observer)
    each = int(np.ceil(2 * np.diff(tau).max() / (1 - mach) / step))
    return source.scale(air) * _march(
        source.kernel,
        in_frame,
        poses(motion, tau).time_last,
        jnp.asarray(tau),
        observers,
        (jnp.asarray(clock[0]), jnp.asarray(step)),
        air.sound_speed,
        clock.size,
        each,
    )


@partial(compiled, static_argnames=("kernel", "n_times", "each"))
def _march(
    kernel: Kernel,
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

    def record_at(position: Array) -> Array:
        @jax.checkpoint  # reverse derivatives recompute a chunk: memory stays bounded
        def add(sofar: tuple[Array, Array, Array], part: Sources) -> tuple[tuple, None]:
            record, latest_start, earliest_end = sofar
            emitted = emission(part, pose, tau, position, observers.velocity, sound_speed)
            # Behind a barrier, for XLA would compute all of it again for each neighbour.
            arrival, pressure = jax.lax.optimization_barrier(
                (tau + emitted.distance / sound_speed, kernel(emitted))
            )
            record = record + sum_on_clock(arrival, pressure, start, step, n_times, each)
            latest_start = jnp.maximum(latest_start, arrival[:, 1].max())
            return (record, latest_start, jnp.minimum(earliest_end, arrival[:, -2].min())), None

        nothing = (jnp.zeros(n_times), jnp.asarray(-jnp.inf), jnp.asarray(jnp.inf))
        (record, first, last), _ = jax.lax.scan(add, nothing, chunks)
        return jnp.where((ticks >= first) & (ticks < last), record, jnp.nan)

    return jax.lax.map(record_at, jnp.asarray(observers.position, float)) / (4 * np.pi)


def _in_chunks(array: Array, chunk: int, mode: str) -> Array:
    """Split (3, n, times) into (n_chunks, 3, chunk, times)."""
    n = array.shape[1]
    padded = jnp.pad(array, ((0, 0), (0, -n % chunk), (0, 0)), mode=mode)
    return padded.reshape(3, -1, chunk, array.shape[2]).transpose(1, 0, 2, 3)

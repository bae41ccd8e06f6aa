"""Ground that reflects and air that absorbs, around a rotor and its observers.

Observers fly along with the rotor here, as they do for `tones` and `rotor_self_noise`. Sound has
one way to them or, over ground, two: noise is computed at the ends of all ways (`sound_paths`) and
put together again.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.acoustics.propagation.absorption import absorb, absorb_tones
from propmdao.acoustics.propagation.reflection import (
    bands_with_reflection,
    mirrored,
    on_hard_ground,
)
from propmdao.acoustics.signals import Tones
from propmdao.records.air import require_known_air
from propmdao.records.listening import Surroundings
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

_ON_GROUND = 1e-9  # m: rounding of directions

Floats = NDArray[np.float64]


def sound_paths(
    positions: ArrayLike, surroundings: Surroundings, incidence_deg: float = 0.0
) -> Floats:
    """Ends of the ways from the rotor to its observers: the observers and their mirror images.

    Parameters
    ----------
    positions : (n_observers, 3) array
        Positions from the rotor centre, in its axes [m].
    surroundings : Surroundings
        Ground around the rotor, or none.
    incidence_deg : float
        Angle between the shaft and the direction of flight [deg].

    Returns
    -------
    (n_ways, n_observers, 3) array
        Ends of two ways where the ground is at a height, otherwise of one [m].

    Raises
    ------
    ValueError
        If an observer is below the ground.
    """
    x = np.asarray(positions, float).reshape(-1, 3)
    ground = surroundings.ground
    if ground is None or isinstance(ground, str):
        return x[None]
    up = surroundings.up(incidence_deg)
    height = x @ np.asarray(up) + ground
    below = np.flatnonzero(height < -_ON_GROUND)
    if below.size:
        k = below[0]
        raise ValueError(
            f"observer {k + 1} is {-height[k]:.4g} m below the ground, which is {ground:g} m below"
            " the rotor centre"
        )
    return np.stack([x, np.asarray(mirrored(x, ground, up))])


def tones_by_paths(
    tones: Tones, paths: ArrayLike, state: RotorState, surroundings: Surroundings
) -> Tones:
    """Tones at observers: of all ways together, in phase.

    Parameters
    ----------
    tones : Tones
        Tones at the ends of the ways, ``paths.reshape(-1, 3)``, in air without end.
    paths : (n_ways, n_observers, 3) array
        Ways by `sound_paths` [m].
    state : RotorState
        Flight, and the air; where it absorbs, JAX cannot trace the air.
    surroundings : Surroundings
        Ground and air as they were for the paths.

    Returns
    -------
    Tones
        Tones at the n_observers observers.

    Raises
    ------
    ValueError
        If the air is to absorb and is outside what ISO 9613-1 states.
    """
    if surroundings.absorption:
        require_known_air(state.air)
        mach = state.velocity / state.air.sound_speed
        distance, doppler = way_flying_along(jnp.asarray(paths).reshape(-1, 3), mach)
        tones = absorb_tones(tones, distance, state.air, doppler)
    n_ways, n, _ = np.shape(paths)
    if n_ways == 1:
        return tones if surroundings.ground is None else on_hard_ground(tones)
    return tones.each(lambda amplitude: amplitude[:n]) + tones.each(lambda amplitude: amplitude[n:])


def bands_by_paths(
    mean_square: ArrayLike,
    band_hz: ArrayLike,
    paths: ArrayLike,
    state: RotorState,
    surroundings: Surroundings,
) -> Array:
    """Broadband noise at observers, of all ways together.

    Parameters
    ----------
    mean_square : (n_ways * n_observers, n_bands) array
        Third octaves at the ends of the ways, in air without end [Pa^2].
    band_hz : (n_bands,) array
        Mid-band frequencies [Hz].
    paths : (n_ways, n_observers, 3) array
        Ways by `sound_paths` [m].
    state : RotorState
        Flight, and the air; where it absorbs, JAX cannot trace the air.
    surroundings : Surroundings
        Ground and air as they were for the paths.

    Returns
    -------
    (n_observers, n_bands) array
        Mean squares of all ways together [Pa^2].

    Raises
    ------
    ValueError
        If the air is to absorb and is outside what ISO 9613-1 states.

    Notes
    -----
    Two ways interfere as those from a point in the rotor's centre: see `bands_with_reflection`.
    """
    x, f = jnp.asarray(paths), jnp.asarray(band_hz, float)
    power = jnp.asarray(mean_square).reshape(*x.shape[:2], f.size)
    distance, doppler = way_flying_along(x, state.velocity / state.air.sound_speed)
    if surroundings.absorption:
        require_known_air(state.air)
        power = absorb(power, f * doppler[..., None], distance, state.air)
    if len(power) == 1:
        return power[0] if surroundings.ground is None else 4 * power[0]
    delay = (distance[1] - distance[0]) / state.air.sound_speed
    return bands_with_reflection(power[0], power[1], f, delay)


@compiled
def way_flying_along(positions: ArrayLike, mach: ArrayLike) -> tuple[Array, Array]:
    """Way of the sound to observers that fly along with its source.

    Parameters
    ----------
    positions : (..., 3) array
        Positions from the source, observer and source taken at the same time [m].
    mach : (3,) array
        Velocity of the flight over the speed of sound, below 1.

    Returns
    -------
    distance : (...,) array
        Distance from the source at emission to the observer at reception [m].
    doppler : (...,) array
        Frequency in the air at rest over that which the observers, who move like the source, hear.
    """
    x = jnp.asarray(positions, float)
    m = jnp.asarray(mach, float)
    ahead, m2 = x @ m, m @ m
    d = emission_distance(ahead, jnp.sum(x**2, axis=-1), m2)
    return d, 1 / (1 - ahead / d - m2)

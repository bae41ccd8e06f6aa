"""Noise of turbulence that flows into a rotor: strips over azimuth, as their self-noise is."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.rotor import StripFlow, emission
from propmdao.acoustics.inflow.plate import inflow_noise
from propmdao.records.air import Turbulence
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


@partial(compiled, static_argnames=("n_blades", "n_azimuths"))
def rotor_inflow_noise(
    strips: StripFlow,
    n_blades: int,
    state: RotorState,
    turbulence: Turbulence,
    observers: ArrayLike,
    frequency_hz: ArrayLike,
    n_azimuths: int = 24,
) -> Array:
    """Third-octave mean squares of the noise of turbulence that flows in, averaged over the turn.

    Parameters
    ----------
    strips : StripFlow
        Strips of blade 1 at azimuth 0.
    n_blades : int
        Number of equal blades (static).
    state : RotorState
        Rotation speed about +z, flight of the rotor and the observers, subsonic, and the air.
    turbulence : Turbulence
        Turbulence all over the rotor, isotropic.
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    frequency_hz : (n_bands,) array
        Mid-band frequencies as the observers hear them [Hz].
    n_azimuths : int
        Number of equal steps in the turn (static): those of the sections where their flow changes.

    Returns
    -------
    (n_observers, n_bands) array
        Mean squares [Pa^2].

    Notes
    -----
    Every strip at every azimuth is an airfoil in steady flight, heard with its Doppler shift for as
    long as it is heard. Blades are not correlated: eddies that are cut by one blade after the
    other, long ones in slow flow, are heard as humps at the blade passage frequency and its
    harmonics instead, with the same energy.

    References
    ----------
    R. K. Amiet, Noise produced by turbulent flow into a propeller or helicopter rotor, AIAA J. 15
    (1977); R. W. Paterson, R. K. Amiet, NASA CR-3213 (1979). The weight of frequencies is that of
    S. Sinayoko, M. Kingan, A. Agarwal, Proc. R. Soc. A 469 (2013).
    """
    state, turbulence = jax.tree.map(lambda q: jnp.asarray(q, float), (state, turbulence))
    frequency = jnp.asarray(frequency_hz, float)[:, None, None]

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time
    def noise_at(observer: Array) -> Array:
        sight, approach, stretch = emission(strips, observer, state, n_azimuths)
        emitted = frequency * stretch  # (band, azimuth, strip)
        power = inflow_noise(emitted, strips.section, turbulence, sight, approach, state.air)
        return n_blades / n_azimuths * jnp.sum(power * stretch, (1, 2))

    return jax.lax.map(noise_at, jnp.asarray(observers, float))

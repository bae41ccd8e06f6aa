"""Tones of rotors whose every turn is like the one before: any shaft, any spacing, unsteady loads.

The Fourier integral over emission time of `formulation1a.tones` with the general kernel of
`advanced_time`: the shaft may be tilted against the flight, the loads may change around the turn
and the blades may stand at any azimuths. Observers fly along. `rotor_tones` takes any such rotor;
`tilted_tones` takes one with equally spaced blades, and can be traced and differentiated.
"""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from functools import partial
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.limits import require_air, require_subsonic_tip
from propmdao.acoustics.kinematics.motion import Poses, poses, rotation, translation
from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.harmonic_sums import harmonic_sums
from propmdao.acoustics.sources.kernels import TONAL_SOURCES, Kernel, emission
from propmdao.acoustics.sources.moving_sources import (
    AperiodicLoads,
    Sources,
    UnsteadySources,
    frame_sources,
    periodic_loads,
)
from propmdao.acoustics.sources.rotors import Rotor
from propmdao.records.air import Air
from propmdao.records.listening import Floats
from propmdao.records.loads import PeriodicLoads
from propmdao.records.panels import Panels
from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


def rotor_tones(
    rotor: Rotor,
    velocity: ArrayLike,
    air: Air,
    observers: ArrayLike,
    n_harmonics: int,
) -> Tones:
    """Tones of a rotor in uniform flight in any direction, heard by observers that fly along.

    Parameters
    ----------
    rotor : Rotor
        Rotor whose loads are constant or repeat every turn.
    velocity : (3,) array_like
        Velocity of the flight, in the axes of the aircraft [m/s].
    air : Air
        The undisturbed air.
    observers : (n_observers, 3) array_like
        Positions in the aircraft [m].
    n_harmonics : int
        Number of harmonics of `symmetry` times the rotation frequency: of the blade passage if the
        blades are equally spaced, of the rotation itself if nothing repeats within a turn.

    Returns
    -------
    Tones
        Amplitudes of every source [Pa], zero at zero rotation speed. Frequencies are positive
        whichever way the rotor turns.

    Raises
    ------
    ValueError
        If the tip is not slower than sound, or the loads do not repeat every turn.

    Notes
    -----
    Blade b stands at the azimuth psi_b and is heard as much earlier as it is ahead, so that the sum
    over blades is that of one blade times ``sum_b exp(-1j n psi_b)``.
    """
    require_air(air)
    if isinstance(rotor.loads, AperiodicLoads):
        raise ValueError(f"loads of {rotor.name} must repeat every turn to have tones")
    pose = poses(rotor.mount, np.zeros(1))
    to_hub, origin = pose.rotation[0].T, pose.origin[0]
    v = to_hub @ np.asarray(velocity, float)
    x = (np.asarray(observers, float).reshape(-1, 3) - origin) @ to_hub.T
    omega, radius = rotor.rotation_speed, float(np.linalg.norm(rotor.points[:, :2], axis=1).max())
    # The fastest an element gets: the advancing side of the disk.
    in_plane = abs(omega) + float(np.linalg.norm(v[:2])) / radius
    require_subsonic_tip(radius, RotorState(in_plane, float(v[2]), air))
    step = symmetry(rotor.azimuths)
    orders = step * np.arange(1, n_harmonics + 1)
    silence = jnp.zeros((len(x), n_harmonics), complex)
    parts = dict.fromkeys(TONAL_SOURCES, silence)
    if omega == 0:
        return Tones(jnp.zeros(n_harmonics), parts)
    blades = np.exp(-1j * np.outer(orders, np.atleast_1d(rotor.azimuths))).sum(axis=1)
    flight = (translation(velocity=v), rotation((0, 0, 1), rate=omega))
    for name, n_azimuths in rotor.azimuths_held.items():
        n = _n_emissions(step, n_harmonics, n_azimuths)
        tau = 2 * np.pi / omega * np.arange(n) / n
        blade = _fourier_integral(
            TONAL_SOURCES[name].kernel,
            frame_sources(rotor.source(name, 0, 0.0, tau)),
            poses(flight, tau).time_last,
            jnp.asarray(tau),
            jnp.asarray(x),
            jnp.asarray(v),
            omega,
            air.sound_speed,
            step,
            n_harmonics,
        )
        parts[name] = TONAL_SOURCES[name].scale(air) * (blade * blades)
    frequency_hz = jnp.asarray(orders * omega / (2 * np.pi))
    return Tones(frequency_hz, parts).of_positive_frequency


@partial(compiled, static_argnames=("n_blades", "n_harmonics"))
def tilted_tones(
    panels: Panels,
    loads: PeriodicLoads,
    n_blades: int,
    state: RotorState,
    observers: ArrayLike,
    n_harmonics: int,
) -> Tones:
    """Tones of a rotor in flight at an incidence, heard by observers that fly along with it.

    What `rotor_tones` gives for equally spaced blades, as a function of traced arguments.

    Parameters
    ----------
    panels : Panels
        Closed surface of blade 1.
    loads : PeriodicLoads
        Forces of blade 1 on the fluid at its azimuths.
    n_blades : int
        Number of equally spaced blades (static).
    state : RotorState
        Rotation speed about +z, speed of the rotor and the observers, incidence, and the
        undisturbed air. At zero rotation speed nothing is periodic: all amplitudes are zero.
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    n_harmonics : int
        Number of harmonics of the blade-passage frequency (static).

    Returns
    -------
    Tones
        Amplitudes of thickness and loading noise [Pa].

    Notes
    -----
    The advancing tip must be slower than sound: see `require_subsonic_tip`, for a traced function
    cannot raise.
    """
    turning = jnp.asarray(state.rotation_speed) != 0.0
    omega = jnp.where(turning, state.rotation_speed, 1.0)
    velocity = state.velocity

    def heard(
        name: str, n_azimuths: int, sources_at: Callable[[Floats], Panels | UnsteadySources]
    ) -> Array:
        n = _n_emissions(n_blades, n_harmonics, n_azimuths)
        psi = 2 * np.pi * np.arange(n) / n
        tau = jnp.asarray(psi) / omega
        return n_blades * _fourier_integral(
            TONAL_SOURCES[name].kernel,
            frame_sources(sources_at(psi)),
            _turning_and_flying(psi, tau, omega, velocity),
            tau,
            jnp.asarray(observers, float),
            velocity,
            omega,
            state.air.sound_speed,
            n_blades,
            n_harmonics,
        )

    amplitudes = {
        "thickness": heard("thickness", 0, lambda psi: panels),
        "loading": heard(
            "loading", loads.force.shape[0], lambda psi: periodic_loads(loads, psi, omega)
        ),
    }
    parts = {
        name: jnp.where(turning, TONAL_SOURCES[name].scale(state.air) * p, 0.0)
        for name, p in amplitudes.items()
    }
    orders = n_blades * np.arange(1, n_harmonics + 1)
    frequency_hz = jnp.where(turning, omega, 0.0) / (2 * np.pi) * orders
    return Tones(frequency_hz, parts).of_positive_frequency


def _n_emissions(step: int, n_harmonics: int, n_azimuths: int) -> int:
    """Azimuths of the Fourier integral for loads that are known at so many.

    The integrand holds harmonics up to n (1 + M), some more in the near field, and those of the
    loads.
    """
    return 2 * step * n_harmonics + 16 + n_azimuths


def _turning_and_flying(psi: Floats, tau: Array, omega: Array, velocity: Array) -> Poses:
    """Poses of a frame that turns about +z and flies along, times last; traced."""
    turn = poses((rotation((0, 0, 1), rate=1.0),), psi).time_last  # at 1 rad/s
    traced: dict[str, Any] = {
        "rotation_rate": omega * turn.rotation_rate,
        "rotation_acceleration": omega**2 * turn.rotation_acceleration,
        "origin": velocity[:, None] * tau,
        "velocity": jnp.broadcast_to(velocity[:, None], turn.velocity.shape),
    }
    return dataclasses.replace(turn, **traced)


def symmetry(azimuths: ArrayLike) -> int:
    """Number of times that the arrangement of the blades repeats within a turn.

    Parameters
    ----------
    azimuths : (n_blades,) array_like
        Azimuths of the blades [rad].

    Returns
    -------
    int
        Number of repetitions: n_blades if equally spaced, 1 if nothing repeats, 2 for two
        scissored pairs.
    """
    angles = np.atleast_1d(np.asarray(azimuths, float))
    n = angles.size

    def repeats(k: int) -> bool:
        # all phase sums but those at multiples of k vanish
        orders = [order for order in range(1, n + 1) if order % k]
        sums = np.exp(1j * np.outer(orders, angles)).sum(axis=1)
        return bool(np.all(np.abs(sums) < 1e-9 * n))

    return max(k for k in range(1, n + 1) if n % k == 0 and repeats(k))


@partial(compiled, static_argnames=("kernel", "step", "n_harmonics"))
def _fourier_integral(
    kernel: Kernel,
    sources: Sources,
    pose: Poses,
    tau: Array,
    observers: Array,
    velocity: Array,
    omega: Scalar,
    sound_speed: Scalar,
    step: int,
    n_harmonics: int,
) -> Array:
    """Average ``p dt/dtau exp(1j n Omega t)`` of one blade over its turn, (n_observers, n_harm)."""
    azimuth = 2 * np.pi * np.arange(tau.size) / tau.size
    turned = np.exp(1j * step * np.outer(azimuth, np.arange(1, n_harmonics + 1)))

    @jax.checkpoint  # reverse derivatives recompute one observer at one azimuth at a time
    def amplitudes_at(observer: Array) -> Array:
        @jax.checkpoint
        def strength_and_phase(j: Array) -> tuple[Array, Array]:
            def now(q: Array) -> Array:  # what does not change has one time only
                return jax.lax.dynamic_slice_in_dim(q, j % q.shape[2], 1, axis=2)

            emitted = emission(
                jax.tree.map(now, sources),
                jax.tree.map(lambda q: q[..., j][..., None], pose),
                tau[j][None],
                observer,
                velocity,
                sound_speed,
            )
            phase = step * omega / sound_speed * emitted.distance[:, 0]
            return (kernel(emitted) * emitted.rate)[:, 0], phase

        strength, phase = jax.lax.map(strength_and_phase, jnp.arange(tau.size))
        sums = harmonic_sums(strength, phase, n_harmonics)
        return jnp.sum(sums * turned, axis=0) / (4 * np.pi * tau.size)

    return jax.lax.map(amplitudes_at, observers)

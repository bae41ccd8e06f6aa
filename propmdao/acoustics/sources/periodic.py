"""Tones of rotors whose every turn is like the one before: any shaft, any spacing, unsteady loads.

The Fourier integral over emission time of `formulation1a.tones` with the general kernel of
`advanced_time`: the shaft may be tilted against the flight, the loads may change around the turn
and the blades may stand at any azimuths. Observers fly along.
"""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.kinematics.limits import require_air, require_subsonic_tip
from propmdao.acoustics.kinematics.motion import Poses, poses, rotation, translation
from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.advanced_time import emit
from propmdao.acoustics.sources.harmonic_sums import cos_sin, harmonic_sums
from propmdao.acoustics.sources.moving_sources import (
    AperiodicLoads,
    PeriodicLoads,
    Sources,
    UnsteadySources,
    blade_loads,
    frame_sources,
)
from propmdao.acoustics.sources.rotors import Rotor
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled


def rotor_tones(
    rotor: Rotor,
    velocity: ArrayLike,
    density: float,
    sound_speed: float,
    observers: ArrayLike,
    n_harmonics: int,
) -> Tones:
    """Tones of a rotor in uniform flight in any direction, heard by observers that fly along.

    Parameters
    ----------
    rotor : Rotor
        Its loads constant or repeating every turn.
    velocity : (3,) array_like
        Of flight, in the axes of the aircraft [m/s].
    density, sound_speed : float
        Of the undisturbed air [kg/m^3], [m/s].
    observers : (n_observers, 3) array_like
        Positions in the aircraft [m].
    n_harmonics : int
        Number of harmonics of `symmetry` times the rotation frequency: of the blade passage if the
        blades are equally spaced, of the rotation itself if nothing repeats within a turn.

    Returns
    -------
    Tones
        Amplitudes of thickness and loading noise, zero at zero rotation speed.

    Raises
    ------
    ValueError
        If the tip is not slower than sound, or the loads do not repeat every turn.

    Notes
    -----
    Blade b stands at the azimuth psi_b and is heard as much earlier as it is ahead, so that the sum
    over blades is that of one blade times ``sum_b exp(-1j n psi_b)``.
    """
    require_air(density, sound_speed)
    if isinstance(rotor.loads, AperiodicLoads):
        raise ValueError(f"loads of {rotor.name} must repeat every turn to have tones")
    pose = poses(rotor.mount, np.zeros(1))
    to_hub, origin = pose.rotation[0].T, pose.origin[0]
    v = to_hub @ np.asarray(velocity, float)
    x = (np.asarray(observers, float).reshape(-1, 3) - origin) @ to_hub.T
    omega, radius = rotor.rotation_speed, float(np.linalg.norm(rotor.points[:, :2], axis=1).max())
    # The fastest an element gets: the advancing side of the disk.
    in_plane = abs(omega) + float(np.linalg.norm(v[:2])) / radius
    require_subsonic_tip(radius, in_plane, float(v[2]), sound_speed)
    step = symmetry(rotor.azimuths)
    orders = step * np.arange(1, n_harmonics + 1)
    silence = jnp.zeros((len(x), n_harmonics), complex)
    if omega == 0:
        return Tones(jnp.zeros(n_harmonics), silence, silence)
    blades = np.exp(-1j * np.outer(orders, np.atleast_1d(rotor.azimuths))).sum(axis=1)

    def heard(sources: Panels | PointLoads | UnsteadySources, tau: NDArray[np.float64]) -> Array:
        pose = poses((translation(velocity=v), rotation((0, 0, 1), rate=omega)), tau)
        of_one = _fourier_integral(
            isinstance(sources, Panels),
            frame_sources(sources),
            pose,
            jnp.asarray(tau),
            jnp.asarray(x),
            jnp.asarray(v),
            omega,
            sound_speed,
            step,
            n_harmonics,
        )
        return of_one * blades

    # The integrand holds harmonics up to n (1 + M), some more in the near field, and those of
    # the loads.
    n_azimuths = 2 * step * n_harmonics + 16
    turn = 2 * np.pi / omega
    thickness = loading = silence
    if rotor.panels is not None:
        thickness = density * heard(rotor.panels, turn * np.arange(n_azimuths) / n_azimuths)
    if rotor.loads is not None:
        if isinstance(rotor.loads, PeriodicLoads):
            n_azimuths += len(rotor.loads.force)
        tau = turn * np.arange(n_azimuths) / n_azimuths
        loading = heard(blade_loads(rotor.loads, 0, 0.0, omega, tau), tau)
    return Tones(jnp.asarray(orders * omega / (2 * np.pi)), thickness, loading)


def symmetry(azimuths: ArrayLike) -> int:
    """How often the arrangement of the blades repeats within a turn.

    Parameters
    ----------
    azimuths : (n_blades,) array_like
        Of the blades [rad].

    Returns
    -------
    int
        n_blades if equally spaced, 1 if nothing repeats; 2 for two scissored pairs.
    """
    angles = np.atleast_1d(np.asarray(azimuths, float))
    n = angles.size

    def repeats(k: int) -> bool:
        # all phase sums but those at multiples of k vanish
        orders = [order for order in range(1, n + 1) if order % k]
        sums = np.exp(1j * np.outer(orders, angles)).sum(axis=1)
        return bool(np.all(np.abs(sums) < 1e-9 * n))

    return max(k for k in range(1, n + 1) if n % k == 0 and repeats(k))


@partial(compiled, static_argnames=("thickness", "step", "n_harmonics"))
def _fourier_integral(
    thickness: bool,
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

    def hear(observer: Array) -> Array:
        def at(j: Array) -> tuple[Array, Array, Array]:
            def now(q: Array) -> Array:  # what does not change has one time only
                return jax.lax.dynamic_slice_in_dim(q, j % q.shape[2], 1, axis=2)

            distance, pressure, rate = emit(
                thickness,
                jax.tree.map(now, sources),
                jax.tree.map(lambda q: q[j][None], pose),
                tau[j][None],
                observer,
                velocity,
                sound_speed,
            )
            phase = cos_sin(step * omega / sound_speed * distance[:, 0])
            return (pressure * rate)[:, 0], *phase

        # a loop, so that XLA does not fuse all this into the sums: see `harmonic_sums`
        strength, cosine, sine = jax.lax.map(at, jnp.arange(tau.size))
        sums = harmonic_sums(strength, cosine, sine, n_harmonics)
        return jnp.sum(sums * turned, axis=0) / (4 * np.pi * tau.size)

    return jax.lax.map(hear, observers)

"""Tonal noise of a steadily loaded rotor: Farassat's Formulation 1A over emission time."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.harmonic_sums import cos_sin, harmonic_sums
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.runtime.compilation import compiled


@partial(compiled, static_argnames=("n_blades", "n_harmonics"))
def tones(
    panels: Panels,
    loads: PointLoads,
    n_blades: int,
    rotation_speed: ArrayLike,
    speed: ArrayLike,
    density: ArrayLike,
    sound_speed: ArrayLike,
    observers: ArrayLike,
    n_harmonics: int,
) -> Tones:
    """Tones of a rotor in steady axial flight, heard by observers that fly along with it.

    Formulation 1A for a rigid surface and loads that are constant in the rotating frame, every
    near-field term kept. All is periodic, so the harmonics follow from a Fourier integral over
    emission time, without a retarded-time root and without interpolation::

        P_m = (B / N) sum_j sum_elements p(tau_j) exp(1j m B Omega t(tau_j)) (dt / dtau)_j

    over N azimuths of blade 1, with t = tau + d / c. The other blades add the same at the multiples
    of B and cancel in between.

    Parameters
    ----------
    panels : Panels
        Closed surface of blade 1.
    loads : PointLoads
        Forces of blade 1 on the fluid.
    n_blades : int
        Number of equally spaced blades B (static).
    rotation_speed : float
        Omega about +z [rad/s]. At zero nothing is periodic: all amplitudes are zero.
    speed : float
        Speed V of the rotor and the observers along +z [m/s].
    density, sound_speed : float
        Of the undisturbed air [kg/m^3], [m/s].
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    n_harmonics : int
        Number of harmonics of the blade-passage frequency (static).

    Returns
    -------
    Tones
        Amplitudes of thickness and loading noise.

    Notes
    -----
    The relative tip speed must be below the speed of sound: see `require_subsonic_tip`, for a
    traced function cannot raise. N = 2 m_max B + 16 azimuths keep the harmonics within 0.01 dB at
    1.5 tip radii from the centre and beyond; closer observers ask for more.

    References
    ----------
    F. Farassat, Derivation of Formulations 1 and 1A of Farassat, NASA TM-2007-214853.
    """
    motion = _Motion(*(jnp.asarray(q, float) for q in (rotation_speed, speed, sound_speed)))
    thickness = _thickness(panels, jnp.asarray(density, float), motion)
    loading = _loading(loads, motion)

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time: megabytes, not GiB
    def hear(observer: Array) -> tuple[Array, Array]:
        return (
            _fourier_integral(thickness, motion, n_blades, n_harmonics, observer),
            _fourier_integral(loading, motion, n_blades, n_harmonics, observer),
        )

    amplitudes = jax.lax.map(hear, jnp.asarray(observers, float))
    turning = motion.omega != 0
    frequency_hz = n_blades * motion.omega / (2 * np.pi) * np.arange(1, n_harmonics + 1)
    return Tones(frequency_hz, *(jnp.where(turning, p, 0.0) for p in amplitudes))


class _Motion(NamedTuple):
    omega: Array
    v: Array
    c: Array


class _Radiation(NamedTuple):
    """One source and the direction r in which its sound leaves, in the turning frame."""

    d: Array  # from the source at emission to the observer at reception
    r: tuple[Array, Array, Array]
    m_r: Array
    near: Array  # d Mdot_r + c (M_r - M^2)
    spread: Array  # dt/dtau / (d^2 (1 - M_r)^3)


# From the observer's position in the turning frame to 4 pi p dt/dtau and the distance d of each
# source. What depends on the sources alone is computed once, outside the loop over azimuths.
_Source = Callable[[Array, Array, Array], tuple[Array, Array]]


def _fourier_integral(
    source: _Source, motion: _Motion, n_blades: int, n_harmonics: int, observer: Array
) -> Array:
    """Average ``p dt/dtau exp(1j n Omega t)`` of blade 1 over one turn, times B."""
    # The integrand holds harmonics up to n (1 + M), and some more in the near field.
    n_azimuths = 2 * n_harmonics * n_blades + 16
    azimuth = 2 * np.pi * np.arange(n_azimuths) / n_azimuths
    # The observer turns back instead of the blade forward: every blade quantity stays constant.
    x = observer[0] * np.cos(azimuth) + observer[1] * np.sin(azimuth)
    y = observer[1] * np.cos(azimuth) - observer[0] * np.sin(azimuth)

    @jax.checkpoint
    def emit(position: tuple[Array, Array]) -> tuple[Array, Array, Array]:
        strength, d = source(*position, observer[2])
        return strength, *cos_sin(n_blades * motion.omega / motion.c * d)

    strength, cosine, sine = jax.lax.map(emit, (x, y))
    sums = harmonic_sums(strength, cosine, sine, n_harmonics)
    turned = np.exp(1j * n_blades * np.outer(azimuth, np.arange(1, n_harmonics + 1)))
    return n_blades / (4 * np.pi * n_azimuths) * jnp.sum(sums * turned, axis=0)


def _thickness(panels: Panels, density: Array, motion: _Motion) -> _Source:
    """Thickness noise, rho v_n (d Mdot_r + c (M_r - M^2)) / (d^2 (1 - M_r)^3)."""
    # The other term, rho (vdot_n + v_ndot) / (d (1 - M_r)^2), is the change of v_n dS on a panel:
    # zero, since the surface is rigid.
    x, y, z = panels.center.T
    sx, sy, sz = panels.vector_area.T
    v_n = motion.omega * (x * sy - y * sx) + motion.v * sz
    radiation = _radiation(x, y, z, motion)

    def emit(*observer: Array) -> tuple[Array, Array]:
        d, _, _, near, spread = radiation(*observer)
        return density * v_n * near * spread, d

    return emit


def _loading(loads: PointLoads, motion: _Motion) -> _Source:
    """Loading noise, the sum of three terms over c.

    They are::

        ldot_r / (d (1 - M_r)^2)
        c (l_r - l_M) / (d^2 (1 - M_r)^2)
        l_r (d Mdot_r + c (M_r - M^2)) / (d^2 (1 - M_r)^3)
    """
    omega, v, c = motion
    x, y, z = loads.position.T
    lx, ly, lz = loads.force.T
    l_m = (omega * (ly * x - lx * y) + v * lz) / c
    radiation = _radiation(x, y, z, motion)

    def emit(*observer: Array) -> tuple[Array, Array]:
        d, r, m_r, near, spread = radiation(*observer)
        l_r = lx * r[0] + ly * r[1] + lz * r[2]
        ldot_r = omega * (lx * r[1] - ly * r[0])  # the force turns with the blade
        return ((ldot_r * d / c + l_r - l_m) * (1 - m_r) + l_r * near / c) * spread, d

    return emit


def _radiation(
    x: Array, y: Array, z: Array, motion: _Motion
) -> Callable[[Array, Array, Array], _Radiation]:
    omega, v, c = motion
    m2 = (omega / c) ** 2 * (x**2 + y**2) + (v / c) ** 2
    m_z = v / c
    beta2 = 1 - m_z**2

    def toward(x_observer: Array, y_observer: Array, z_observer: Array) -> _Radiation:
        dx, dy, dz = x_observer - x, y_observer - y, z_observer - z
        # While the sound travels the observer flies on: d is the root of d = |D + (V d / c) e_z|.
        d = (m_z * dz + jnp.sqrt((m_z * dz) ** 2 + beta2 * (dx**2 + dy**2 + dz**2))) / beta2
        inverse = 1 / d
        r = dx * inverse, dy * inverse, dz * inverse + m_z
        m_r = omega / c * (x * r[1] - y * r[0]) + m_z * r[2]
        near = -(omega**2) / c * (x * dx + y * dy) + c * (m_r - m2)
        # dt/dtau = (1 - M_r) / (1 - M_observer,r)
        spread = 1 / ((d * (1 - m_r)) ** 2 * (1 - m_z * r[2]))
        return _Radiation(d, r, m_r, near, spread)

    return toward

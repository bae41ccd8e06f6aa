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

from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.harmonic_sums import cos_sin, harmonic_sums
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


@partial(compiled, static_argnames=("n_blades", "n_harmonics"))
def tones(
    panels: Panels,
    loads: PointLoads,
    n_blades: int,
    state: RotorState,
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
    state : RotorState
        Rotation speed Omega about +z, speed V of the rotor and the observers along +z, and the
        undisturbed air. At zero rotation speed nothing is periodic: all amplitudes are zero.
    observers : (n_observers, 3) array
        Positions from the rotor centre, moving with it [m].
    n_harmonics : int
        Number of harmonics of the blade-passage frequency (static).

    Returns
    -------
    Tones
        Amplitudes of thickness and loading noise [Pa]; frequencies are positive whichever way the
        rotor turns.

    Notes
    -----
    The relative tip speed must be below the speed of sound: see `require_subsonic_tip`, for a
    traced function cannot raise. N = 2 m_max B + 16 azimuths keep the harmonics within 0.01 dB at
    1.5 tip radii from the centre and beyond; closer observers ask for more.

    References
    ----------
    F. Farassat, Derivation of Formulations 1 and 1A of Farassat, NASA TM-2007-214853.
    """
    air = state.air
    operation = _Operation(
        *(
            jnp.asarray(q, float)
            for q in (state.rotation_speed, state.speed, air.density, air.sound_speed)
        )
    )
    blade = _Blade(panels, loads)
    sources = {name: source(blade, operation) for name, source in SOURCES.items()}

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time: megabytes, not GiB
    def amplitudes_at(observer: Array) -> dict[str, Array]:
        return {
            name: _fourier_integral(source, operation, n_blades, n_harmonics, observer)
            for name, source in sources.items()
        }

    amplitudes = jax.lax.map(amplitudes_at, jnp.asarray(observers, float))
    turning = operation.omega != 0
    frequency_hz = n_blades * operation.omega / (2 * np.pi) * np.arange(1, n_harmonics + 1)
    sound = Tones(frequency_hz, amplitudes).each(lambda p: jnp.where(turning, p, 0.0))
    return sound.of_positive_frequency


class _Blade(NamedTuple):
    panels: Panels
    loads: PointLoads


class _Operation(NamedTuple):
    omega: Array
    v: Array
    rho: Array
    c: Array


class _Radiation(NamedTuple):
    """One source and the direction in which its sound leaves, in the turning frame.

    d is Farassat's r, from the source at emission to the observer at reception, r his r-hat.
    """

    d: Array
    r: tuple[Array, Array, Array]
    m_r: Array
    near: Array  # d Mdot_r + c (M_r - M^2)
    spread: Array  # dt/dtau / (d^2 (1 - M_r)^3)


# From the observer's position in the turning frame to 4 pi p dt/dtau and the distance d of each
# source. What depends on the sources alone is computed once, outside the loop over azimuths.
_Source = Callable[[Array, Array, Array], tuple[Array, Array]]


def _fourier_integral(
    source: _Source, operation: _Operation, n_blades: int, n_harmonics: int, observer: Array
) -> Array:
    """Average ``p dt/dtau exp(1j n Omega t)`` of blade 1 over one turn, times B."""
    # The integrand holds harmonics up to n (1 + M), and some more in the near field.
    n_azimuths = 2 * n_harmonics * n_blades + 16
    azimuth = 2 * np.pi * np.arange(n_azimuths) / n_azimuths
    # The observer turns back instead of the blade forward: every blade quantity stays constant.
    x = observer[0] * np.cos(azimuth) + observer[1] * np.sin(azimuth)
    y = observer[1] * np.cos(azimuth) - observer[0] * np.sin(azimuth)

    @jax.checkpoint
    def strength_and_phase(position: tuple[Array, Array]) -> tuple[Array, Array, Array]:
        strength, d = source(*position, observer[2])
        return strength, *cos_sin(n_blades * operation.omega / operation.c * d)

    strength, cosine, sine = jax.lax.map(strength_and_phase, (x, y))
    sums = harmonic_sums(strength, cosine, sine, n_harmonics)
    turned = np.exp(1j * n_blades * np.outer(azimuth, np.arange(1, n_harmonics + 1)))
    return n_blades / (4 * np.pi * n_azimuths) * jnp.sum(sums * turned, axis=0)


def _thickness(blade: _Blade, operation: _Operation) -> _Source:
    """Thickness noise, rho v_n (d Mdot_r + c (M_r - M^2)) / (d^2 (1 - M_r)^3)."""
    # The other term, rho (vdot_n + v_ndot) / (d (1 - M_r)^2), is the change of v_n dS on a panel:
    # zero, since the surface is rigid.
    x, y, z = blade.panels.center.T
    sx, sy, sz = blade.panels.vector_area.T
    v_n = operation.omega * (x * sy - y * sx) + operation.v * sz
    radiation = _radiation(x, y, z, operation)

    def pressure(*observer: Array) -> tuple[Array, Array]:
        d, _, _, near, spread = radiation(*observer)
        return operation.rho * v_n * near * spread, d

    return pressure


def _loading(blade: _Blade, operation: _Operation) -> _Source:
    """Loading noise, the sum of three terms over c.

    The terms are::

        ldot_r / (d (1 - M_r)^2)
        c (l_r - l_M) / (d^2 (1 - M_r)^2)
        l_r (d Mdot_r + c (M_r - M^2)) / (d^2 (1 - M_r)^3)
    """
    omega, v, _, c = operation
    x, y, z = blade.loads.position.T
    lx, ly, lz = blade.loads.force.T
    l_m = (omega * (ly * x - lx * y) + v * lz) / c
    radiation = _radiation(x, y, z, operation)

    def pressure(*observer: Array) -> tuple[Array, Array]:
        d, r, m_r, near, spread = radiation(*observer)
        l_r = lx * r[0] + ly * r[1] + lz * r[2]
        ldot_r = omega * (lx * r[1] - ly * r[0])  # the force turns with the blade
        # each term times d^2 (1 - M_r)^3, which `spread` takes out again
        change = ldot_r * d * (1 - m_r)
        near_field = c * (l_r - l_m) * (1 - m_r)
        motion = l_r * near
        return (change + near_field + motion) / c * spread, d

    return pressure


#: Sources of tones by their names in `Tones`, each a function of blade and operation.
SOURCES = {"thickness": _thickness, "loading": _loading}


def _radiation(
    x: Array, y: Array, z: Array, operation: _Operation
) -> Callable[[Array, Array, Array], _Radiation]:
    omega, v, _, c = operation
    m2 = (omega / c) ** 2 * (x**2 + y**2) + (v / c) ** 2
    m_z = v / c

    def toward(x_observer: Array, y_observer: Array, z_observer: Array) -> _Radiation:
        dx, dy, dz = x_observer - x, y_observer - y, z_observer - z
        d = emission_distance(m_z * dz, dx**2 + dy**2 + dz**2, m_z**2)
        inverse = 1 / d
        r = dx * inverse, dy * inverse, dz * inverse + m_z
        m_r = omega / c * (x * r[1] - y * r[0]) + m_z * r[2]
        near = -(omega**2) / c * (x * dx + y * dy) + c * (m_r - m2)
        # dt/dtau = (1 - M_r) / (1 - M_observer,r)
        spread = 1 / ((d * (1 - m_r)) ** 2 * (1 - m_z * r[2]))
        return _Radiation(d, r, m_r, near, spread)

    return toward

"""Tonal noise of a steadily loaded rotor: Farassat's Formulation 1A over emission time."""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.acoustics.signals import Tones
from propmdao.acoustics.sources.harmonic_sums import harmonic_sums
from propmdao.acoustics.sources.source_rings import Rings, Sources, from_shaft, gathered
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
    of B and cancel in between. Elements are gathered on rings first (`source_rings`), which leaves
    of the harmonics what their sum has, to 1e-6 of those that matter.

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
    omega, v, c = (
        jnp.asarray(q, float) for q in (state.rotation_speed, state.speed, air.sound_speed)
    )
    turning = omega != 0.0
    # Lengths over c / Omega, the radius at which a blade would move at the speed of sound.
    scale = jnp.where(turning, jnp.abs(omega), 1.0) / c
    flight = _Flight(jnp.where(omega < 0.0, -1.0, 1.0), v / c)
    rings = gathered([_panels(panels, omega, v), _forces(loads)], n_blades, n_harmonics)

    @jax.checkpoint  # the reverse derivative recomputes one observer at a time
    def amplitudes_at(observer: Array) -> Array:
        return _fourier_integral(rings, flight, scale, n_blades, observer)

    amplitudes = jax.lax.map(amplitudes_at, jnp.asarray(observers, float))
    parts = {
        "thickness": jnp.where(turning, air.density * c * scale**2 * amplitudes[:, 0], 0.0),
        "loading": jnp.where(turning, scale**2 * amplitudes[:, 1:].sum(axis=1), 0.0),
    }
    frequency_hz = n_blades * omega / (2 * np.pi) * np.arange(1, n_harmonics + 1)
    return Tones(frequency_hz, parts).of_positive_frequency


class _Flight(NamedTuple):
    """Sense of the rotation, 1 or -1, and Mach number of the flight along the shaft."""

    sense: Array
    mach: Array


class _Radiation(NamedTuple):
    """Unit sources on rings and the direction in which their sound leaves; arrays (ring, azimuth).

    Lengths are over c / |Omega|. d is Farassat's r, from the source at emission to the observer at
    reception; r, his r-hat, and the Mach number are along the radius, the azimuth and the shaft.
    """

    d: Array
    r: tuple[Array, Array, Array]
    mach: tuple[Array | float, ...]
    m_r: Array
    near: Array  # (d Mdot_r + c (M_r - M^2)) / c
    spread: Array  # dt/dtau / (d^2 (1 - M_r)^3)


def _panels(panels: Panels, omega: Array, v: Array) -> Sources:
    """Panels as sources of thickness noise: their strength is v_n dS, which never changes."""
    x, y, _ = panels.center.T
    sx, sy, sz = panels.vector_area.T
    v_n = omega * (x * sy - y * sx) + v * sz
    return Sources(panels.center, v_n[None])


def _forces(loads: PointLoads) -> Sources:
    """Forces on the fluid as sources of loading noise."""
    x, y, _ = from_shaft(loads.position)
    lx, ly, lz = loads.force.T
    radius = jnp.sqrt(x**2 + y**2)
    radial, along = (x * lx + y * ly) / radius, (x * ly - y * lx) / radius
    return Sources(loads.position, jnp.stack([radial, along, lz]))


def _fourier_integral(
    rings: Rings, flight: _Flight, scale: Array, n_blades: int, observer: Array
) -> Array:
    """Average ``p dt/dtau exp(1j n Omega t)`` of blade 1 over one turn, times B, by component."""
    n_harmonics = rings.weights.shape[-1]
    # The integrand holds harmonics up to n (1 + M), and some more in the near field.
    n_azimuths = 2 * n_harmonics * n_blades + 16
    azimuth = 2 * np.pi * np.arange(n_azimuths) / n_azimuths
    toward = _radiation(rings, flight, scale, azimuth, observer)
    phase = n_blades * (flight.sense * toward.d + azimuth)
    # (ring, component, azimuth)
    strength = jnp.stack([_thickness(toward), *_loading(toward, flight)], axis=1)
    sums = harmonic_sums(strength, phase[:, None], n_harmonics)
    return n_blades / (4 * np.pi * n_azimuths) * jnp.sum(rings.weights * sums, axis=0)


def _thickness(toward: _Radiation) -> Array:
    """Thickness noise over rho c, v_n (d Mdot_r / c + M_r - M^2) / (d^2 (1 - M_r)^3)."""
    # The other term, rho (vdot_n + v_ndot) / (d (1 - M_r)^2), is the change of v_n dS on a panel:
    # zero, since the surface is rigid.
    return toward.near * toward.spread


def _loading(toward: _Radiation, flight: _Flight) -> tuple[Array, ...]:
    """Loading noise of a force along each of the axes, the sum of three terms.

    The terms are::

        ldot_r / (c d (1 - M_r)^2)
        (l_r - l_M) / (d^2 (1 - M_r)^2)
        l_r (d Mdot_r / c + M_r - M^2) / (d^2 (1 - M_r)^3)
    """
    d, r, mach, m_r, near, spread = toward
    # of l_r, since forces turn with the blade
    rate: tuple[Array | float, ...] = flight.sense * r[1], -flight.sense * r[0], 0.0
    # each term times d^2 (1 - M_r)^3, which `spread` takes out again
    return tuple(
        ((rate_i * d + r_i - mach_i) * (1 - m_r) + r_i * near) * spread
        for r_i, mach_i, rate_i in zip(r, mach, rate, strict=True)
    )


def _radiation(
    rings: Rings, flight: _Flight, scale: Array, azimuth: np.ndarray, observer: Array
) -> _Radiation:
    """Ways from rings to an observer, at azimuths of their sources."""
    sense, m_z = flight
    to_x, to_y, to_z = scale * observer
    shape = rings.radius.size, azimuth.size
    x = jnp.broadcast_to(scale * rings.radius[:, None], shape)
    # The observer turns back instead of the source forward, which stays at azimuth 0.
    dx = to_x * np.cos(azimuth) + to_y * np.sin(azimuth) - x
    dy = jnp.broadcast_to(to_y * np.cos(azimuth) - to_x * np.sin(azimuth), shape)
    dz = jnp.broadcast_to(to_z - scale * rings.height[:, None], shape)
    # Derivatives by all that comes now are worked out before they are summed, not with each sum.
    x, dx, dy, dz = jax.lax.optimization_barrier((x, dx, dy, dz))
    d = emission_distance(m_z * dz, dx**2 + dy**2 + dz**2, m_z**2)
    inverse = 1 / d
    r = dx * inverse, dy * inverse, dz * inverse + m_z
    m_azimuth = sense * x
    m_r = m_azimuth * r[1] + m_z * r[2]
    near = m_r - x**2 - m_z**2 - x * dx
    # dt/dtau = (1 - M_r) / (1 - M_observer,r)
    spread = 1 / ((d * (1 - m_r)) ** 2 * (1 - m_z * r[2]))
    return _Radiation(d, r, (0.0, m_azimuth, m_z), m_r, near, spread)

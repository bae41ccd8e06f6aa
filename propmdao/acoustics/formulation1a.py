"""Tonal noise of a steadily loaded rotor: Farassat's Formulation 1A, integrated over emission time."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike

from propmdao.records import PointLoads, record


@record
class Tones:
    """Complex pressure amplitudes of the blade-passage harmonics m = 1 ... n_harmonics.

    The pressure at an observer is ``p(t) = 2 Re sum_m P_m exp(-2j pi f_m t)``; the mean pressure
    (m = 0) is no sound and is left out.

    Attributes
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies m B Omega / 2 pi [Hz].
    thickness, loading : (n_observers, n_harmonics) complex arrays
        Amplitudes P_m of the two noise sources [Pa].
    """

    frequency_hz: Array
    thickness: Array
    loading: Array

    @property
    def total(self) -> Array:
        """Amplitudes of the whole pressure [Pa]: pressures add, levels never do."""
        return self.thickness + self.loading


@partial(jax.jit, static_argnames=("n_blades", "n_harmonics"))
def tones(
    panels,
    loads: PointLoads,
    n_blades: int,
    rotation_speed: ArrayLike,
    speed: ArrayLike,
    density: ArrayLike,
    sound_speed: ArrayLike,
    observers: ArrayLike,
    n_harmonics: int,
) -> Tones:
    r"""Tones of a rotor in steady axial flight, heard by observers that fly along with it.

    Formulation 1A (Farassat, NASA TM-2007-214853, eqs. 17 and 18) for a rigid surface and loads that
    are constant in the rotating frame, every near-field term kept. Because everything is periodic, the
    harmonics follow from a Fourier integral over emission time, without a retarded-time root::

        P_m = (B / N) sum_j sum_elements p(tau_j) exp(1j m B Omega t(tau_j)) (dt / dtau)_j

    with ``t = tau + d / c``. One blade is enough: the other blades double (triple, ...) the
    multiples of B and cancel everything else.

    Parameters
    ----------
    panels : Panels
        Closed surface of blade 1: ``center`` (n, 3) [m], ``vector_area`` (n, 3) outward [m^2].
    loads : PointLoads
        Forces of blade 1 on the fluid.
    n_blades : int
        Number of equally spaced blades B (static).
    rotation_speed : float
        Omega about +z [rad/s]. At zero there are no tones: all amplitudes are zero.
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
    The relative tip speed must be below the speed of sound; the caller checks that with
    :func:`require_subsonic_tip`, since a traced function cannot raise.
    """
    omega, v, c = (jnp.asarray(s, float) for s in (rotation_speed, speed, sound_speed))
    x, y, z = jnp.asarray(panels.center).T
    sx, sy, sz = jnp.asarray(panels.vector_area).T
    volume_rate = omega * (x * sy - y * sx) + v * sz
    px, py, pz = jnp.asarray(loads.position).T
    fx, fy, fz = jnp.asarray(loads.force).T
    order = 2 * n_harmonics * n_blades
    azimuth = 2 * np.pi * np.arange(order + 16) / (order + 16)

    def one(observer):
        # Rotating the observer back instead of the blade forward leaves every blade quantity constant.
        ox = (observer[0] * np.cos(azimuth) + observer[1] * np.sin(azimuth))[:, None]
        oy = (observer[1] * np.cos(azimuth) - observer[0] * np.sin(azimuth))[:, None]
        oz = observer[2]
        d, rz, mr, near = _geometry(x, y, z, ox, oy, oz, omega, v, c)
        p = density * volume_rate * near / (d * (1 - mr)) ** 2
        thickness = _harmonics(p / (1 - rz * v / c), d, omega / c, azimuth, n_blades, n_harmonics)

        d, rz, mr, near = _geometry(px, py, pz, ox, oy, oz, omega, v, c)
        rx, ry = (ox - px) / d, (oy - py) / d
        lr = fx * rx + fy * ry + fz * rz
        lm = (omega * (fy * px - fx * py) + v * fz) / c
        ldot_r = omega * (fx * ry - fy * rx)
        p = (ldot_r * d / c + lr - lm) / (d**2 * (1 - mr)) + lr * near / (c * (d * (1 - mr)) ** 2)
        loading = _harmonics(p / (1 - rz * v / c), d, omega / c, azimuth, n_blades, n_harmonics)
        return thickness, loading

    thickness, loading = jax.lax.map(one, jnp.asarray(observers, float))
    frequency_hz = n_blades * omega / (2 * np.pi) * np.arange(1, n_harmonics + 1)
    turning = omega != 0
    return Tones(frequency_hz, jnp.where(turning, thickness, 0), jnp.where(turning, loading, 0))


def require_subsonic_tip(
    radius: float, rotation_speed: float, speed: float, sound_speed: float
) -> None:
    """Refuse a rotor whose blade tip moves through the air at or above the speed of sound.

    Parameters
    ----------
    radius : float
        Tip radius [m].
    rotation_speed : float
        Omega [rad/s].
    speed, sound_speed : float
        Flight speed along the axis and speed of sound [m/s].

    Raises
    ------
    ValueError
        If the relative tip Mach number is 1 or more: Formulation 1A is singular there.
    """
    mach = np.hypot(rotation_speed * radius, speed) / sound_speed
    if not mach < 1:
        raise ValueError(
            f"relative tip Mach number must be below 1 for Formulation 1A; it is {mach:.3f} "
            f"(radius {radius:g} m, {rotation_speed:g} rad/s, {speed:g} m/s)"
        )


def _geometry(x, y, z, ox, oy, oz, omega, v, c):
    """Emission distance d, r_z, M_r and d Mdot_r + c (M_r - M^2)."""
    dx, dy, dz = ox - x, oy - y, oz - z
    mz = v / c
    # The observer flies on while the sound travels: x(t) - y(tau) = D + (V d / c) e_z.
    b2 = 1 - mz**2
    d = (mz * dz + jnp.sqrt((mz * dz) ** 2 + b2 * (dx**2 + dy**2 + dz**2))) / b2
    rz = dz / d + mz
    mr = (omega / c) * (x * dy - y * dx) / d + mz * rz
    m2 = (omega / c) ** 2 * (x**2 + y**2) + mz**2
    d_mdot_r = -(omega**2) / c * (x * dx + y * dy)
    return d, rz, mr, d_mdot_r + c * (mr - m2)


def _harmonics(p, d, k, azimuth, n_blades, n_harmonics):
    first = jnp.exp(1j * n_blades * (azimuth[:, None] + k * d))

    def step(phase, _):
        return phase * first, jnp.sum(p * phase)

    _, sums = jax.lax.scan(step, first, None, length=n_harmonics)
    return n_blades / (4 * np.pi * azimuth.size) * sums

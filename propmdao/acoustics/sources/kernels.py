"""Formulation 1A in general motion: radiation of moving panels and forces, a kernel for each.

`emission` works out how sources move when they emit and in which direction their sound leaves;
a kernel makes pressure of it. `TONAL_SOURCES` has all kernels by the names that `Tones` and
`PressureHistory` give to their parts.

The integrand is not shared with `formulation1a`: there all is seen from the turning frame, where
only the observer moves and the panels' v_n dS never changes, which saves half of the arithmetic of
the periodic case. Here surfaces may deform, loads may change and the frames move as they like.

References
----------
F. Farassat, Derivation of Formulations 1 and 1A of Farassat, NASA TM-2007-214853.
"""

from __future__ import annotations

from collections.abc import Callable
from math import comb
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.acoustics.kinematics.emission import emission_distance
from propmdao.acoustics.kinematics.motion import Poses
from propmdao.acoustics.sources.moving_sources import Sources
from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar

_Vector = tuple[Array, Array, Array]


class Emission(NamedTuple):
    """Sources when their sound leaves, and its way to one observer; each array (n, n_times).

    Attributes
    ----------
    vector, vector_rate : triples of arrays
        Vector areas [m^2] or forces on the fluid [N] on the ground, and their rates.
    velocity, acceleration : triples of arrays
        Motion of the sources on the ground [m/s], [m/s^2].
    distance : array
        Distance d from the source at emission to the observer at reception, t = tau + d / c [m],
        Farassat's r.
    direction : triple of arrays
        Unit vector in which the sound leaves, Farassat's r-hat.
    doppler : array
        Doppler factor 1 / (1 - M_r).
    near : array
        Factor of the near field, ``d Mdot_r + c (M_r - M^2)`` [m/s].
    rate : array
        Rate dt/dtau of the time of reception over that of emission.
    sound_speed : scalar
        Speed of sound c [m/s].
    """

    vector: _Vector
    vector_rate: _Vector
    velocity: _Vector
    acceleration: _Vector
    distance: Array
    direction: _Vector
    doppler: Array
    near: Array
    rate: Array
    sound_speed: Scalar


def emission(
    sources: Sources,
    pose: Poses,
    tau: Array,
    observer: Array,
    observer_velocity: Array,
    sound_speed: Scalar,
) -> Emission:
    """Motion of sources at given times, seen along the way of their sound to one observer.

    Parameters
    ----------
    sources : Sources
        Sources in their frame.
    pose : Poses
        Poses of the frame at the source times, as `Poses.time_last` has them.
    tau : (n_times,) array
        Source times [s].
    observer, observer_velocity : (3,) arrays
        Position of the observer at time 0 [m] and its velocity [m/s].
    sound_speed : float
        Speed of sound [m/s].

    Returns
    -------
    Emission
        Motion and directions of the sources, arrays (n, n_times), for a kernel.
    """
    c = sound_speed
    turns = tuple(map(jnp.asarray, (pose.rotation, pose.rotation_rate, pose.rotation_acceleration)))
    y, v, a = (
        _add(_derivative(turns, sources.position, k), tuple(origin))
        for k, origin in enumerate((pose.origin, pose.velocity, pose.acceleration))
    )
    q, q_dot = (_derivative(turns, sources.vector, k) for k in range(2))

    apart = tuple(observer[i] + observer_velocity[i] * tau - y[i] for i in range(3))
    m_o = tuple(observer_velocity[i] / c for i in range(3))
    d = emission_distance(_dot(m_o, apart), _dot(apart, apart), _dot(m_o, m_o))
    r = (apart[0] / d + m_o[0], apart[1] / d + m_o[1], apart[2] / d + m_o[2])

    m_r = _dot(v, r) / c
    return Emission(
        vector=q,
        vector_rate=q_dot,
        velocity=v,
        acceleration=a,
        distance=d,
        direction=r,
        doppler=1 / (1 - m_r),
        near=d * _dot(a, r) / c + c * m_r - _dot(v, v) / c,
        rate=(1 - m_r) / (1 - _dot(m_o, r)),
        sound_speed=c,
    )


def thickness_kernel(e: Emission) -> Array:
    """Thickness noise of panels, ``4 pi p / rho``.

    The two terms are, with v_n the normal velocity times the area::

        v_n_dot / (d (1 - M_r)^2)
        v_n (d Mdot_r + c (M_r - M^2)) / (d^2 (1 - M_r)^3)

    Parameters
    ----------
    e : Emission
        Panels when their sound leaves.

    Returns
    -------
    (n, n_times) array
        Pressure times 4 pi over density [m^2/s^2].
    """
    v_n = _dot(e.velocity, e.vector)
    v_n_dot = _dot(e.acceleration, e.vector) + _dot(e.velocity, e.vector_rate)
    return (v_n_dot + v_n * e.near * e.doppler / e.distance) * e.doppler**2 / e.distance


def loading_kernel(e: Emission) -> Array:
    """Loading noise of point forces, ``4 pi p``.

    The three terms are::

        ldot_r / (c d (1 - M_r)^2)
        (l_r - l_M) / (d^2 (1 - M_r)^2)
        l_r (d Mdot_r + c (M_r - M^2)) / (c d^2 (1 - M_r)^3)

    Parameters
    ----------
    e : Emission
        Forces when their sound leaves.

    Returns
    -------
    (n, n_times) array
        Pressure times 4 pi [Pa].
    """
    c, d = e.sound_speed, e.distance
    l_r, l_m = _dot(e.vector, e.direction), _dot(e.vector, e.velocity) / c
    ldot_r = _dot(e.vector_rate, e.direction)
    return (ldot_r / c + (l_r - l_m + l_r * e.near * e.doppler / c) / d) * e.doppler**2 / d


#: Pressure of each source times 4 pi over its scale, (n, n_times).
Kernel = Callable[[Emission], Array]


class TonalSource(NamedTuple):
    """Kernel of a source of tones, and the factor of its pressure that the air gives.

    Attributes
    ----------
    kernel : callable
        Pressure of each source times 4 pi over the scale.
    scale : callable
        Factor of the pressure that is the same for all sources, from the air.
    """

    kernel: Kernel
    scale: Callable[[Air], Scalar]


#: Sources of tones by name.
TONAL_SOURCES = {
    "thickness": TonalSource(thickness_kernel, lambda air: air.density),
    "loading": TonalSource(loading_kernel, lambda air: 1.0),
}


def _derivative(turns: tuple[Array, ...], local: tuple[Array, ...], order: int) -> _Vector:
    """Return the derivative of R x of an order by Leibniz' rule, by components (n, n_times)."""
    total: _Vector | None = None
    for k in range(min(order + 1, len(local))):
        factor, matrix, x = comb(order, k), turns[order - k], local[k]
        tx, ty, tz = (factor * _dot(tuple(matrix[i]), tuple(x)) for i in range(3))
        total = (tx, ty, tz) if total is None else _add(total, (tx, ty, tz))
    assert total is not None
    return total


def _dot(a: tuple[Array, ...], b: tuple[Array, ...]) -> Array:
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]


def _add(a: tuple[Array, ...], b: tuple[Array, ...]) -> _Vector:
    return a[0] + b[0], a[1] + b[1], a[2] + b[2]

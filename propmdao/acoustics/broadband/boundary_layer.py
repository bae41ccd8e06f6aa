"""Boundary layer at the trailing edge by the fits of Brooks, Pope and Marcolini to a NACA 0012.

Symbols and equation numbers are those of NASA RP-1218 (1989). Angles inside are in degrees, as in
its fits.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike

from propmdao.acoustics.broadband.smooth import ramp, smooth_abs
from propmdao.records.models import Trip
from propmdao.records.pytrees import record

#: Thickness of a lightly tripped layer over a heavily tripped one, as the report's program has it.
LIGHT_TRIP = 0.6
_LAST_ANGLE = 25.0  # the fits end here [deg]; larger angles keep its thickness
_CORNER = 0.25  # half width in which two fits over the angle meet [deg]
_RE_CORNER = 0.02  # the same over log10 of the Reynolds number
_ANGLE_CORNER = 0.2  # half width of |alpha| [deg]
_STANDSTILL = 1e-6  # m/s
_NO_CHORD = 1e-6  # m


@record
class BoundaryLayer:
    """Boundary layer at the trailing edge on both sides, thicknesses in m.

    Only `thickness_pressure`, the two displacement thicknesses and `shedding` make noise. Another
    model's values take their place by ``dataclasses.replace(layer, displacement_suction=...)``.

    Attributes
    ----------
    thickness_pressure, thickness_suction : array
        Boundary-layer thickness delta.
    displacement_pressure, displacement_suction : array
        Displacement thickness delta*.
    momentum_pressure, momentum_suction : array
        Momentum thickness theta.
    shedding : array
        Share of laminar vortex shedding: 1 for the fits of untripped layers, 0 of tripped ones.
    """

    thickness_pressure: Array
    thickness_suction: Array
    displacement_pressure: Array
    displacement_suction: Array
    momentum_pressure: Array
    momentum_suction: Array
    shedding: Array


def boundary_layer(
    chord: ArrayLike,
    speed: ArrayLike,
    angle_of_attack: ArrayLike,
    kinematic_viscosity: ArrayLike,
    trip: Trip = "none",
) -> BoundaryLayer:
    """Boundary layer at the trailing edge of an airfoil.

    Parameters
    ----------
    chord : array
        Chord [m].
    speed : array
        Speed of the flow over the section [m/s].
    angle_of_attack : array
        Angle from zero lift [rad]; its sign tells which side is the suction side.
    kinematic_viscosity : float
        Kinematic viscosity of the air [m^2/s].
    trip : {"none", "light", "heavy"}
        Trip near the leading edge; "none" is natural transition (static).

    Returns
    -------
    BoundaryLayer
        Thicknesses, of the shape to which chord, speed and angle broadcast; untripped layers shed
        laminar vortices, as far as the report's levels go.

    Notes
    -----
    Where two fits over the angle meet (5, 7.5, 12.5, 25 deg) they are rounded within 0.25 deg, by
    4 % of the thickness at most; below 0.2 deg the absolute angle is rounded by 0.1 deg.

    References
    ----------
    T. F. Brooks, D. S. Pope, M. A. Marcolini, NASA RP-1218, equations 2 to 16.
    """
    c, degrees = nonzero_chord(chord), absolute_degrees(angle_of_attack)
    x = jnp.log10(nonzero_speed(speed) * c / kinematic_viscosity)
    delta_0, displacement_0, momentum_0 = (10**power * c for power in _at_zero_angle(x, trip))

    alpha = _LAST_ANGLE - ramp(_LAST_ANGLE - degrees, _CORNER)
    tripped = trip != "none"
    # (log10 slopes per degree up to the first corner, to 12.5 deg, and beyond)
    slopes = (
        ((0.0311, 0.1231, 0.0258), (0.0679, 0.1516, 0.0258), (0.0559, 0.0869, 0.0258))  # 11-13
        if tripped
        else (
            (0.03114, 0.2336, 0.0258),
            (0.0679, 0.3066, 0.0258),
            (0.0559, 0.2157, 0.0258),
        )  # 14-16
    )
    first = 5.0 if tripped else 7.5
    delta_s, displacement_s, momentum_s = (
        10 ** (s1 * alpha + (s2 - s1) * ramp(alpha - first, _CORNER)
               + (s3 - s2) * ramp(alpha - 12.5, _CORNER))
        for s1, s2, s3 in slopes
    )  # fmt: skip
    return BoundaryLayer(
        thickness_pressure=delta_0 * 10 ** (-0.04175 * alpha + 0.00106 * alpha**2),  # 8
        thickness_suction=delta_0 * delta_s,
        displacement_pressure=displacement_0 * 10 ** (-0.0432 * alpha + 0.00113 * alpha**2),  # 9
        displacement_suction=displacement_0 * displacement_s,
        momentum_pressure=momentum_0 * 10 ** (-0.04508 * alpha + 0.000873 * alpha**2),  # 10
        momentum_suction=momentum_0 * momentum_s,
        shedding=jnp.full_like(delta_s, 0.0 if tripped else 1.0),
    )


def _at_zero_angle(x: Array, trip: Trip) -> tuple[Array, Array, Array]:
    """log10 of delta, delta* and theta over chord at zero angle; x is log10 of Re."""
    delta = -0.9045 * x + 0.0596 * x**2
    displacement = -1.5397 * x + 0.1059 * x**2
    momentum = -0.7079 * x + 0.0404 * x**2
    if trip == "none":
        return 1.6569 + delta, 3.0187 + displacement, 0.2021 + momentum  # 5, 6, 7
    share = jnp.log10(LIGHT_TRIP) if trip == "light" else 0.0
    # Two fits that meet at Re = 3e5 within 1 %: the step is spread over the corner.
    high = jnp.clip((x - jnp.log10(3e5)) / (2 * _RE_CORNER) + 0.5, 0.0, 1.0)
    high = high * high * (3 - 2 * high)
    return (
        share + 1.892 + delta,  # 2
        share + (1 - high) * (jnp.log10(0.0601) - 0.114 * x) + high * (3.411 + displacement),  # 3
        share + (1 - high) * (jnp.log10(0.0723) - 0.1765 * x) + high * (0.5578 + momentum),  # 4
    )


def absolute_degrees(angle_of_attack: ArrayLike) -> Array:
    """Absolute angle in degrees: the fits know the suction side, not the upper side.

    Parameters
    ----------
    angle_of_attack : array
        Angle from zero lift [rad].

    Returns
    -------
    array
        Absolute angle [deg], rounded below 0.2 deg, so that it is 0.1 deg at zero.
    """
    return smooth_abs(jnp.rad2deg(angle_of_attack), _ANGLE_CORNER)


def nonzero_speed(speed: ArrayLike) -> Array:
    """Speed that a logarithm can take: 1 micrometre per second at rest.

    Parameters
    ----------
    speed : array
        Speed [m/s].

    Returns
    -------
    array
        Speed [m/s].
    """
    return jnp.sqrt(jnp.square(speed) + _STANDSTILL**2)


def nonzero_chord(chord: ArrayLike) -> Array:
    """Chord that a logarithm can take: 1 micrometre at a pointed tip.

    Parameters
    ----------
    chord : array
        Chord [m].

    Returns
    -------
    array
        Chord [m].
    """
    return jnp.sqrt(jnp.square(chord) + _NO_CHORD**2)

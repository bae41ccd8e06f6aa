"""Momentum theory: the induced velocity at the disk of a rotor from its thrust.

    T = 2 rho A w sqrt((V sin i)^2 + (V cos i + w)^2)               (Glauert 1926, ARC R&M 1026)

with the incidence i between shaft and flight; in axial flight this is

    T = 2 rho A w (V + w)                                           (Glauert 1935, eq. I 1.13)

In hover nothing tells up from down: a rotor that pushes the air up, at negative thrust, is the
mirror image of one that pushes it down, and so is its induced velocity.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState

# The discriminant of momentum theory is kept above this (fraction of tip speed)^2, smoothly, so
# that a wake always leaves the disk: thrust below the windmilling limit, or none at all in hover.
_LEAST_SPEED_FRACTION = 5.0e-3
_HALVINGS = 60  # of the bracket: what 64 bits hold


def axial_induced_velocity(thrust: Scalar, state: RotorState, radius: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory, in hover and axial flight.

    Parameters
    ----------
    thrust : float
        Thrust of all blades, negative when windmilling [N].
    state : RotorState
        Rotation speed, flight speed along the shaft and air of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    float
        Induced velocity w along the shaft, positive downstream [m/s]; in hover negative where the
        thrust is.
    """
    return _axial_root(*_square_and_floor(thrust, state, radius), state.axial_speed)


def _square_and_floor(thrust: Scalar, state: RotorState, radius: Scalar) -> tuple[Scalar, Scalar]:
    """T / (2 rho A), and what the discriminant is kept above [m^2/s^2]."""
    square = thrust / (2.0 * state.air.density * jnp.pi * radius**2)
    return square, (_LEAST_SPEED_FRACTION * (state.rotation_speed * radius)) ** 2


def momentum_induced_velocity(thrust: Scalar, state: RotorState, radius: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory, at any incidence.

    Parameters
    ----------
    thrust : float
        Thrust of all blades, negative when windmilling [N].
    state : RotorState
        Rotation speed, flight speed, incidence and air of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    float
        Induced velocity w along the shaft, positive downstream, root of Glauert's equation [m/s];
        without incidence that of `axial_induced_velocity`.
    """
    square, floor = _square_and_floor(thrust, state, radius)
    axial = _axial_root(square, floor, state.axial_speed)
    # Where both are traced, either root has to be finite, with its derivatives.
    tilted = jnp.asarray(state.edgewise_speed) != 0.0
    edgewise = jnp.where(tilted, state.edgewise_speed, state.rotation_speed * radius)
    return jnp.where(tilted, _tilted_root(square, state.axial_speed, edgewise, floor), axial)


def lowest_induced_velocity(state: RotorState, radius: Scalar) -> Array:
    """Induced velocity from which on momentum theory has one root for every thrust.

    Parameters
    ----------
    state : RotorState
        Rotation speed, flight speed and incidence of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    float
        Half the flight speed against it, or minus the tip speed where the air may go either way
        through the disk: in hover and at an angle [m/s].
    """
    tip_speed = state.rotation_speed * radius
    return jnp.where(
        _goes_either_way(state), -tip_speed, -0.5 * state.axial_speed + 1.0e-6 * tip_speed
    )


def within_momentum_theory(thrust: Scalar, state: RotorState, radius: Scalar) -> Array:
    """Whether momentum theory has an induced velocity for a thrust: down to the windmilling limit.

    Parameters
    ----------
    thrust : float
        Thrust of all blades [N].
    state : RotorState
        Flight speed, incidence and air of the rotor.
    radius : float
        Tip radius [m].

    Returns
    -------
    bool
        Whether it has.
    """
    axial = state.axial_speed
    limit = -0.5 * jnp.pi * radius**2 * state.air.density * axial * jnp.abs(axial)
    return _goes_either_way(state) | (jnp.asarray(thrust) > limit)


def _goes_either_way(state: RotorState) -> Array:
    """Whether no direction through the disk is barred to the air: in hover and at an angle."""
    one_root = _rises_everywhere(state.axial_speed, state.edgewise_speed)
    return (jnp.asarray(state.speed) == 0.0) | one_root


def _rises_everywhere(axial: Scalar, edgewise: Scalar) -> Array:
    """Whether w sqrt(u^2 + (v + w)^2) rises with w everywhere, see `_tilted_root`."""
    return jnp.asarray(edgewise) ** 2 > 0.125 * jnp.asarray(axial) ** 2


def _axial_root(square: Scalar, floor: Scalar, speed: Scalar) -> Array:
    """Root of T / (2 rho A) = w (V + w); `square` is the left side [m^2/s^2]."""
    speed = jnp.asarray(speed)
    upward = (speed == 0.0) & (jnp.asarray(square) < 0.0)
    sign = jnp.where(upward, -1.0, 1.0)
    x = 0.25 * speed**2 + sign * square
    w = -0.5 * speed + jnp.sqrt(0.5 * (x + jnp.sqrt(x * x + 4.0 * floor * floor)))
    return sign * w


def _tilted_root(square: Scalar, speed: Scalar, edgewise: Scalar, floor: Scalar) -> Array:
    """Root of T / (2 rho A) = w sqrt(u^2 + (v + w)^2), for u that is not 0.

    The right side rises with w everywhere where u^2 > v^2 / 8, beyond 19.5 deg of incidence, and
    closer to axial flight above w = -v / 2 as there; where the thrust is below that, -v / 2 is all
    there is to return. The floor fades as u grows: in axial flight, with h = w + v / 2, it is
    h^2 - floor^2 / h^2 = v^2 / 4 + T / (2 rho A).
    """
    fixed = jax.lax.stop_gradient(
        jnp.broadcast_arrays(*(jnp.asarray(x, float) for x in (square, speed, edgewise, floor)))
    )

    def halved(_: int, bracket: tuple[Array, Array]) -> tuple[Array, Array]:
        low, high = bracket
        middle = 0.5 * (low + high)
        above = _excess(middle, *fixed) > 0.0
        return jnp.where(above, low, middle), jnp.where(above, middle, high)

    # With |w| > 2 |v| the resultant is above |w| / 2, and so |w| below sqrt(2 |T| / (2 rho A)).
    t, v, u, least = fixed
    reach = 2.0 * (jnp.sqrt(jnp.abs(t)) + jnp.abs(v) + jnp.sqrt(least))
    lowest = jnp.where((v <= 0.0) | _rises_everywhere(v, u), -reach, -0.5 * v)
    w = jax.lax.fori_loop(0, _HALVINGS, halved, (lowest, reach))[1]
    # One Newton step, in which alone the arguments count, gives the derivatives.
    encloses = _excess(lowest, *fixed) < 0.0
    slope = jax.jvp(lambda at: _excess(at, *fixed), (w,), (jnp.ones_like(w),))[1]
    return w - jnp.where(encloses, _excess(w, square, speed, edgewise, floor) / slope, 0.0)


def _excess(w: Array, square: Scalar, speed: Scalar, edgewise: Scalar, floor: Scalar) -> Array:
    h = w + 0.5 * speed
    least = floor**2 * h / (h * h + edgewise**2) ** 1.5
    return w * jnp.sqrt(edgewise**2 + (speed + w) ** 2) - least - square

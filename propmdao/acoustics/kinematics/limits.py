"""Limits of rotors, observers and air within which sound can be computed."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.observers import directions
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


def require_subsonic_tip(radius: float, state: RotorState) -> None:
    """Refuse a rotor whose blade tip moves through the air at or above the speed of sound.

    Parameters
    ----------
    radius : float
        Tip radius [m].
    state : RotorState
        Rotation speed, flight speed, incidence and air; not traceable by JAX.

    Raises
    ------
    ValueError
        If the relative tip Mach number is 1 or more: Formulation 1A is singular there.
    """
    mach = float(_tip_mach(radius, state))
    if not mach < 1:
        raise ValueError(
            f"relative tip Mach number must be below 1 for Formulation 1A; it is {mach:.3f} "
            f"(radius {radius:g} m, {state.rotation_speed:g} rad/s, {state.speed:g} m/s)"
        )


@compiled
def _tip_mach(radius: float, state: RotorState) -> Array:
    return jnp.asarray(state.tip_mach(radius))


def require_air(air: Air) -> None:
    """Refuse air without density or speed of sound.

    Parameters
    ----------
    air : Air
        State of the air; not traceable by JAX.

    Raises
    ------
    ValueError
        If density or speed of sound is not positive.
    """
    for name, value, unit in (
        ("density", air.density, "kg/m3"),
        ("sound speed", air.sound_speed, "m/s"),
    ):
        if not 0 < value < np.inf:
            raise ValueError(f"{name} must be positive; it is {value:g} {unit}")


def require_outside_rotor(positions: ArrayLike, tip_radius: float) -> None:
    """Refuse observers inside the source region, where Formulation 1A's sum does not hold.

    Parameters
    ----------
    positions : (n_observers, 3) array_like
        Positions from the rotor centre [m].
    tip_radius : float
        Radius of the sphere around the rotor centre that holds all sources [m].

    Raises
    ------
    ValueError
        If an observer is not outside that sphere; the message has its distance.
    """
    radius = directions(np.reshape(positions, (-1, 3))).radius
    inside = np.flatnonzero(~(radius > tip_radius))
    if inside.size:
        k = inside[0]
        raise ValueError(
            f"observer {k + 1} is inside the source region: {radius[k]:.4g} m from the rotor "
            f"centre; sources reach to {tip_radius:.4g} m"
        )

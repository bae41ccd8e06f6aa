"""What rotors, observers and air have to be for sound to be computed."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike

from propmdao.acoustics.kinematics.observers import directions


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


def require_air(density: float, sound_speed: float) -> None:
    """Refuse air that is none.

    Parameters
    ----------
    density, sound_speed : float
        [kg/m^3], [m/s].

    Raises
    ------
    ValueError
        If one of them is not positive.
    """
    for name, value, unit in (("density", density, "kg/m3"), ("sound speed", sound_speed, "m/s")):
        if not (np.isfinite(value) and value > 0):
            raise ValueError(f"{name} must be positive; it is {value:g} {unit}")


def require_outside_rotor(positions: ArrayLike, tip_radius: float) -> None:
    """Refuse observers inside the source region, where Formulation 1A's sum does not hold.

    Parameters
    ----------
    positions : (n_observers, 3) array_like
        From the rotor centre [m].
    tip_radius : float
        Of the rotor: the sphere of this radius around its centre holds all sources [m].

    Raises
    ------
    ValueError
        If an observer is not outside that sphere, with its distance.
    """
    radius = directions(np.reshape(positions, (-1, 3))).radius
    for k in np.flatnonzero(~(radius > tip_radius)):
        raise ValueError(
            f"observer {k + 1} is inside the source region: {radius[k]:.4g} m from the rotor "
            f"centre; sources reach to {tip_radius:.4g} m"
        )

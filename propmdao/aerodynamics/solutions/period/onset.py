"""Air that meets the blades of a rotor at an incidence, before their vortices act."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.sections.period_recambering import attached_share
from propmdao.aerodynamics.solutions.lattice_loads import LatticeGeometry
from propmdao.records.pytrees import Scalar, record
from propmdao.records.states import RotorState

_LEAST_SPEED = 1.0e-3  # of the sections' mean speed, below which no speed of theirs is


@record
class PeriodOnset:
    """Air that meets blade 1 over the azimuths before its vortices act.

    Attributes
    ----------
    velocity : (n_azimuths, 3, n_points) array
        Velocity of the undisturbed air relative to the lattice's points, in the frame of the
        blade [m/s].
    relative_speed : (n_azimuths, ns) array
        Speed of the air at the sections in the plane of their profile, induced velocity of the disk
        included [m/s].
    attached : (n_azimuths, ns) array
        Share of the lattice in the angle of attack, see `attached_share`.
    motion_angle : (n_azimuths, ns) array
        Angle at which this air meets the chord [rad].
    turning_share : (ns,) array
        Rotational speed of the tip over its resultant with the axial speed.
    """

    velocity: Array
    relative_speed: Array
    attached: Array
    motion_angle: Array
    turning_share: Array

    @property
    def mean_speed(self) -> Array:
        """Mean speed of the air at the sections over the turn, (ns,) [m/s]."""
        return self.relative_speed.mean(axis=0)


def azimuths_of(n_azimuths: int) -> np.ndarray:
    """Azimuths of a period, (n_azimuths,) [rad]."""
    return 2.0 * np.pi / n_azimuths * np.arange(n_azimuths)


def tilted_onset(
    lattice: LatticeGeometry, state: RotorState, induced_velocity: Scalar, azimuths: Array
) -> PeriodOnset:
    """Air that meets blade 1 of a rotor in flight at an incidence.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    state : RotorState
        Rotation speed, flight speed, incidence and air of the rotor.
    induced_velocity : float
        Induced velocity at the disk [m/s].
    azimuths : (n_azimuths,) array
        Azimuths of the blade [rad].

    Returns
    -------
    PeriodOnset
        Velocities of the air in the turning frame of the blade.
    """
    omega, edgewise, strips = state.rotation_speed, state.edgewise_speed, lattice.strips
    psi = azimuths[:, None]
    stream = -edgewise * jnp.cos(psi), edgewise * jnp.sin(psi)  # along x and y of the blade

    def air_at(x: Array, y: Array, axial: Scalar) -> Array:
        return jnp.stack(
            jnp.broadcast_arrays(omega * y + stream[0], -omega * x + stream[1], axial), axis=1
        )

    x, y = lattice.points[:, 0], lattice.points[:, 1]
    through = state.axial_speed + induced_velocity
    x_quarter, y_quarter = strips.quarter_chord[:, 0], strips.quarter_chord[:, 1]
    met = air_at(x_quarter, y_quarter, -through)
    # Against the rotation: what the blade meets from ahead.
    tangential = (met[:, 0] * y_quarter - met[:, 1] * x_quarter) / strips.radius
    speed = jnp.hypot(tangential, through)
    mean = jnp.hypot(omega * strips.radius, through)
    least = _LEAST_SPEED * mean
    share = tangential / jnp.maximum(speed, least) * mean / (omega * strips.radius)
    along, normal = (
        jnp.einsum("kcs,sc->ks", met, axis) for axis in (strips.backward, strips.upward)
    )
    tip_speed = omega * strips.radius / strips.r_over_R
    return PeriodOnset(
        velocity=air_at(x, y, -state.axial_speed),
        relative_speed=jnp.maximum(speed, least),
        attached=attached_share(share),
        motion_angle=jnp.arctan2(normal, jnp.where(speed > 0.0, along, 1.0)),
        turning_share=tip_speed / jnp.hypot(tip_speed, through),
    )

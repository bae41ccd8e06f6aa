"""Case to be solved: a rotor, how it turns and flies, its sections and its wake."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.wakes.helical import WakeTransport, wake_transport
from propmdao.records.pytrees import Scalar, record, static
from propmdao.records.states import RotorState


@record
class RotorCase:
    """A rotor to be solved.

    Attributes
    ----------
    rotor : RotorGeometry
        Blade and number of blades.
    state : RotorState
        Rotation speed, flight speed and air of the rotor.
    sections : ViscousSections or None
        Polars that the lattice is held to; None for inviscid flow.
    wake : WakeTransport
        Law by which the wake moves, and the ages of its nodes.
    n_azimuths : int
        Azimuths of a period at least, where the flow changes around the turn; fixed at compile
        time.
    """

    rotor: RotorGeometry
    state: RotorState
    sections: ViscousSections | None = None
    wake: WakeTransport = dataclasses.field(default_factory=wake_transport)
    n_azimuths: int = static(default=36)

    def turning(self, rotation_speed: Scalar) -> RotorCase:
        """The same case at another rotation speed [rad/s]."""
        return dataclasses.replace(self, state=self.state.turning(rotation_speed))

    def never_still(self) -> tuple[Array, RotorCase]:
        """Whether the rotor turns, and the case; where nothing turns, at 1 rad/s for the shapes."""
        rotation_speed = self.state.rotation_speed
        turning = jnp.asarray(rotation_speed > 0.0)
        return turning, self.turning(jnp.where(turning, rotation_speed, 1.0))

    def in_floats(self) -> RotorCase:
        """The same case with all numbers of its rotor and state as floats."""
        rotor, state = (
            jax.tree.map(lambda x: jnp.asarray(x, float), part) for part in (self.rotor, self.state)
        )
        return dataclasses.replace(self, rotor=rotor, state=state)

"""Operating points: as a user says them, and as the solvers take them."""

from __future__ import annotations

import dataclasses
import math

import jax.numpy as jnp
from jax import Array

from propmdao.records.air import Air, Turbulence, require_turbulence
from propmdao.records.pytrees import Scalar, record
from propmdao.records.quantities import require_asked
from propmdao.records.units import RAD_PER_S


@record
class RotorState:
    """Operation of a rotor as the solvers need it: it turns and flies through air.

    Attributes
    ----------
    rotation_speed : scalar
        Rotation speed about +z [rad/s].
    speed : scalar
        Flight speed, 0 is hover [m/s].
    air : Air
        The undisturbed air.
    incidence : scalar
        Angle between the shaft (+z) and the direction of flight, which lies in the plane of +z and
        +x: 0 is axial flight, pi/2 edgewise [rad].
    """

    rotation_speed: Scalar
    speed: Scalar
    air: Air
    incidence: Scalar = 0.0

    @property
    def mach(self) -> Scalar:
        """Mach number of the flight."""
        return self.speed / self.air.sound_speed

    @property
    def axial_speed(self) -> Scalar:
        """Part of the flight speed along the shaft [m/s]."""
        return self.speed * jnp.cos(self.incidence)

    @property
    def edgewise_speed(self) -> Scalar:
        """Part of the flight speed in the plane of the rotor, along +x [m/s]."""
        return self.speed * jnp.sin(self.incidence)

    @property
    def velocity(self) -> Array:
        """Velocity of the flight in the rotor's axes, (3,) [m/s]."""
        return jnp.stack(jnp.broadcast_arrays(self.edgewise_speed, 0.0, self.axial_speed))

    def tip_mach(self, radius: Scalar) -> Scalar:
        """Largest Mach number of a blade's tip on its way through the air.

        At an incidence that is on the side where the blade advances.

        Parameters
        ----------
        radius : scalar
            Tip radius [m].

        Returns
        -------
        scalar
            Mach number.
        """
        advancing = self.rotation_speed * radius + self.edgewise_speed
        return jnp.hypot(advancing, self.axial_speed) / self.air.sound_speed

    def turning(self, rotation_speed: Scalar) -> RotorState:
        """The same flight at another rotation speed [rad/s]."""
        return dataclasses.replace(self, rotation_speed=rotation_speed)


@dataclasses.dataclass(frozen=True)
class OperatingPoint:
    """Operating point of a propeller: a rotation speed or a thrust, at a flight speed, in air.

    Attributes
    ----------
    rpm : float or None
        Rotation speed [rev/min]; None where the thrust is given.
    thrust : float or None
        Thrust required of all blades [N]; None where the rotation speed is given.
    speed : float
        Flight speed, 0 is hover [m/s].
    incidence_deg : float
        Angle between the shaft and the direction of flight, 0 is axial flight [deg].
    air : Air
        The undisturbed air.
    turbulence : Turbulence
        Turbulence that flows in, for broadband noise; the loads know of none.

    Raises
    ------
    ValueError
        If not exactly one of rpm and thrust is given, or a value is out of range.
    """

    rpm: float | None = None
    thrust: float | None = None
    speed: float = 0.0
    incidence_deg: float = 0.0
    air: Air = dataclasses.field(default_factory=Air)
    turbulence: Turbulence = dataclasses.field(default_factory=Turbulence)

    def __post_init__(self) -> None:
        """Refuse points without exactly one of rpm and thrust, or with values out of range."""
        if (self.rpm is None) == (self.thrust is None):
            raise ValueError("give either rpm or thrust")
        if self.rpm is not None:
            require_asked("rpm", self.rpm)
        if self.thrust is not None:
            require_asked("thrust", self.thrust)
        require_asked("speed", self.speed)
        require_asked("incidence_deg", self.incidence_deg)
        # Not by Air itself, which JAX makes of what it traces.
        for field in dataclasses.fields(self.air):
            require_asked(field.name, getattr(self.air, field.name))
        require_turbulence(self.turbulence)

    def at(self, rotation_speed: Scalar) -> RotorState:
        """State of the rotor at a rotation speed.

        Parameters
        ----------
        rotation_speed : float
            Rotation speed [rad/s].

        Returns
        -------
        RotorState
            Rotation speed, flight speed and air, as the solvers take them.
        """
        incidence = math.radians(self.incidence_deg)
        return RotorState(rotation_speed, float(self.speed), self.air, incidence)

    @property
    def turbulent(self) -> Turbulence | None:
        """Turbulence that flows in, None where there is none."""
        return self.turbulence if self.turbulence.turbulence_intensity > 0.0 else None

    def require_axial(self, what: str) -> None:
        """Refuse an incidence where only axial flight is modelled.

        Parameters
        ----------
        what : str
            What is asked for, in words.

        Raises
        ------
        ValueError
            If there is an incidence.
        """
        if self.incidence_deg != 0.0:
            raise ValueError(
                f"incidence_deg must be 0 for {what}, known in axial flight alone; it is"
                f" {self.incidence_deg:g}"
            )

    @property
    def rotation_speed(self) -> float | None:
        """The rotation speed asked for [rad/s], None where a thrust is."""
        return None if self.rpm is None else self.rpm * RAD_PER_S

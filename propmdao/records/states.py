"""Operating points: as a user says them, and as the solvers take them."""

from __future__ import annotations

import dataclasses

import numpy as np

from propmdao.records.air import Air
from propmdao.records.pytrees import Scalar, record
from propmdao.records.units import RAD_PER_S


@record
class RotorState:
    """Operation of a rotor as the solvers need it: it turns and flies through air.

    Attributes
    ----------
    rotation_speed : scalar
        Rotation speed about +z [rad/s].
    speed : scalar
        Axial flight speed, 0 is hover [m/s].
    air : Air
        The undisturbed air.
    """

    rotation_speed: Scalar
    speed: Scalar
    air: Air

    @property
    def mach(self) -> Scalar:
        """Mach number of the flight."""
        return self.speed / self.air.sound_speed

    def turning(self, rotation_speed: Scalar) -> RotorState:
        """The same flight at another rotation speed [rad/s]."""
        return dataclasses.replace(self, rotation_speed=rotation_speed)


_OR_MORE = {"rpm": "0", "speed": "0 m/s"}
_POSITIVE = {
    "thrust": "N",
    "density": "kg/m3",
    "sound_speed": "m/s",
    "dynamic_viscosity": "Pa s",
    "temperature": "K",
    "pressure": "Pa",
}


def require_operable(name: str, value: float) -> None:
    """Refuse a value of an operating point that is out of range; call it outside ``jit``.

    Parameters
    ----------
    name : str
        Name of the value, a field of `OperatingPoint` or `Air`.
    value : float
        Value as it is asked for.

    Raises
    ------
    ValueError
        If rotation or flight is backwards, a property of the air or the thrust not positive, or
        the value not finite.
    """
    if name in _OR_MORE and not 0.0 <= value < np.inf:
        raise ValueError(f"{name} must be {_OR_MORE[name]} or more; it is {value:g}")
    if name in _POSITIVE and not 0.0 < value < np.inf:
        raise ValueError(f"{name} must be positive; it is {value:g} {_POSITIVE[name]}")
    if not np.isfinite(value):
        raise ValueError(f"{name} must be finite; it is {value:g}")


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
        Axial flight speed, 0 is hover [m/s].
    air : Air
        The undisturbed air.

    Raises
    ------
    ValueError
        If not exactly one of rpm and thrust is given, or a value is out of range.
    """

    rpm: float | None = None
    thrust: float | None = None
    speed: float = 0.0
    air: Air = dataclasses.field(default_factory=Air)

    def __post_init__(self) -> None:
        """Refuse points without exactly one of rpm and thrust, or with values out of range."""
        if (self.rpm is None) == (self.thrust is None):
            raise ValueError("give either rpm or thrust")
        for name in ("rpm", "thrust", "speed"):
            value = getattr(self, name)
            if value is not None:
                require_operable(name, value)
        for field in dataclasses.fields(self.air):
            require_operable(field.name, getattr(self.air, field.name))

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
        return RotorState(rotation_speed, float(self.speed), self.air)

    @property
    def rotation_speed(self) -> float | None:
        """The rotation speed asked for [rad/s], None where a thrust is."""
        return None if self.rpm is None else self.rpm * RAD_PER_S

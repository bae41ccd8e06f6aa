"""Electric motors as a user describes them: three constants."""

from __future__ import annotations

import dataclasses
import difflib
import functools
import tomllib

from propmdao.propeller.catalog import motor_file
from propmdao.records.quantities import MOTOR

#: Constants of a motor.
CONSTANTS = ("speed_constant", "resistance", "no_load_current")


class MotorError(ValueError):
    """A motor's description is wrong or cannot be found; the message is one line."""


@dataclasses.dataclass(frozen=True)
class Motor:
    """A direct-current motor, brushed or brushless with its controller.

    Attributes
    ----------
    name : str
        Name of the motor.
    speed_constant : float
        Rotation speed for each volt against the motor [rpm/V].
    resistance : float
        Electrical resistance [ohm].
    no_load_current : float
        Current without torque [A].
    source : str
        Origin of the numbers.

    Raises
    ------
    MotorError
        If a constant is no number or out of range.
    """

    name: str
    speed_constant: float
    resistance: float
    no_load_current: float
    source: str = ""

    def __post_init__(self) -> None:
        """Check the constants."""
        for key in CONSTANTS:
            allowed = MOTOR[key].allowed
            assert allowed is not None
            allowed.require(f"{key} of motor '{self.name}'", getattr(self, key), MotorError)


@functools.cache
def motors() -> dict[str, Motor]:
    """Read the motors of the catalogue.

    Returns
    -------
    dict of str to Motor
        Motors by name.
    """
    tables = tomllib.loads(motor_file().read_text(encoding="utf-8"))
    return {name: Motor(name, **table) for name, table in tables.items()}


def catalog_motor(name: str) -> Motor:
    """Get a motor of the catalogue.

    Parameters
    ----------
    name : str
        Name of the motor, one of `motors`.

    Returns
    -------
    Motor
        The motor.

    Raises
    ------
    MotorError
        If there is none of that name; the message lists those near.
    """
    known = motors()
    if name in known:
        return known[name]
    near = difflib.get_close_matches(name.lower(), known, cutoff=0.4) or sorted(known)
    raise MotorError(
        f"unknown motor '{name}'; near: {', '.join(near)}; or the path of a motor file of QPROP"
    )

"""Motor and battery behind a propeller: current, voltage, electrical power, and how long it lasts.

A direct-current motor by three constants (Drela, First-Order DC Electric Motor Model, MIT, 2007):
torque goes with the current beyond that of no load, rotation speed with the voltage beyond that of
the resistance,

    Q = (i - i0) / Kv,    Omega = (v - i R) Kv,

with Kv in rad/s for each volt. So torque and rotation speed give current and voltage at once; no
speed controller takes part.
"""

from __future__ import annotations

import dataclasses
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.propeller.motors import Motor
from propmdao.records.quantities import MOTOR
from propmdao.records.units import RAD_PER_S

_PER_HOUR = 3600.0  # s


@dataclasses.dataclass(frozen=True, eq=False)
class DriveState:
    """What a motor needs at rotation speeds and torques; arrays are shaped as these.

    Attributes
    ----------
    current : array
        Current through the motor [A].
    voltage : array
        Voltage at the motor [V].
    electrical_power : array
        Power that the motor takes [W]; below 0 of a generator.
    motor_efficiency : array
        Shaft power u over electrical power u + L, with L what is lost; u / (|u| + L) where the
        propeller drives the motor, and 0 where nothing moves.
    """

    current: npt.NDArray[np.float64]
    voltage: npt.NDArray[np.float64]
    electrical_power: npt.NDArray[np.float64]
    motor_efficiency: npt.NDArray[np.float64]


def driven_by(motor: Motor, rpm: npt.ArrayLike, torque: npt.ArrayLike) -> DriveState:
    """Compute what a motor needs to turn a propeller.

    Parameters
    ----------
    motor : Motor
        The motor.
    rpm : array
        Rotation speed [rpm].
    torque : array
        Torque at the shaft [N m].

    Returns
    -------
    DriveState
        Current, voltage, power and efficiency.
    """
    rpm, torque = np.asarray(rpm, dtype=float), np.asarray(torque, dtype=float)
    current = torque * motor.speed_constant * RAD_PER_S + motor.no_load_current
    voltage = current * motor.resistance + rpm / motor.speed_constant
    power, shaft_power = voltage * current, torque * rpm * RAD_PER_S
    scale = np.abs(shaft_power) + power - shaft_power
    efficiency = np.divide(shaft_power, scale, out=np.zeros_like(scale), where=scale > 0.0)
    return DriveState(current, voltage, power, efficiency)


def endurance(
    electrical_power: npt.ArrayLike, battery_energy: float, usable_share: float = 0.8
) -> npt.NDArray[np.float64]:
    """Compute how long a battery lasts.

    Parameters
    ----------
    electrical_power : array
        Power that is taken out of it, above 0 [W].
    battery_energy : float
        Energy of the full battery [W h].
    usable_share : float
        Part of it that may be used.

    Returns
    -------
    array
        Time [s].

    Raises
    ------
    ValueError
        If a power is not above 0, or the energy or its share is out of range.
    """
    for name, value in (("battery_energy", battery_energy), ("usable_share", usable_share)):
        allowed = MOTOR[name].allowed
        assert allowed is not None
        allowed.require(name, value)
    power = np.asarray(electrical_power, dtype=float)
    if not np.all(power > 0.0):
        raise ValueError(
            f"electrical_power must be above 0 for a battery to be emptied; it is {power.min():g} W"
        )
    return np.asarray(_PER_HOUR * usable_share * battery_energy / power)


def drive_result(
    motor: Motor,
    rpm: float,
    torque: float,
    battery_energy: float | None = None,
    usable_share: float = 0.8,
) -> dict[str, Any]:
    """Describe a motor at an operating point in plain numbers.

    Parameters
    ----------
    motor : Motor
        The motor.
    rpm : float
        Rotation speed [rpm].
    torque : float
        Torque at the shaft [N m].
    battery_energy : float, optional
        Energy of the full battery [W h].
    usable_share : float
        Part of it that may be used.

    Returns
    -------
    dict
        The key ``drive`` of ``propmdao analyze --json``; the endurance is None where the propeller
        drives the motor.

    Raises
    ------
    ValueError
        If the energy or its share is out of range.
    """
    state = driven_by(motor, rpm, torque)
    result: dict[str, Any] = {"motor": motor.name}
    result |= {key: getattr(motor, key)
               for key in ("speed_constant", "resistance", "no_load_current")}  # fmt: skip
    result |= {field.name: float(getattr(state, field.name)) for field in dataclasses.fields(state)}
    if battery_energy is not None:
        power = result["electrical_power"]
        lasts = float(endurance(abs(power) or 1.0, battery_energy, usable_share))
        result |= {"battery_energy": battery_energy, "usable_share": usable_share}
        result["endurance"] = lasts if power > 0.0 else None
    return result

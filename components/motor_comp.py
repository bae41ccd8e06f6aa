"""Motor and battery of a propeller as a component: current, voltage, power, time."""

from __future__ import annotations

from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.components.bases.refusals import require_numbers
from propmdao.formats.exchange.motor_files import load_motor
from propmdao.propeller.electric_drive import driven_by, endurance
from propmdao.propeller.motors import CONSTANTS, Motor
from propmdao.records.quantities import MOTOR, MOTOR_RESULTS
from propmdao.records.units import RAD_PER_S

_BATTERY = ("battery_energy", "usable_share")
#: What the current does not depend on.
_NOT_OF_CURRENT = ("rpm", "resistance")
_FOUND = ("current", "voltage", "electrical_power", "motor_efficiency")


class MotorComp(om.ExplicitComponent):
    """Current, voltage and power of a direct-current motor, and how long a battery lasts.

    Drela's first-order model, as `propmdao.propeller.electric_drive` has it, with exact partial
    derivatives. Connect `rpm` and `torque` of a `PropellerGroup`. The constants of the motor are
    inputs, so a design may choose them.

    Inputs
    ------
    rpm : float or (num_nodes,) array
        Rotation speed, ``rpm``.
    torque : float or (num_nodes,) array
        Torque at the shaft, ``N*m``.
    speed_constant : float
        Rotation speed for each volt against the motor, ``rpm/V``.
    resistance : float
        Electrical resistance, ``ohm``.
    no_load_current : float
        Current without torque, ``A``.
    battery_energy : float
        Energy of the full battery for this rotor, ``W*h``; with `battery`.
    usable_share : float
        Part of the energy that may be used, 0.8 by default; with `battery`.

    Outputs
    -------
    current : float or (num_nodes,) array
        Current through the motor, ``A``.
    voltage : float or (num_nodes,) array
        Voltage at the motor, ``V``.
    electrical_power : float or (num_nodes,) array
        Power that the motor takes, ``W``; below 0 of a generator.
    motor_efficiency : float or (num_nodes,) array
        Shaft power over electrical power; below 0 of a generator.
    endurance : float or (num_nodes,) array
        Time for which the usable energy lasts, ``s``; with `battery`.

    Options
    -------
    motor : str, path or Motor
        Motor whose constants are the values of the inputs: a name of the catalogue, a motor file of
        QPROP or a `Motor`.
    battery : bool
        Whether there is a battery, which asks for a power above 0.
    num_nodes : int
        Number of operating points.

    Raises
    ------
    MotorError
        If there is no such motor.
    om.AnalysisError
        If an input is not finite, or the propeller drives the motor and there is a battery.
    """

    def initialize(self) -> None:
        self.options.declare("motor", desc="Name, motor file of QPROP or Motor.")
        self.options.declare("battery", False, types=bool, desc="Whether there is a battery.")
        self.options.declare("num_nodes", 1, types=int, lower=1, desc="Operating points.")

    def setup(self) -> None:
        motor = self.options["motor"]
        motor = motor if isinstance(motor, Motor) else load_motor(motor)
        n, battery = self.options["num_nodes"], self.options["battery"]
        self.add_input("rpm", 1000.0, shape=n, units="rpm", desc="rotation speed")
        self.add_input("torque", 0.0, shape=n, units="N*m", desc="torque at the shaft")
        values = {key: getattr(motor, key) for key in CONSTANTS}
        if battery:
            values |= {"battery_energy": 10.0, "usable_share": MOTOR["usable_share"].default}
        for name, value in values.items():
            quantity = MOTOR[name]
            units, desc = quantity.unit or None, quantity.meaning
            self.add_input(name, value, units=units, desc=desc, tags="dymos.static_target")
        for name in (*_FOUND, "endurance") if battery else _FOUND:
            quantity = MOTOR_RESULTS[name]
            self.add_output(name, shape=n, units=quantity.unit or None, desc=quantity.meaning)
            rows = np.arange(n)
            for source in ("rpm", "torque", *CONSTANTS):
                if name == "current" and source in _NOT_OF_CURRENT:
                    continue
                diagonal = {} if source in CONSTANTS else {"rows": rows, "cols": rows}
                self.declare_partials(name, source, **diagonal)
        if battery:
            self.declare_partials("endurance", _BATTERY)

    def compute(self, inputs: Any, outputs: Any) -> None:
        require_numbers("input ", inputs)
        state = driven_by(self._motor(inputs), inputs["rpm"], inputs["torque"])
        for name in _FOUND:
            outputs[name] = getattr(state, name)
        if self.options["battery"]:
            energy, share = (float(inputs[name][0]) for name in _BATTERY)
            try:
                outputs["endurance"] = endurance(state.electrical_power, energy, share)
            except ValueError as error:
                raise om.AnalysisError(f"{self.pathname}: {error}") from error

    def compute_partials(self, inputs: Any, partials: Any) -> None:
        motor, rpm, torque = self._motor(inputs), inputs["rpm"], inputs["torque"]
        state = driven_by(motor, rpm, torque)
        kv, resistance, current = motor.speed_constant, motor.resistance, state.current
        ones = np.ones_like(rpm)
        by_current = {
            "rpm": 0.0 * ones,
            "torque": kv * RAD_PER_S * ones,
            "speed_constant": torque * RAD_PER_S,
            "resistance": 0.0 * ones,
            "no_load_current": ones,
        }
        by_shaft_power = dict.fromkeys(by_current, 0.0 * ones)
        by_shaft_power |= {"rpm": torque * RAD_PER_S, "torque": rpm * RAD_PER_S}
        shaft_power = torque * rpm * RAD_PER_S
        scale = np.abs(shaft_power) + state.electrical_power - shaft_power
        moving = scale > 0.0
        safe = np.where(moving, scale, 1.0)
        for name, slope in by_current.items():
            by_voltage = resistance * slope
            if name == "rpm":
                by_voltage = by_voltage + 1.0 / kv
            elif name == "speed_constant":
                by_voltage = by_voltage - rpm / kv**2
            elif name == "resistance":
                by_voltage = by_voltage + current
            by_power = by_voltage * current + state.voltage * slope
            work = by_shaft_power[name]
            by_scale = by_power + (np.sign(shaft_power) - 1.0) * work
            by_efficiency = (work - state.motor_efficiency * by_scale) / safe
            slopes = {
                "current": slope,
                "voltage": by_voltage,
                "electrical_power": by_power,
                "motor_efficiency": np.where(moving, by_efficiency, 0.0),
            }
            if self.options["battery"]:
                lasts = self._endurance(inputs, state.electrical_power)
                slopes["endurance"] = -lasts / state.electrical_power * by_power
            if name in _NOT_OF_CURRENT:
                del slopes["current"]
            for output, value in slopes.items():
                partials[output, name] = value[:, None] if name in CONSTANTS else value
        if self.options["battery"]:
            for name in _BATTERY:
                partials["endurance", name] = (lasts / inputs[name])[:, None]

    def _motor(self, inputs: Any) -> Motor:
        """Motor whose constants are the inputs."""
        try:
            return Motor(
                name=self.pathname,
                speed_constant=float(inputs["speed_constant"][0]),
                resistance=float(inputs["resistance"][0]),
                no_load_current=float(inputs["no_load_current"][0]),
            )
        except ValueError as error:
            raise om.AnalysisError(str(error)) from error

    def _endurance(self, inputs: Any, power: Any) -> Any:
        """Time for which the battery lasts."""
        return endurance(power, *(float(inputs[name][0]) for name in _BATTERY))

"""Motor and battery of an analysis: options, results, lines for people."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any

from propmdao.commands.options import number
from propmdao.records.quantities import MOTOR

if TYPE_CHECKING:
    from propmdao.propeller.motors import Motor


def add_drive(command: argparse.ArgumentParser) -> None:
    """Add the options of motor and battery to a command.

    Parameters
    ----------
    command : argparse parser
        What they are added to.
    """
    group = command.add_argument_group(
        "motor and battery", "A direct-current motor by three constants, of one rotor."
    )
    group.add_argument(
        "--motor",
        metavar="MOTOR",
        help="name of a motor of the catalogue, or path of a motor file of QPROP: current, voltage,"
        " electrical power and efficiency",
    )
    group.add_argument(
        MOTOR["battery_energy"].option,
        dest="battery_energy",
        type=number,
        metavar=MOTOR["battery_energy"].placeholder,
        help="energy of the battery for this rotor [W h], a quarter of it on a quadcopter: how long"
        " it lasts",
    )
    share = MOTOR["usable_share"]
    group.add_argument(
        share.option,
        type=number,
        metavar=share.placeholder,
        help=f"part of that energy that may be used, default {share.default}",
    )


def motor_of(options: argparse.Namespace) -> Motor | None:
    """Get the motor that is asked for, and refuse what does not go together, before the work.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    Motor or None
        The motor.

    Raises
    ------
    ValueError
        If there is a battery without a motor or a share without a battery, a value is out of
        range, or there is no such motor.
    """
    if options.usable_share is not None and options.battery_energy is None:
        raise ValueError("--usable-share is of a battery: add --battery-wh WH")
    if options.battery_energy is not None and options.motor is None:
        raise ValueError("--battery-wh needs a motor, as with --motor axi_2204_54")
    for name in ("battery_energy", "usable_share"):
        value, allowed = getattr(options, name), MOTOR[name].allowed
        if value is not None and allowed is not None:
            allowed.require(MOTOR[name].option, value)
    if options.motor is None:
        return None
    from propmdao.formats.exchange.motor_files import load_motor

    return load_motor(options.motor)


def add_drive_results(
    results: Sequence[dict[str, Any]], motor: Motor | None, options: argparse.Namespace
) -> None:
    """Add what the motor needs to results.

    Parameters
    ----------
    results : sequence of dict
        Results with the keys of ``propmdao analyze --json``, to each of which ``drive`` is added.
    motor : Motor or None
        The motor; None adds nothing.
    options : argparse.Namespace
        What was typed.
    """
    if motor is None:
        return
    from propmdao.propeller.electric_drive import drive_result

    share = options.usable_share
    share = MOTOR["usable_share"].default if share is None else share
    for result in results:
        result["drive"] = drive_result(
            motor, result["rpm"], result["torque"], options.battery_energy, share
        )


def drive_lines(results: Sequence[dict[str, Any]]) -> list[str]:
    """Motor and battery at operating points, in words.

    Parameters
    ----------
    results : sequence of dict
        Results with the keys of ``propmdao analyze --json``.

    Returns
    -------
    list of str
        Two lines for each point with a motor, three where there is a battery.
    """
    return [line for result in results if "drive" in result for line in _lines(result)]


def _lines(result: dict[str, Any]) -> list[str]:
    drive = result["drive"]
    lines = [
        f"Motor {drive['motor']} at {result['rpm']:.1f} rpm: {drive['current']:.4g} A at"
        f" {drive['voltage']:.4g} V,",
        f"  {drive['electrical_power']:.4g} W, efficiency {drive['motor_efficiency']:.3f}.",
    ]
    if "endurance" in drive:
        battery = f"{drive['usable_share']:.4g} of {drive['battery_energy']:.4g} W h"
        lasts = drive["endurance"]
        lines.append(
            f"  {battery} last {lasts / 60.0:.1f} minutes."
            if lasts is not None
            else f"  The propeller drives the motor: {battery} are not used."
        )
    return lines

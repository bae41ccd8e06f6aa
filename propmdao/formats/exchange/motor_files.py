"""Motors by name or from motor files of QPROP.

A name; the number of the motor's model, 1; resistance [ohm], current without load [A] and speed
constant [rpm/V], a line each (Drela, QPROP User Guide 1.21, 2007).
"""

from __future__ import annotations

import os
from pathlib import Path

from propmdao.propeller.motors import Motor, MotorError, catalog_motor, motors
from propmdao.runtime.input_files import clipped, fields_of, finite_number, read_text

_CONSTANTS = ("Rmotor", "Io", "Kv")


def load_motor(name_or_path: str | os.PathLike[str]) -> Motor:
    """Get a motor from the catalogue or from a motor file of QPROP.

    Parameters
    ----------
    name_or_path : str or path
        A name of `propmdao.propeller.motors.motors`, which has precedence over a file of that
        name, or the path of a file.

    Returns
    -------
    Motor
        The motor.

    Raises
    ------
    MotorError
        If there is no such motor (the message lists near names), or the file is wrong.
    """
    name = os.fspath(name_or_path)
    if name in motors() or not Path(name).is_file():
        return catalog_motor(name)
    path = Path(name)
    lines = [
        content
        for line in read_text(path, MotorError, undecodable="replace").splitlines()
        if (content := line.split("!")[0].split("#")[0].strip())
    ]
    if len(lines) < 2 + len(_CONSTANTS):
        raise MotorError(
            f"{path}: a name, the number of a model and {', '.join(_CONSTANTS)} expected, a line "
            f"each; there are {len(lines)} lines"
        )
    model, *values = (_number(path, *pair) for pair in zip(("model", *_CONSTANTS), lines[1:5],
                                                           strict=True))  # fmt: skip
    if model != 1.0:
        raise MotorError(f"{path}: motors of model 1 are read, not of model {model:g}")
    resistance, no_load_current, speed_constant = values
    return Motor(path.stem, speed_constant, resistance, no_load_current, f"QPROP, {path.name}")


def _number(path: Path, name: str, line: str) -> float:
    """First number of a line."""
    fields = fields_of(line)
    if fields is None:
        raise MotorError(f"{path}: {name}: '{clipped(line)}' is no number")
    return finite_number(fields[0], MotorError, f"{path}: {name}")

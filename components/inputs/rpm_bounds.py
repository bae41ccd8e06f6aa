"""Between which rotation speeds the one that gives a thrust is looked for."""

from __future__ import annotations

from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.trim import Bounds, rotation_bounds
from propmdao.components.bases.array_function import Arrays
from propmdao.records.units import RAD_PER_S


def declare_bounds(options: OptionsDictionary) -> None:
    """Declare the bounds.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    desc = "Lowest and highest rpm; None: by the speed of the tip."
    options.declare("rpm_bounds", None, types=tuple, allow_none=True, desc=desc)


def given_bounds(options: OptionsDictionary) -> Bounds | None:
    """Bounds that hold for every diameter and flight speed.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.

    Returns
    -------
    Bounds or None
        Lowest and highest rotation speed; None where diameter and flight speed say.

    Raises
    ------
    ValueError
        Where they are not positive and rising.
    """
    if options["rpm_bounds"] is None:
        return None
    low, high = options["rpm_bounds"]
    if not 0.0 < low < high:
        raise ValueError(f"rpm_bounds must be positive and rising; they are {low:g}, {high:g}")
    return Bounds(low * RAD_PER_S, high * RAD_PER_S)


def bounds_at(inputs: Arrays, given: Bounds | None) -> Bounds:
    """Bounds at an operating point.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs with the diameter and the flight speed.
    given : Bounds or None
        What `given_bounds` returned.

    Returns
    -------
    Bounds
        Those that are given, or those of the speed of the tip.
    """
    if given is not None:
        return given
    return rotation_bounds(0.5 * inputs["diameter"][0], inputs["speed"][0])

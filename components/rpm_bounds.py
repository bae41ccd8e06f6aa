"""Between which rotation speeds the one that gives a thrust is looked for."""

from __future__ import annotations

from typing import Any

import numpy as np
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.trim import LARGEST_TIP_SPEED, LEAST_TIP_SPEED
from propmdao.components.bases.array_function import Arrays
from propmdao.records.units import RAD_PER_S

_TIP_SPEEDS = np.array([LEAST_TIP_SPEED, LARGEST_TIP_SPEED])


def declare_bounds(options: OptionsDictionary) -> None:
    """Declare the bounds.

    Parameters
    ----------
    options : OptionsDictionary
        Of a component or group.
    """
    desc = "Lowest and highest rpm; None: by the speed of the tip."
    options.declare("rpm_bounds", None, types=tuple, allow_none=True, desc=desc)


def given_bounds(options: OptionsDictionary) -> np.ndarray | None:
    """Bounds that hold for every diameter.

    Parameters
    ----------
    options : OptionsDictionary
        Of a component.

    Returns
    -------
    (2,) array or None
        Lowest and highest rotation speed [rad/s]; None where the diameter says.

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
    return np.array([low, high]) * RAD_PER_S


def bounds_at(inputs: Arrays, given: Any) -> Any:
    """Bounds at a diameter.

    Parameters
    ----------
    inputs : dict of arrays
        With the diameter.
    given : (2,) array or None
        Of `given_bounds`.

    Returns
    -------
    (2,) array
        Those that are given, or those of the tip's speed [rad/s].
    """
    return _TIP_SPEEDS / (0.5 * inputs["diameter"]) if given is None else given

"""Rotation speeds between which the one that gives a thrust is looked for."""

from __future__ import annotations

from typing import Any

import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.trim import Bounds, TrimError, require_bounds, rotation_bounds
from propmdao.components.bases.array_function import Arrays
from propmdao.records.units import RAD_PER_S


def declare_bounds(options: OptionsDictionary) -> None:
    """Declare the bounds, which are checked when they are given.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "rpm_bounds",
        None,
        types=tuple,
        allow_none=True,
        check_valid=_require_rising,
        desc="lowest and highest rpm; None: those of the lowest and highest tip speed",
    )


def _require_rising(_: str, rpm_bounds: tuple[float, float] | None) -> None:
    if rpm_bounds is not None:
        require_bounds(_bounds(rpm_bounds), speed=0.0)


def fixed_bounds(options: OptionsDictionary) -> Bounds | None:
    """Bounds that hold for every diameter and flight speed.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.

    Returns
    -------
    Bounds or None
        Lowest and highest rotation speed; None if they follow diameter and flight speed.
    """
    rpm_bounds = options["rpm_bounds"]
    return None if rpm_bounds is None else _bounds(rpm_bounds)


def _bounds(rpm_bounds: tuple[float, float]) -> Bounds:
    low, high = rpm_bounds
    return Bounds(low * RAD_PER_S, high * RAD_PER_S)


def bounds_at(inputs: Arrays, fixed: Bounds | None) -> Bounds:
    """Bounds at an operating point.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name, the diameter and the flight speed among them.
    fixed : Bounds or None
        Bounds that hold everywhere; None for those of the tip speed.

    Returns
    -------
    Bounds
        Lowest and highest rotation speed.
    """
    if fixed is not None:
        return fixed
    return rotation_bounds(0.5 * inputs["diameter"][0], inputs["speed"][0])


def checked_bounds_at(inputs: Any, fixed: Bounds | None) -> Bounds:
    """Bounds at an operating point, outside compiled code, where they can be refused.

    Parameters
    ----------
    inputs, fixed
        Arguments of `bounds_at`.

    Returns
    -------
    Bounds
        Lowest and highest rotation speed.

    Raises
    ------
    om.AnalysisError
        If the flight is too fast to trim.
    """
    bounds = bounds_at(inputs, fixed)
    try:
        require_bounds(bounds, inputs["speed"][0])
    except TrimError as error:
        raise om.AnalysisError(str(error)) from error
    return bounds

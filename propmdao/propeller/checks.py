"""Checks of described propellers: a value out of range becomes one line that names it."""

from __future__ import annotations

import reprlib
from collections.abc import Iterable
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.propeller.airfoils.airfoil import AirfoilError
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.records.units import Range

FloatArray = npt.NDArray[np.float64]


#: Stations of a blade; more than a scan needs are a mistake and take memory.
MOST_STATIONS = 1000
#: Radius of the first station over the tip radius: there is a hub, however small.
_RADIUS = Range(1e-4, 1.0)
#: Chord over tip radius.
CHORD = Range(1e-6, 10.0)
#: Sweep and rake over tip radius.
OFFSET = Range(-10.0, 10.0)
#: Maximum thickness over chord.
THICKNESS = Range(1e-4, 0.999)
#: Maximum camber over chord.
CAMBER = Range(-0.5, 0.5)
#: Cross-section over the chord squared.
AREA = Range(1e-5, 10.0)
#: Thickness of a blunt trailing edge over tip radius.
EDGE = Range(0.0, 1.0)
#: Angle between the surfaces at the trailing edge.
EDGE_ANGLE = Range(0.0, 60.0, "deg")


class PropellerError(ValueError):
    """A propeller's description is wrong or cannot be found; the message is one line."""


def number(key: str, value: Any) -> float:
    """Return the value as a finite float.

    Parameters
    ----------
    key : str
        Name of the value in messages.
    value : object
        Value as the user has it.

    Returns
    -------
    float
        The number.

    Raises
    ------
    PropellerError
        If the value is not a number (text or a truth value, too) or not finite.
    """
    try:
        result = float(value)
    except (TypeError, ValueError, OverflowError):  # the last by hundreds of digits
        raise PropellerError(f"{key} must be a number; it is {reprlib.repr(value)}") from None
    if isinstance(value, (str, bool)) or not np.isfinite(result):
        raise PropellerError(f"{key} must be a finite number; it is {reprlib.repr(value)}")
    return result


def distribution(key: str, values: Any, r: FloatArray | None = None) -> FloatArray:
    """Return the values as a read-only array of finite numbers.

    Parameters
    ----------
    key : str
        Name of the distribution in messages.
    values : array_like
        Values as the user has them.
    r : (n_stations,) array, optional
        Stations that need one value each.

    Returns
    -------
    (n_stations,) array
        A read-only copy.

    Raises
    ------
    PropellerError
        If the values are not a list of numbers, not one per station or not all finite.
    """
    try:
        array = np.array(values)
        valid = array.ndim == 1 and array.dtype.kind in "fiu"
    except ValueError:  # lists of unequal length inside the list
        valid = False
    if not valid:
        raise PropellerError(f"{key} must be a list of numbers; it is {reprlib.repr(values)}")
    array = array.astype(float)
    if r is not None and array.size != r.size:
        raise PropellerError(f"{key} has {array.size} values for {r.size} stations of r_over_R")
    require(key, "be finite", np.isfinite(array), array, r)
    array.setflags(write=False)
    return array


def require(
    key: str,
    rule: str,
    holds: npt.NDArray[np.bool_],
    values: FloatArray,
    r: FloatArray | None = None,
) -> None:
    """Raise for the first station where a condition does not hold.

    Parameters
    ----------
    key, rule : str
        Name of the distribution, and its rule in words; the message begins ``key must rule``.
    holds : (n_stations,) array of bool
        True at the stations that keep the rule.
    values : (n_stations,) array
        Values of the distribution.
    r : (n_stations,) array, optional
        Stations, named in the message.

    Raises
    ------
    PropellerError
        ``key must rule; station 3 (r/R 0.25) has -0.02``; stations count from 1.
    """
    if not holds.all():
        i = int(np.argmin(holds))
        where = "" if r is None else f" (r/R {r[i]:.10g})"
        raise PropellerError(f"{key} must {rule}; station {i + 1}{where} has {values[i]:.10g}")


def require_within(
    key: str, allowed: Range, values: FloatArray, r: FloatArray | None = None
) -> None:
    """Raise for the first station whose value is outside a range.

    Parameters
    ----------
    key : str
        Name of the distribution.
    allowed : Range
        Values that are allowed.
    values : (n_stations,) array
        Values of the distribution.
    r : (n_stations,) array, optional
        Stations, named in the message.

    Raises
    ------
    PropellerError
        If there is one; the message is that of `require`.
    """
    holds = (allowed.lowest <= values) & (values <= allowed.highest)
    require(key, f"be {allowed}", holds, values, r)


def words(key: str, known: tuple[str, ...], values: Any, r: FloatArray) -> str | tuple[str, ...]:
    """Return a word that stands for all stations, or one for each of them.

    Parameters
    ----------
    key : str
        Name of what the words say.
    known : tuple of str
        Words that there are.
    values : str or sequence of str
        Words as the user has them.
    r : (n_stations,) array
        Stations that need one word each.

    Returns
    -------
    str or (n_stations,) tuple of str
        The word, or the words.

    Raises
    ------
    PropellerError
        If a word is unknown, or there is not one for each station.
    """
    if isinstance(values, str):
        if values not in known:
            raise PropellerError(f"{key} must be one of {', '.join(known)}; it is {values!r}")
        return values
    if not isinstance(values, list | tuple):
        raise PropellerError(
            f"{key} must be one of {', '.join(known)} or a list of these; it is"
            f" {reprlib.repr(values)}"
        )
    if len(values) != r.size:
        raise PropellerError(f"{key} has {len(values)} values for {r.size} stations of r_over_R")
    for i, word in enumerate(values):
        if word not in known:
            raise PropellerError(
                f"{key} must be one of {', '.join(known)}; station {i + 1} (r/R {r[i]:.10g}) has"
                f" {word!r}"
            )
    return tuple(values)


def stations(values: Any) -> FloatArray:
    """Return r/R of the stations: above 0, rising, the last at the tip.

    Parameters
    ----------
    values : array_like
        Stations as the user has them.

    Returns
    -------
    (n_stations,) array
        A read-only copy.

    Raises
    ------
    PropellerError
        If there are fewer than two stations, or they do not rise or do not end at 1. The diameter
        says where the tip is, so a blade that ends before it contradicts itself, and nothing is
        extrapolated.
    """
    r = distribution("r_over_R", values)
    if not 2 <= r.size <= MOST_STATIONS:
        raise PropellerError(
            f"r_over_R must hold 2 ... {MOST_STATIONS} stations; it holds {r.size}"
        )
    require_within("r_over_R", _RADIUS, r)
    require("r_over_R", "rise from station to station", np.append(True, np.diff(r) > 0.0), r)
    if r[-1] != 1.0:
        raise PropellerError(f"r_over_R must end at the tip, 1; the last station has {r[-1]:.10g}")
    return r


def airfoil_pairs(pairs: Iterable[Any]) -> tuple[tuple[float, str], ...]:
    """Return (r/R, airfoil) pairs, rising in r/R, each airfoil known.

    Parameters
    ----------
    pairs : iterable of (float, str)
        Pairs as the user has them.

    Returns
    -------
    tuple of (float, str)
        The pairs.

    Raises
    ------
    PropellerError
        If there are no pairs, an item is not such a pair, r/R does not rise within 0..1 or an
        airfoil cannot be found or read.
    """
    checked: list[tuple[float, str]] = []
    for pair in pairs:
        try:
            position, name = pair
        except (TypeError, ValueError):
            raise PropellerError(f"airfoils must be (r/R, airfoil) pairs; got {pair!r}") from None
        if not isinstance(name, str):
            raise PropellerError(f"an airfoil must be given by name or path; got {name!r}")
        position = number(f"r_over_R of airfoil '{name}'", position)
        if not 0.0 <= position <= 1.0:
            raise PropellerError(f"r_over_R of airfoil '{name}' must be in 0..1; it is {position}")
        if checked and position <= checked[-1][0]:
            raise PropellerError(
                f"airfoils must rise in r_over_R; '{name}' at {position} follows {checked[-1][0]}"
            )
        try:
            find_airfoil(name)
        except AirfoilError as error:
            raise PropellerError(str(error)) from error
        checked.append((position, name))
    if not checked:
        raise PropellerError("airfoils must name at least one airfoil")
    return tuple(checked)

"""Propellers measured in a wind tunnel, and how far an analysis is from the measurement."""

from __future__ import annotations

import dataclasses
import os
import tomllib
from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt
from scipy.optimize import root_scalar

from propmdao.analysis.sweeping.batches import analyze_each
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import read_text

FloatArray = npt.NDArray[np.float64]

_COLUMNS = ("rpm", "J", "CT", "CP")
_LOW_J = 0.5  # up to here a propeller climbs and cruises; beyond it the slow ones windmill
_TWIST_TOLERANCE = 1.0e-3  # deg
_J_TOLERANCE = 1.0e-4
# A run that ends short of zero thrust by less than this share of its largest CT is continued, on
# the line through so many of its last points.
_SHORT, _LAST = 0.02, 4


class MeasurementError(ValueError):
    """A file of measurements is wrong, or a propeller cannot be brought to agree with it."""


@dataclasses.dataclass(frozen=True)
class Points:
    """Coefficients at operating points.

    Attributes
    ----------
    rpm, J, CT, CP : (n,) arrays
        Rotation speed [rev/min], advance ratio V/(nD), thrust and power coefficients
        T/(rho n^2 D^4), P/(rho n^3 D^5).
    """

    rpm: FloatArray
    J: FloatArray
    CT: FloatArray
    CP: FloatArray

    @property
    def eta(self) -> FloatArray:
        """Efficiency J CT / CP."""
        return self.J * self.CT / self.CP

    def __getitem__(self, index: Any) -> Points:
        """Some of the points, by a slice or a mask."""
        return Points(self.rpm[index], self.J[index], self.CT[index], self.CP[index])


@dataclasses.dataclass(frozen=True)
class WindTunnel:
    """Measurements of one propeller.

    Attributes
    ----------
    source : str
        Origin of the measurements: who, where, which file.
    propellers : tuple of str
        Names in the catalogue of the descriptions that there are of the propeller, the one that is
        known best first.
    static, dynamic : Points
        Measured points without and with flight speed.
    """

    source: str
    propellers: tuple[str, ...]
    static: Points
    dynamic: Points


@dataclasses.dataclass(frozen=True)
class Errors:
    """Differences between computed and measured coefficients, as fractions.

    Errors of static points are relative to each point; with flight speed, where CT crosses zero,
    they are fractions of the mean static coefficient measured.

    Attributes
    ----------
    static_ct, static_cp : (n_static,) arrays
        Errors of CT and CP at the static points.
    low_ct, low_cp : arrays
        Errors at the points with flight speed up to J 0.5.
    high_ct, high_cp : arrays
        Errors at the points beyond J 0.5.
    trend : float
        Slope of static CT over rotation speed, computed over measured: the effect of the Reynolds
        number (straight lines of least squares).
    """

    static_ct: FloatArray
    static_cp: FloatArray
    low_ct: FloatArray
    low_cp: FloatArray
    high_ct: FloatArray
    high_cp: FloatArray
    trend: float


def read_wind_tunnel(path: str | os.PathLike[str]) -> WindTunnel:
    """Read a file of measurements.

    Parameters
    ----------
    path : path
        TOML file: ``source``, ``propellers``, a table ``static`` of arrays rpm, CT, CP and tables
        ``run`` of one rpm and arrays J, CT, CP.

    Returns
    -------
    WindTunnel
        The measurements, runs one after the other.

    Raises
    ------
    MeasurementError
        If the file cannot be read, or lacks something; the message begins with the file.
    """
    text = read_text(path, MeasurementError)
    try:
        data = tomllib.loads(text)
        static = _points({"J": np.zeros(len(data["static"]["rpm"])), **data["static"]})
        runs = [_points({**run, "rpm": [run["rpm"]] * len(run["J"])}) for run in data["run"]]
        dynamic = {name: np.concatenate([getattr(run, name) for run in runs]) for name in _COLUMNS}
        names = tuple(map(str, data["propellers"]))
        return WindTunnel(data["source"], names, static, Points(**dynamic))
    except KeyError as error:
        raise MeasurementError(f"{path}: {error} is missing") from error
    except (TypeError, ValueError) as error:
        raise MeasurementError(f"{path}: {error}") from error


def _points(table: dict[str, Any]) -> Points:
    """Read the arrays of a table, as many numbers in each."""
    arrays = {name: np.array(table[name], float) for name in _COLUMNS}
    sizes = {name: values.size for name, values in arrays.items()}
    if len(set(sizes.values())) > 1:
        raise ValueError(f"rpm, J, CT and CP must have equally many numbers; they have {sizes}")
    return Points(**arrays)


def computed(
    propeller: Propeller, points: Points, twist_offset_deg: float = 0.0, **settings: Any
) -> Points:
    """Analyse a propeller at measured rotation speeds and advance ratios.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    points : Points
        Points to analyse; only their rotation speeds and advance ratios count.
    twist_offset_deg : float
        Angle added to the blade angle all over the span [deg].
    **settings
        Further arguments of `propmdao.analyze`: density, viscous, stall_delay, polars, fidelity.

    Returns
    -------
    Points
        The same points with the computed coefficients, nan where the analysis has not converged.
    """
    polars = settings.pop("polars", None)
    same = {"twist_offset_deg": twist_offset_deg, **settings}
    asked: list[Any] = [
        {"rpm": rpm, "speed": j * rpm / 60.0 * propeller.diameter, **same}
        for rpm, j in zip(points.rpm, points.J, strict=True)
    ]
    coefficients = np.full((points.rpm.size, 2), np.nan)
    for row, outcome in zip(
        coefficients, analyze_each(propeller, asked, polars=polars), strict=True
    ):
        result = outcome.said()
        if result.loads.converged:
            row[:] = float(result.coefficients.CT), float(result.coefficients.CP)
    return Points(points.rpm, points.J, *coefficients.T)


def errors(tunnel: WindTunnel, static: Points, dynamic: Points) -> Errors:
    """Compare computed with measured coefficients.

    Parameters
    ----------
    tunnel : WindTunnel
        The measurements.
    static, dynamic : Points
        Computed coefficients at the same points, from `computed`.

    Returns
    -------
    Errors
        Errors, positive where more is computed than measured.
    """
    measured = tunnel.static
    low = tunnel.dynamic.J <= _LOW_J
    ct = (dynamic.CT - tunnel.dynamic.CT) / measured.CT.mean()
    cp = (dynamic.CP - tunnel.dynamic.CP) / measured.CP.mean()
    slope, measured_slope = (
        np.polyfit(measured.rpm, points.CT, 1)[0] for points in (static, measured)
    )
    return Errors(
        static_ct=static.CT / measured.CT - 1.0,
        static_cp=static.CP / measured.CP - 1.0,
        low_ct=ct[low],
        low_cp=cp[low],
        high_ct=ct[~low],
        high_cp=cp[~low],
        trend=float(slope / measured_slope),
    )


Evaluate = Callable[[Propeller, Points, float], Points]


def zero_thrust(points: Points) -> Points:
    """Find the advance ratios at which thrust goes through zero.

    A run that ends just short of it is continued on the straight line through its last points.

    Parameters
    ----------
    points : Points
        Measured points with flight speed.

    Returns
    -------
    Points
        A point of CT 0 for each rotation speed that has one, by linear interpolation over J.

    Raises
    ------
    MeasurementError
        If no rotation speed has one.
    """
    crossings = []
    for rpm in np.unique(points.rpm):
        run = points[points.rpm == rpm]
        run = run[np.argsort(run.J)]
        last = run[-_LAST:]
        brakes = np.flatnonzero(run.CT <= 0.0)
        if brakes.size and brakes[0] > 0:
            pair = run[brakes[0] - 1 : brakes[0] + 1]
            share = pair.CT[0] / (pair.CT[0] - pair.CT[1])
            crossings.append((rpm, *(v[0] + share * (v[1] - v[0]) for v in (pair.J, pair.CP))))
        elif not brakes.size and last.CT[-1] < _SHORT * run.CT.max() and last.CT.size == _LAST:
            slope, at_zero = np.polyfit(last.J, last.CT, 1)
            j = -at_zero / slope
            crossings.append((rpm, j, np.polyval(np.polyfit(last.J, last.CP, 1), j)))
    if not crossings:
        raise MeasurementError("no run goes through zero thrust")
    rpm, j, cp = np.array(crossings).T
    return Points(rpm, j, np.zeros_like(j), cp)


def zero_thrust_ratio(
    propeller: Propeller, measured: Points, evaluate: Evaluate = computed
) -> float:
    """Compare the advance ratio of zero thrust, computed over measured.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    measured : Points
        Measured points of zero thrust, from `zero_thrust`.
    evaluate : callable
        Function of propeller, points and twist offset, such as `computed`.

    Returns
    -------
    float
        Factor on the measured advance ratios with which the mean computed CT is zero.

    Raises
    ------
    MeasurementError
        If there is none.
    """

    def thrust(factor: float) -> float:
        points = dataclasses.replace(measured, J=factor * measured.J)
        return float(np.mean(evaluate(propeller, points, 0.0).CT))

    missing = "no advance ratio of '{}' gives zero thrust"
    return _root(thrust, (1.0, 0.95), _J_TOLERANCE, propeller, missing)


def zero_thrust_twist_deg(
    propeller: Propeller, measured: Points, evaluate: Evaluate = computed
) -> float:
    """Find the twist offset with which thrust is zero where it was measured to be.

    It is the incidence of the blade as it flew: where there is no lift, neither the wake nor the
    slope of the polars count, only where the blade's angle of zero lift is.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    measured : Points
        Measured points of zero thrust, from `zero_thrust`; their mean CT is brought to zero.
    evaluate : callable
        Function of propeller, points and twist offset, such as `computed`.

    Returns
    -------
    float
        Angle to add to the blade angle all over the span [deg].

    Raises
    ------
    MeasurementError
        If no offset is found.
    """

    def thrust(offset_deg: float) -> float:
        return float(np.mean(evaluate(propeller, measured, offset_deg).CT))

    missing = "no twist offset brings the thrust of '{}' to zero where it was measured"
    return _root(thrust, (0.0, 1.0), _TWIST_TOLERANCE, propeller, missing)


def calibrated_twist_deg(
    propeller: Propeller, static: Points, evaluate: Evaluate = computed
) -> float:
    """Find the twist offset that brings the mean relative error of CT to zero.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    static : Points
        Measured points, as a rule those without flight speed.
    evaluate : callable
        Function of propeller, points and twist offset, such as `computed`.

    Returns
    -------
    float
        Angle to add to the blade angle all over the span [deg].

    Raises
    ------
    MeasurementError
        If no offset is found.
    """

    def excess(offset_deg: float) -> float:
        return float(np.mean(evaluate(propeller, static, offset_deg).CT / static.CT - 1.0))

    missing = "no twist offset brings the mean CT of '{}' to the measured one"
    return _root(excess, (0.0, 1.0), _TWIST_TOLERANCE, propeller, missing)


def _root(
    function: Callable[[float], float],
    start: tuple[float, float],
    tolerance: float,
    propeller: Propeller,
    missing: str,
) -> float:
    """Root by the secant method, or a `MeasurementError`: `missing`, of the propeller by name."""
    solution = root_scalar(
        function, method="secant", x0=start[0], x1=start[1], xtol=tolerance, maxiter=12
    )
    if not (solution.converged and np.isfinite(solution.root)):
        raise MeasurementError(missing.format(propeller.name))
    return float(solution.root)

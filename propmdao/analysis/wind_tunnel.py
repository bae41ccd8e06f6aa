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

from propmdao.analysis.single_point import analyze
from propmdao.propeller.description import Propeller
from propmdao.runtime.input_files import read_text

FloatArray = npt.NDArray[np.float64]

_LOW_J = 0.5  # up to here a propeller climbs and cruises; beyond it the slow ones windmill
_TWIST_TOLERANCE = 1.0e-3  # deg


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

    def __getitem__(self, chosen: Any) -> Points:
        """Some of the points, by a slice or a mask."""
        return Points(self.rpm[chosen], self.J[chosen], self.CT[chosen], self.CP[chosen])


@dataclasses.dataclass(frozen=True)
class WindTunnel:
    """Measurements of one propeller.

    Attributes
    ----------
    source : str
        Who has measured.
    static, dynamic : Points
        Without and with flight speed.
    """

    source: str
    static: Points
    dynamic: Points


@dataclasses.dataclass(frozen=True)
class Errors:
    """Differences between computed and measured coefficients, as fractions.

    Those of static points are relative to each point; with flight speed, where CT crosses zero,
    they are fractions of the mean static coefficient measured.

    Attributes
    ----------
    static_ct, static_cp : (n_static,) arrays
        Of the static points.
    low_ct, low_cp : arrays
        Of the points with flight speed up to J 0.5.
    high_ct, high_cp : arrays
        Of those beyond.
    trend : float
        Slope of static CT over rotation speed, computed over measured: the Reynolds number's
        effect (straight lines of least squares).
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
        TOML: ``source``, a table ``static`` of arrays rpm, CT, CP and tables ``run`` of one rpm and
        arrays J, CT, CP.

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
        every = {
            name: np.concatenate([getattr(run, name) for run in runs])
            for name in ("rpm", "J", "CT", "CP")
        }
        return WindTunnel(data["source"], static, Points(**every))
    except KeyError as error:
        raise MeasurementError(f"{path}: {error} is missing") from error
    except (TypeError, ValueError) as error:
        raise MeasurementError(f"{path}: {error}") from error


def _points(table: dict[str, Any]) -> Points:
    arrays = {name: np.array(table[name], float) for name in ("rpm", "J", "CT", "CP")}
    sizes = {name: values.size for name, values in arrays.items()}
    if len(set(sizes.values())) > 1:
        raise ValueError(f"rpm, J, CT and CP must have equally many numbers; they have {sizes}")
    return Points(**arrays)


def computed(
    propeller: Propeller, at: Points, twist_offset_deg: float = 0.0, **settings: Any
) -> Points:
    """Analyse a propeller at measured rotation speeds and advance ratios.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    at : Points
        Where; their coefficients are not looked at.
    twist_offset_deg : float
        Added to the blade angle all over the span [deg].
    **settings
        Of `propmdao.analyze`: density, viscous, stall_delay, polars, fidelity.

    Returns
    -------
    Points
        With the computed coefficients, nan where the analysis has not converged.
    """
    found = np.full((at.rpm.size, 2), np.nan)
    for row, rpm, j in zip(found, at.rpm, at.J, strict=True):
        speed = j * rpm / 60.0 * propeller.diameter
        result = analyze(
            propeller, rpm=rpm, speed=speed, twist_offset_deg=twist_offset_deg, **settings
        )
        if result.steady.converged:
            row[:] = float(result.coefficients.CT), float(result.coefficients.CP)
    return Points(at.rpm, at.J, *found.T)


def errors(measured: WindTunnel, static: Points, dynamic: Points) -> Errors:
    """Compare computed with measured coefficients.

    Parameters
    ----------
    measured : WindTunnel
        The measurements.
    static, dynamic : Points
        Of `computed`, at the same points.

    Returns
    -------
    Errors
        Positive where more is computed than measured.
    """
    still = measured.static
    low = measured.dynamic.J <= _LOW_J
    ct = (dynamic.CT - measured.dynamic.CT) / still.CT.mean()
    cp = (dynamic.CP - measured.dynamic.CP) / still.CP.mean()
    slope, measured_slope = (np.polyfit(still.rpm, of.CT, 1)[0] for of in (static, still))
    return Errors(
        static_ct=static.CT / still.CT - 1.0,
        static_cp=static.CP / still.CP - 1.0,
        low_ct=ct[low],
        low_cp=cp[low],
        high_ct=ct[~low],
        high_cp=cp[~low],
        trend=float(slope / measured_slope),
    )


Evaluate = Callable[[Propeller, Points, float], Points]


def calibrated_twist_deg(
    propeller: Propeller, static: Points, evaluate: Evaluate = computed
) -> float:
    """Find the twist offset that brings the mean relative error of CT to zero.

    Parameters
    ----------
    propeller : Propeller
        The described blade.
    static : Points
        Measured without flight speed; others are taken as well.
    evaluate : callable
        Of propeller, points and twist offset, as `computed`.

    Returns
    -------
    float
        Offset to the blade angle all over the span [deg].

    Raises
    ------
    MeasurementError
        If no offset is found.
    """

    def missing(offset_deg: float) -> float:
        return float(np.mean(evaluate(propeller, static, offset_deg).CT / static.CT - 1.0))

    found = root_scalar(missing, method="secant", x0=0.0, x1=1.0, xtol=_TWIST_TOLERANCE, maxiter=12)
    if not found.converged or not np.isfinite(found.root):
        raise MeasurementError(
            f"no twist offset brings the mean CT of '{propeller.name}' to the measured one"
        )
    return float(found.root)

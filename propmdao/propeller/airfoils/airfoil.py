"""Airfoil sections: a camber line and a thickness distribution on one shared cosine grid.

The section is z = camber +- thickness / 2 at equal chord fraction x: thickness is laid off
perpendicular to the chord, not to the camber line. Coordinates are split that way and NACA
4-digit sections are built that way, so blending sections is plain array arithmetic and the
section area is chord^2 times the integral of the thickness, whatever the camber.
"""

from __future__ import annotations

import dataclasses
import re

import numpy as np
import numpy.typing as npt
from scipy.interpolate import CubicSpline

FloatArray = npt.NDArray[np.float64]

#: Angle of the shared grid, 0 at the leading edge, pi at the trailing edge.
CHORD_ANGLE: FloatArray = np.linspace(0.0, np.pi, 81)
#: Shared grid of chord fractions x/c.
CHORD_FRACTION: FloatArray = 0.5 * (1.0 - np.cos(CHORD_ANGLE))
for _grid in (CHORD_ANGLE, CHORD_FRACTION):
    _grid.setflags(write=False)


class AirfoilError(ValueError):
    """An airfoil cannot be found, read or built; the message is one line."""


def chord_interpolation(angle: npt.ArrayLike) -> FloatArray:
    """Build the operator from values on the shared grid to values at other chord angles.

    Parameters
    ----------
    angle : (n,) array
        Chord angles in 0..pi [rad], x/c = (1 - cos(angle)) / 2.

    Returns
    -------
    (n, 81) array
        Matrix of the cubic spline over chord angle; in that variable thickness has no root at the
        leading edge and is as smooth as camber.
    """
    operator: FloatArray = CubicSpline(CHORD_ANGLE, np.eye(CHORD_ANGLE.size))(np.asarray(angle))
    return operator


@dataclasses.dataclass(frozen=True, eq=False)
class Airfoil:
    """A section of unit chord.

    Attributes
    ----------
    name : str
        Name of the section.
    camber : (81,) array
        Camber line over chord at `CHORD_FRACTION`, 0 at the leading edge.
    thickness : (81,) array
        Full thickness over chord at `CHORD_FRACTION`, not negative.
    source : str
        Origin of the shape.
    """

    name: str
    camber: FloatArray
    thickness: FloatArray
    source: str = ""

    def __post_init__(self) -> None:
        for values in (self.camber, self.thickness):
            if values.shape != CHORD_FRACTION.shape:
                raise AirfoilError(
                    f"airfoil '{self.name}' needs {CHORD_FRACTION.size} values of camber and of "
                    f"thickness; got {values.shape}"
                )
            values.setflags(write=False)

    @property
    def max_camber(self) -> float:
        """Camber of largest magnitude over chord, with its sign."""
        return float(self.camber[np.argmax(np.abs(self.camber))])

    @property
    def max_thickness(self) -> float:
        """Largest thickness over chord."""
        return float(self.thickness.max())

    @property
    def zero_lift_angle(self) -> float:
        """Zero-lift angle of attack of thin-airfoil theory [rad]."""
        return float(self.camber @ ZERO_LIFT_WEIGHTS)


def _slope_integral_weights(antiderivative: FloatArray) -> FloatArray:
    """Weights w with camber @ w = integral of (dz/dx) g(angle), given the antiderivative of g.

    Exact for the polygon through the grid points, where dz/dx is constant in each interval; a
    spline instead would bring a false logarithmic term from its slope at the trailing edge.
    """
    per_interval = np.diff(antiderivative) / np.diff(CHORD_FRACTION)
    return -np.diff(per_interval, prepend=0.0, append=0.0)


#: camber @ this = pi A1 = 2 * integral of (dz/dx) cos(angle), lift at the ideal angle of attack.
DESIGN_LIFT_WEIGHTS = _slope_integral_weights(2.0 * np.sin(CHORD_ANGLE))
#: camber @ this = zero-lift angle = integral of (dz/dx) (1 - cos(angle)) / pi [rad].
ZERO_LIFT_WEIGHTS = _slope_integral_weights((CHORD_ANGLE - np.sin(CHORD_ANGLE)) / np.pi)


def naca4_camber_line(max_camber: float, position: float) -> FloatArray:
    """Mean line of the NACA 4-digit series: two parabolas that meet at the maximum.

    Parameters
    ----------
    max_camber : float
        Maximum camber over chord.
    position : float
        Chord fraction of the maximum, inside 0..1.

    Returns
    -------
    (81,) array
        Camber over chord at `CHORD_FRACTION`.

    Raises
    ------
    AirfoilError
        If `position` is not inside 0..1.

    Notes
    -----
    Jacobs, Ward, Pinkerton, NACA Report 460 (1933).
    """
    if not 0.0 < position < 1.0:
        raise AirfoilError(f"position of maximum camber must be inside 0..1; it is {position:g}")
    x, p = CHORD_FRACTION, position
    front = (2.0 * p * x - x**2) / p**2
    rear = (1.0 - 2.0 * p + 2.0 * p * x - x**2) / (1.0 - p) ** 2
    return max_camber * np.where(x < p, front, rear)


def naca4_thickness(max_thickness: float) -> FloatArray:
    """Full thickness of the NACA 4-digit series, with its blunt trailing edge.

    Parameters
    ----------
    max_thickness : float
        Maximum thickness over chord.

    Returns
    -------
    (81,) array
        Full thickness over chord at `CHORD_FRACTION`; 0.0105 of the maximum is left at the
        trailing edge.

    Notes
    -----
    Jacobs, Ward, Pinkerton, NACA Report 460 (1933).
    """
    x = CHORD_FRACTION
    polynomial = x * (-0.1260 + x * (-0.3516 + x * (0.2843 - 0.1015 * x)))
    return 10.0 * max_thickness * (0.2969 * np.sqrt(x) + polynomial)


def naca4(max_camber: float, position: float, max_thickness: float) -> Airfoil:
    """Build the section of the NACA 4-digit family with these parameters.

    Parameters
    ----------
    max_camber : float
        Maximum camber over chord, e.g. 0.04.
    position : float
        Chord fraction of maximum camber, e.g. 0.4.
    max_thickness : float
        Maximum thickness over chord, e.g. 0.12; positive.

    Returns
    -------
    Airfoil
        The section, thickness perpendicular to the chord.

    Raises
    ------
    AirfoilError
        If the thickness is not positive or the position not inside 0..1.
    """
    if not max_thickness > 0.0:
        raise AirfoilError(f"NACA 4-digit thickness must be positive; it is {max_thickness:g}")
    return Airfoil(
        name=f"naca4(camber {max_camber:g} at {position:g}, thickness {max_thickness:g})",
        camber=naca4_camber_line(max_camber, position),
        thickness=naca4_thickness(max_thickness),
        source="NACA Report 460 (1933)",
    )


def naca4_from_name(name: str) -> Airfoil:
    """Build a NACA 4-digit section from its name.

    Parameters
    ----------
    name : str
        "naca" and four digits, such as "naca4412".

    Returns
    -------
    Airfoil
        The section.

    Raises
    ------
    AirfoilError
        If the name is not that of a NACA 4-digit section, or names no thickness.
    """
    match = re.fullmatch(r"naca(\d)(\d)(\d\d)", name)
    if match is None:
        raise AirfoilError(f"'{name}' is no NACA 4-digit section; write it like 'naca4412'")
    camber, position, thickness = (int(digits) for digits in match.groups())
    if thickness == 0 or (camber > 0 and position == 0):
        raise AirfoilError(f"'{name}' names no thickness or no position of its camber")
    section = naca4(camber / 100.0, position / 10.0 if camber else 0.4, thickness / 100.0)
    return dataclasses.replace(section, name=name)


def max_camber_for_design_lift(design_lift: float, position: float = 0.4) -> float:
    """Maximum camber of the NACA 4-digit mean line with this design lift coefficient.

    Parameters
    ----------
    design_lift : float
        Lift coefficient at the ideal angle of attack, pi A1 of thin-airfoil theory.
    position : float
        Chord fraction of maximum camber.

    Returns
    -------
    float
        Maximum camber over chord; a design lift coefficient of 0.767 at 0.4 c gives 0.06.
    """
    return design_lift / float(naca4_camber_line(1.0, position) @ DESIGN_LIFT_WEIGHTS)

"""Sections of the catalogue, or NACA 4-digit ones in place of those that are in none."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.propeller.airfoils.airfoil import (
    DESIGN_LIFT_WEIGHTS,
    ZERO_LIFT_WEIGHTS,
    Airfoil,
    naca4_camber_line,
)
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.catalog import airfoil_names

FloatArray = npt.NDArray[np.float64]

#: Section that stands in; its camber is scaled, and its thickness where a file has one.
AIRFOIL = "naca4412"
#: Largest difference of a line, over its own largest value, from that of the same airfoil: tables
#: and splines round; Clark-Y and NACA 4412 are 0.05 apart.
_ALIKE = 0.02
#: Part of the radius that may lie beyond the last station of a file.
OPEN_TIP = 0.1
_ROUNDING = 1e-15  # of a station over the tip radius
_LINE = naca4_camber_line(1.0, 0.4)
_LINE = _LINE / _LINE.max()


def camber_of_zero_lift(angle: npt.ArrayLike) -> FloatArray:
    """Camber of the section that has no lift at an angle of attack, by thin-airfoil theory.

    Parameters
    ----------
    angle : (n,) array
        Zero-lift angles of attack [rad].

    Returns
    -------
    (n,) array
        Maximum camber over chord.
    """
    return np.asarray(angle, dtype=float) / float(_LINE @ ZERO_LIFT_WEIGHTS)


def camber_of_design_lift(lift: npt.ArrayLike) -> FloatArray:
    """Camber of the section with a lift coefficient at the ideal angle of attack.

    Parameters
    ----------
    lift : (n,) array
        Design lift coefficients, pi A1 of thin-airfoil theory.

    Returns
    -------
    (n,) array
        Maximum camber over chord.
    """
    return np.asarray(lift, dtype=float) / float(_LINE @ DESIGN_LIFT_WEIGHTS)


def blade_by_zero_lift(
    r_over_R: FloatArray,
    c_over_R: FloatArray,
    beta_deg: FloatArray,
    zero_lift: Callable[[FloatArray], FloatArray],
) -> tuple[dict[str, Any], str]:
    """Describe a blade of which a file has the zero-lift angles in place of the sections.

    Parameters
    ----------
    r_over_R, c_over_R, beta_deg : (n,) arrays
        Stations, chord and blade angle [deg]. Up to `OPEN_TIP` beyond the last station is closed
        with its chord and angle.
    zero_lift : callable
        Zero-lift angles of attack at r/R [rad].

    Returns
    -------
    described : dict
        Arguments of `Propeller`.
    assumed : str
        What is assumed by that.
    """
    assumed = "12 % thick NACA 4-digit sections of the file's zero-lift angle"
    if 1.0 - OPEN_TIP - _ROUNDING <= r_over_R[-1] < 1.0:
        assumed += f"; chord and angle of the last station, r/R {r_over_R[-1]:.4g}, on to the tip"
        r_over_R = np.append(r_over_R, 1.0)
        c_over_R, beta_deg = (np.append(x, x[-1]) for x in (c_over_R, beta_deg))
    described = {
        "r_over_R": r_over_R,
        "c_over_R": c_over_R,
        "beta_deg": beta_deg,
        "airfoils": [(1.0, AIRFOIL)],
        "camber_over_chord": camber_of_zero_lift(zero_lift(r_over_R)),
    }
    return described, assumed


def section_of_contour(contour: Airfoil) -> tuple[str, float]:
    """Find the section of the catalogue that a contour is, whatever its camber and thickness.

    Parameters
    ----------
    contour : Airfoil
        The section as it was read.

    Returns
    -------
    str
        Name in the catalogue, or `AIRFOIL` where no other section has these lines.
    float
        Maximum camber over chord: the contour's own, or that of the NACA 4-digit section with its
        zero-lift angle.
    """
    for name in airfoil_names():
        known = find_airfoil(name)
        if contour.max_camber and all(
            np.abs(line / np.abs(line).max() - of_known / np.abs(of_known).max()).max() < _ALIKE
            for line, of_known in (
                (contour.camber, known.camber),
                (contour.thickness, known.thickness),
            )
        ):
            return name, contour.max_camber
    return AIRFOIL, float(camber_of_zero_lift(contour.zero_lift_angle))

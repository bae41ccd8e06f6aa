"""NACA 4-digit sections in place of those that a file knows by their lift alone."""

from __future__ import annotations

import numpy as np
import numpy.typing as npt

from propmdao.propeller.airfoils.airfoil import (
    DESIGN_LIFT_WEIGHTS,
    ZERO_LIFT_WEIGHTS,
    naca4_camber_line,
)

FloatArray = npt.NDArray[np.float64]

#: Section that stands in; its camber is scaled, and its thickness where a file has one.
AIRFOIL = "naca4412"
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

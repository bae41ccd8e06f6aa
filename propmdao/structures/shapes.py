"""Polynomials over the span of a blade that is clamped at its root."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
import numpy.typing as npt
from numpy.polynomial import legendre

#: Polynomials per displacement.
N_SHAPES = 9
#: Radii at which energies are summed, by Gauss.
N_RADII = 40

FloatArray = npt.NDArray[np.float64]


class Shapes(NamedTuple):
    """Clamped polynomials at n fractions of the span.

    Attributes
    ----------
    value, slope : (n, N_SHAPES) arrays
        s P_k(2 s - 1), with Legendre's polynomials P_k, and its derivative in s.
    integral : (n, N_RADII) array
        Integral over s, from the root, of what is known at the radii of Gauss.
    """

    value: FloatArray
    slope: FloatArray
    integral: FloatArray


def gauss(n: int) -> tuple[FloatArray, FloatArray]:
    """Compute Gauss' rule on 0 ... 1.

    Parameters
    ----------
    n : int
        Number of nodes.

    Returns
    -------
    nodes, weights : (n,) arrays
        Nodes, rising, and weights, which add up to 1.
    """
    x, weight = legendre.leggauss(n)
    return 0.5 * (x + 1.0), 0.5 * weight


def shapes(s: npt.ArrayLike) -> Shapes:
    """Compute the clamped polynomials; call it outside ``jit``.

    Parameters
    ----------
    s : (n,) array
        Fractions of the span, 0 at the clamped root, 1 at the tip.

    Returns
    -------
    Shapes
        The polynomials, their derivatives, and integrals from the root.
    """
    s = np.asarray(s, dtype=float)
    x, unit, every = 2.0 * s - 1.0, np.eye(N_SHAPES), np.eye(N_RADII)
    p = legendre.legval(x, unit).T
    dp = 2.0 * legendre.legval(x, legendre.legder(unit, axis=0)).T
    # Legendre's series of the polynomial through values at the nodes, integrated term by term.
    nodes, weights = gauss(N_RADII)
    series = (2.0 * np.arange(N_RADII) + 1.0)[:, None] * weights
    series = series * legendre.legval(2.0 * nodes - 1.0, every)
    integrals = 0.5 * legendre.legval(x, legendre.legint(every, lbnd=-1.0, axis=0)).T
    return Shapes(s[:, None] * p, p + s[:, None] * dp, integrals @ series)

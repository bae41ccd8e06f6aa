"""Constraints over span: what splines do between their control points is held as well."""

from __future__ import annotations

from typing import Any

import numpy as np
import numpy.typing as npt
import openmdao.api as om

from propmdao.geometry.blade import span_interpolation

Floats = npt.NDArray[np.float64]

#: Radii between two stations at which the chord is looked at, and the stations themselves.
_PER_INTERVAL = 4


class LinearComp(om.ExplicitComponent):
    """Product of a constant matrix and a distribution.

    Inputs
    ------
    distribution : (n_stations,) array
        Distribution over span.

    Outputs
    -------
    values : (n,) array
        Product.

    Options
    -------
    matrix : (n, n_stations) array
        The matrix.
    """

    def initialize(self) -> None:
        self.options.declare("matrix", types=np.ndarray, desc="the constant matrix")

    def setup(self) -> None:
        matrix = self.options["matrix"]
        self.add_input("distribution", shape=matrix.shape[1])
        self.add_output("values", shape=matrix.shape[0])
        self.declare_partials("values", "distribution", val=matrix)

    def compute(self, inputs: Any, outputs: Any) -> None:
        outputs["values"] = self.options["matrix"] @ inputs["distribution"]


def chord_factors(stations: npt.ArrayLike, described: npt.ArrayLike) -> Floats:
    """Matrix from the chord at the stations to its factor on the described chord between them.

    A cubic spline goes through the chords of the stations, as in the blade, and may swing below
    zero between two that are positive.

    Parameters
    ----------
    stations, described : (n_stations,) array_like
        r/R of the stations and the described chord over tip radius there.

    Returns
    -------
    (n, n_stations) array
        Matrix.
    """
    r = np.asarray(stations, float)
    share = np.arange(_PER_INTERVAL) / _PER_INTERVAL
    between = (r[:-1, None] + share * np.diff(r)[:, None]).ravel()
    smooth = np.asarray(span_interpolation(r, np.append(between, r[-1])).smooth)
    return smooth / (smooth @ np.asarray(described, float))[:, None]

"""Observers on one circle about the shaft: of a rotor in steady axial flight they hear the same."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

Array = NDArray[np.float64]

_SAME = 12  # digits, of the largest distance, in which circles are one


class Rings(NamedTuple):
    """Circles about the rotor's axis that observers are on.

    Attributes
    ----------
    position : (n_rings, 3) array
        The first of the observers on each circle [m].
    ring : (n_observers,) array
        Number of the circle that each observer is on.
    azimuth : (n_observers,) array
        Azimuth of each observer from the first one on the circle [rad].
    """

    position: Array
    ring: NDArray[np.intp]
    azimuth: Array


def rings_of(positions: ArrayLike) -> Rings:
    """Sort observers by the circles about the axis +z that they are on.

    Parameters
    ----------
    positions : (n_observers, 3) array_like
        Positions from the rotor centre [m].

    Returns
    -------
    Rings
        The circles, and where on them the observers are.
    """
    x, y, z = np.asarray(positions, float).T
    places = np.stack([np.hypot(x, y), z], axis=-1)
    scale = np.abs(places).max(initial=0.0) or 1.0
    _, first, ring = np.unique(
        np.round(places / scale, _SAME), axis=0, return_index=True, return_inverse=True
    )
    ring, azimuth = ring.reshape(-1), np.arctan2(y, x)
    return Rings(np.stack([x, y, z], axis=-1)[first], ring, azimuth - azimuth[first][ring])

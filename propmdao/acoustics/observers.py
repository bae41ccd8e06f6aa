"""Where the microphones are: positions from the rotor centre, flying along with it."""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray


def arc(radius: ArrayLike, elevation_deg: ArrayLike) -> NDArray[np.float64]:
    """Place observers on a vertical arc around the rotor centre.

    Parameters
    ----------
    radius : float or (n_observers,)
        Distance from the rotor centre [m].
    elevation_deg : float or (n_observers,)
        Angle from the rotor plane [deg], from -90 (below, the wake side) to +90 (ahead).

    Returns
    -------
    (n_observers, 3) array
        ``radius (cos el, 0, sin el)`` [m].

    Raises
    ------
    ValueError
        If a radius is not positive or an elevation is outside -90 ... 90 deg.
    """
    r, elevation = np.broadcast_arrays(
        np.atleast_1d(np.asarray(radius, float)), np.asarray(elevation_deg, float)
    )
    for wrong in r[~((r > 0) & np.isfinite(r))]:
        raise ValueError(f"observer radius must be positive and finite [m]; got {wrong:g}")
    for wrong in elevation[~(np.abs(elevation) <= 90)]:
        raise ValueError(f"observer elevation must be within -90 ... 90 deg; got {wrong:g}")
    angle = np.radians(elevation)
    return np.stack([r * np.cos(angle), np.zeros_like(r), r * np.sin(angle)], axis=-1)

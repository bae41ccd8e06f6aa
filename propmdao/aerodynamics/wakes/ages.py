"""Ages of the wake: the azimuths behind the blade at which its nodes are."""

from __future__ import annotations

import numpy as np

from propmdao.records.wake_law import WakeGrid


def wake_azimuths(grid: WakeGrid) -> np.ndarray:
    """Azimuth behind the blade of the wake nodes, finely spaced near the blade.

    Parameters
    ----------
    grid : WakeGrid
        Length of the wake and its steps.

    Returns
    -------
    (n_nodes,) array
        Ages from 0 to 2 pi turns [rad].
    """
    step, last_step = np.radians(grid.first_step_deg), np.radians(grid.last_step_deg)
    length = 2.0 * np.pi * grid.turns
    ages = [0.0]
    while ages[-1] < length:
        ages.append(ages[-1] + step)
        step = min(step * grid.growth, last_step)
    return np.array(ages) * (length / ages[-1])

"""Ages of the wake: the azimuths behind the blade at which its nodes are."""

from __future__ import annotations

import numpy as np


def wake_azimuths(turns: float, first_step: float, growth: float, last_step: float) -> np.ndarray:
    """Azimuth behind the blade of the wake nodes, finely spaced near the blade.

    Parameters
    ----------
    turns : float
        Length of the wake in revolutions.
    first_step, last_step : float
        Smallest (at the blade) and largest azimuth step [rad].
    growth : float
        Ratio of one step to the one before.

    Returns
    -------
    (n_nodes,) array
        Ages from 0 to 2 pi turns [rad].
    """
    ages = [0.0]
    step = first_step
    while ages[-1] < 2.0 * np.pi * turns:
        ages.append(ages[-1] + step)
        step = min(step * growth, last_step)
    return np.array(ages) * (2.0 * np.pi * turns / ages[-1])

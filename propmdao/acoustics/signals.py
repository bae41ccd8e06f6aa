"""What is heard of rotors: tones by their amplitudes, records of pressure over time."""

from __future__ import annotations

import dataclasses
import functools
import operator

import numpy as np
from jax import Array
from numpy.typing import NDArray

from propmdao.records.pytrees import record


@record
class Tones:
    """Complex pressure amplitudes of the blade-passage harmonics m = 1 ... n_harmonics.

    The pressure at an observer is ``p(t) = 2 Re sum_m P_m exp(-2j pi f_m t)``, blade 1 being at
    azimuth 0 at t = 0. The mean pressure (m = 0) is no sound and is left out.

    Attributes
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies f_m = m B Omega / 2 pi [Hz].
    parts : dict of str to (n_observers, n_harmonics) complex array
        Amplitudes P_m of each noise source, "thickness" and "loading" [Pa].
    """

    frequency_hz: Array
    parts: dict[str, Array]

    @property
    def total(self) -> Array:
        """Amplitudes of the whole pressure [Pa]: pressures add, levels never do."""
        return functools.reduce(operator.add, self.parts.values())


@dataclasses.dataclass(frozen=True)
class PressureHistory:
    """Pressure at observers over time.

    Attributes
    ----------
    time : (n_times,) array
        Observer times [s].
    thickness, loading : (n_observers, n_times) arrays
        Pressure [Pa].
    """

    time: NDArray[np.float64]
    thickness: NDArray[np.float64]
    loading: NDArray[np.float64]

    @property
    def total(self) -> NDArray[np.float64]:
        """Of the whole noise [Pa]: pressures add, levels never do."""
        return self.thickness + self.loading

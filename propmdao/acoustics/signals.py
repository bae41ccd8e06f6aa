"""Sound of rotors at observers: tones by their amplitudes, records of pressure over time.

Both hold the sources of the sound apart, by name, in `parts`. Code that works on them works on
all parts, by `each` or by a loop, and names none.
"""

from __future__ import annotations

import dataclasses
import functools
import operator
from collections.abc import Callable

import jax
import numpy as np
from jax import Array
from numpy.typing import NDArray

from propmdao.records.pytrees import record

Floats = NDArray[np.float64]


@record
class Tones:
    """Complex pressure amplitudes of the blade-passage harmonics m = 1 ... n_harmonics.

    The pressure at an observer is ``p(t) = 2 Re sum_m P_m exp(-2j pi f_m t)``, blade 1 being at
    azimuth 0 at t = 0. The mean pressure (m = 0) is no sound and is left out.

    Attributes
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies f_m = m B Omega / 2 pi [Hz].
    parts : dict of (n_observers, n_harmonics) complex arrays
        Amplitudes P_m [Pa] by the name of their source: ``"thickness"``, ``"loading"``.
    """

    frequency_hz: Array
    parts: dict[str, Array]

    @property
    def total(self) -> Array:
        """Amplitudes of the whole pressure [Pa]: pressures add, levels never do."""
        return functools.reduce(operator.add, self.parts.values())

    def each(self, function: Callable[[Array], Array]) -> Tones:
        """Apply a function to the amplitudes of every source.

        Parameters
        ----------
        function : callable
            Function of an (n_observers, n_harmonics) array that returns such an array.

        Returns
        -------
        Tones
            Tones of the same frequencies.
        """
        return Tones(self.frequency_hz, {name: function(p) for name, p in self.parts.items()})

    def __add__(self, other: Tones) -> Tones:
        """Add the pressures of other tones of the same frequencies, source by source."""
        return Tones(self.frequency_hz, jax.tree.map(operator.add, self.parts, other.parts))


@dataclasses.dataclass(frozen=True)
class PressureHistory:
    """Pressure at observers over time.

    Attributes
    ----------
    time : (n_times,) array
        Observer times [s].
    parts : dict of (n_observers, n_times) arrays
        Pressure [Pa] by the name of its source: ``"thickness"``, ``"loading"``.
    """

    time: Floats
    parts: dict[str, Floats]

    @property
    def total(self) -> Floats:
        """Pressure of all sources together [Pa]: pressures add, levels never do."""
        return functools.reduce(operator.add, self.parts.values())

    def each(self, function: Callable[[Floats], Floats]) -> PressureHistory:
        """Apply a function to the pressure of every source.

        Parameters
        ----------
        function : callable
            Function of an (n_observers, n_times) array that keeps the times.

        Returns
        -------
        PressureHistory
            Pressures at the same times.
        """
        return PressureHistory(self.time, {name: function(p) for name, p in self.parts.items()})

    def __add__(self, other: PressureHistory) -> PressureHistory:
        """Add the pressures of another record of the same times, source by source."""
        return PressureHistory(self.time, jax.tree.map(operator.add, self.parts, other.parts))

"""Sound of rotors at observers: tones by their amplitudes, records of pressure over time.

Both hold the sources of the sound apart, by name, in `parts`. Code that works on them works on
all parts, by `each` or by a loop, and names none.
"""

from __future__ import annotations

import dataclasses
import functools
import operator
from collections.abc import Callable, Mapping

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array
from jax.typing import ArrayLike
from numpy.typing import NDArray

from propmdao.records.pytrees import record

Floats = NDArray[np.float64]
#: Frequencies and times that differ by less than this share of the largest are the same.
SAME = 1e-9


@record
class Tones:
    """Complex pressure amplitudes of the blade-passage harmonics m = 1 ... n_harmonics.

    The pressure at an observer is ``p(t) = 2 Re sum_m P_m exp(-2j pi f_m t)``, blade 1 being at
    azimuth 0 at t = 0. The mean pressure (m = 0) is no sound and is left out.

    Amplitudes of two rotors may be added where their frequencies are the same, sign included, and
    nowhere else; `propmdao.acoustics.sources.rotor_sums.sum_of_rotors` adds any.

    Attributes
    ----------
    frequency_hz : (n_harmonics,) array
        Frequencies ``f_m = m B |Omega| / 2 pi`` [Hz]; those of a sum of rotors are sorted, and are
        not multiples of the first.
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

    @property
    def of_positive_frequency(self) -> Tones:
        """The same pressure written with frequencies that are not negative.

        ``2 Re P exp(-2j pi f t)`` is ``2 Re conj(P) exp(2j pi f t)``.
        """
        negative = jnp.asarray(self.frequency_hz) < 0
        frequency_hz = jnp.where(negative, -self.frequency_hz, self.frequency_hz)
        parts = {name: jnp.where(negative, jnp.conj(p), p) for name, p in self.parts.items()}
        return Tones(frequency_hz, parts)

    def __add__(self, other: Tones) -> Tones:
        """Add the pressures of other tones of the same frequencies, source by source.

        Parameters
        ----------
        other : Tones
            Tones of the same frequencies, sources and observers.

        Returns
        -------
        Tones
            Sum of the pressures.

        Raises
        ------
        ValueError
            If frequencies, where they are known numbers, or the names of the sources differ.
        """
        require_same(self.frequency_hz, other.frequency_hz, "frequencies of tones", "Hz")
        require_same_sources(self.parts, other.parts)
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
        """Add the pressures of another record of the same times, source by source.

        Parameters
        ----------
        other : PressureHistory
            Record of the same times, sources and observers.

        Returns
        -------
        PressureHistory
            Sum of the pressures.

        Raises
        ------
        ValueError
            If times or names of the sources differ.
        """
        require_same(self.time, other.time, "times of records", "s")
        require_same_sources(self.parts, other.parts)
        return PressureHistory(self.time, jax.tree.map(operator.add, self.parts, other.parts))


def require_same(ours: ArrayLike, theirs: ArrayLike, name: str, unit: str) -> None:
    """Refuse values that differ, where they are known numbers: of a traced one nothing is known.

    Parameters
    ----------
    ours, theirs : (n,) array
        Values to compare.
    name, unit : str
        Name and unit of the values in the message.

    Raises
    ------
    ValueError
        If the values differ; the message has the first that does.
    """
    if isinstance(ours, jax.core.Tracer) or isinstance(theirs, jax.core.Tracer):
        return
    a, b = np.asarray(ours, float), np.asarray(theirs, float)
    if a.shape != b.shape:
        raise ValueError(f"{name} must be the same to be added; there are {a.size} and {b.size}")
    wrong = np.flatnonzero(~(np.abs(a - b) <= SAME * np.abs(a).max(initial=0.0)))
    if wrong.size:
        k = wrong[0]
        raise ValueError(
            f"{name} must be the same to be added; number {k + 1} is {a[k]:.10g} and {b[k]:.10g}"
            f" {unit}"
        )


def require_same_sources(ours: Mapping[str, ArrayLike], theirs: Mapping[str, ArrayLike]) -> None:
    """Refuse parts of other sources or of another number of observers.

    Parameters
    ----------
    ours, theirs : mapping of str to (n_observers, n) array
        Parts by the name of their source.

    Raises
    ------
    ValueError
        If the names or the numbers of observers differ.
    """
    if ours.keys() != theirs.keys():
        raise ValueError(
            "sources must be the same to be added; they are"
            f" {', '.join(sorted(ours))} and {', '.join(sorted(theirs))}"
        )
    for name in ours:
        n, m = (np.shape(parts[name])[0] for parts in (ours, theirs))
        if n != m:
            raise ValueError(f"observers must be the same to be added; there are {n} and {m}")

"""Sound of several rotors together: what is in phase adds as pressure, the rest as mean squares."""

from __future__ import annotations

from collections.abc import Sequence

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.levels.decibels import mean_square
from propmdao.acoustics.signals import SAME, Tones, require_same_sources
from propmdao.records.pytrees import record


@record
class RotorSound:
    """Sound of one rotor, or of several together, at observers.

    Attributes
    ----------
    tones : Tones
        Amplitudes at the observers; of all rotors from the same zero of time.
    broadband : SelfNoise or None
        Mean squares (n_observers, n_bands) [Pa^2], of all rotors in the same bands; None where the
        sound has none.
    """

    tones: Tones
    broadband: SelfNoise | None = None

    @property
    def mean_square(self) -> Array:
        """Mean-square pressure of tones and broadband noise at each observer, (n_observers,)."""
        power = jnp.sum(mean_square(self.tones.total), axis=-1)
        return power if self.broadband is None else power + jnp.sum(self.broadband.total, axis=-1)


def sum_of_rotors(sounds: Sequence[RotorSound]) -> RotorSound:
    """Sound of several rotors at the same observers.

    Tones of the same frequency are in phase with each other for good: their pressures add. Tones
    of different frequencies drift past each other, so that over time their mean squares add: they
    stay apart, in one list of frequencies. Broadband noise of rotors is not correlated.

    Parameters
    ----------
    sounds : sequence of RotorSound
        Sound of each rotor, at the same observers, of the same sources, counted from the same
        time; frequencies of either sign.

    Returns
    -------
    RotorSound
        Tones at all frequencies of the rotors, rising and positive, and the mean squares of the
        broadband noise. Levels of it (`oaspl_db`, `spl_db`, `oaspl_dba`) are those of the whole.

    Raises
    ------
    ValueError
        If there are no rotors, some have broadband noise and others do not, observers, sources or
        bands differ, or frequencies are not finite.
    TypeError
        If the frequencies are traced by JAX: which of them are the same has to be known.

    Notes
    -----
    Frequencies that differ by less than 1e-9 are the same: they beat once in weeks.
    """
    if not sounds:
        raise ValueError("a sum of rotors needs at least one")
    first = sounds[0]
    for sound in sounds[1:]:
        require_same_sources(first.tones.parts, sound.tones.parts)
        if (sound.broadband is None) != (first.broadband is None):
            raise ValueError("rotors must all have broadband noise to be added, or none of them")
    noises = [sound.broadband for sound in sounds if sound.broadband is not None]
    return RotorSound(_tones([sound.tones for sound in sounds]), _noise(noises))


def _tones(every: Sequence[Tones]) -> Tones:
    """Tones on the merged list of frequencies."""
    if any(isinstance(tones.frequency_hz, jax.core.Tracer) for tones in every):
        raise TypeError(
            "frequencies of rotors must be known numbers to be added: trace the amplitudes only"
        )
    positive = [tones.of_positive_frequency for tones in every]
    sizes = [np.size(tones.frequency_hz) for tones in positive]
    together = np.concatenate([np.asarray(tones.frequency_hz, float) for tones in positive])
    order = np.argsort(together)
    rising = together[order]
    if not np.isfinite(rising).all():
        raise ValueError(f"frequencies of tones must be finite; got {rising[-1]:g} Hz")
    new = np.diff(rising, prepend=-np.inf) > SAME * rising[-1]
    merged, number = rising[new], np.empty(rising.size, int)
    number[order] = np.cumsum(new) - 1
    parts = {name: jnp.zeros((), complex) for name in positive[0].parts}
    for tones, numbers in zip(positive, np.split(number, np.cumsum(sizes)[:-1]), strict=True):
        # Ones where a frequency of the rotor goes to one of the list.
        onto = jnp.asarray(numbers[:, None] == np.arange(merged.size), float)
        parts = {name: sofar + tones.parts[name] @ onto for name, sofar in parts.items()}
    return Tones(jnp.asarray(merged), parts)


def _noise(noises: Sequence[SelfNoise]) -> SelfNoise | None:
    """Mean squares of all rotors together."""
    if not noises:
        return None
    shapes = [jnp.shape(noise.total) for noise in noises]
    for shape in shapes[1:]:
        if shape != shapes[0]:
            raise ValueError(
                "broadband noise must be at the same observers in the same bands to be added; it "
                f"is {shapes[0]} and {shape}"
            )
    return jax.tree.map(lambda *powers: sum(powers), *noises)

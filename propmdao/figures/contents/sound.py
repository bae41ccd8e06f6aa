"""Sound that figures show: tones and maybe broadband noise at observers, and its levels."""

from __future__ import annotations

from typing import NamedTuple

import numpy as np
from jax import Array

from propmdao.acoustics.levels.bands import HALF_BAND, tones_in_bands
from propmdao.acoustics.levels.decibels import level_db, mean_square
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.acoustics.signals import Tones
from propmdao.analysis.results import MECHANISMS, Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.palette import SOURCE_COLORS, Floats


class Sound(NamedTuple):
    """Tones and broadband noise at the same observers.

    Attributes
    ----------
    tones : Tones
        Amplitudes.
    bands_hz : (n_bands,) array
        Mid-band frequencies of neighbouring third octaves [Hz]; there are none without broadband
        noise.
    broadband : (n_observers, n_bands) array
        Mean squares of the broadband noise in the bands [Pa^2].
    """

    tones: Tones
    bands_hz: Floats
    broadband: Floats

    @classmethod
    def of_tones(cls, tones: Tones) -> Sound:
        """Sound without broadband noise.

        Parameters
        ----------
        tones : Tones
            Amplitudes.

        Returns
        -------
        Sound
            The tones, with no bands.
        """
        return cls(tones, np.zeros(0), np.zeros((len(tones.total), 0)))

    @property
    def has_broadband(self) -> bool:
        """Whether there is broadband noise beside the tones."""
        return self.bands_hz.size > 0


def amplitudes(tones: Tones) -> dict[str, Array]:
    """Amplitudes of each source of the tones and of the total, in the order of drawing.

    Parameters
    ----------
    tones : Tones
        Amplitudes.

    Returns
    -------
    dict of str to (n_observers, n_harmonics) complex array
        Amplitudes [Pa] by source, those with a colour of their own first; "total" is the last.
    """
    # A mapping that has passed through JAX is sorted by name.
    known = [source for source in SOURCE_COLORS if source in tones.parts]
    others = [source for source in tones.parts if source not in SOURCE_COLORS]
    parts = {source: tones.parts[source] for source in (*known, *others)}
    return parts | {"total": tones.total}


def source_levels(sound: Sound, a_weighted: bool = False) -> dict[str, Floats]:
    """Overall level of each noise source and of all together.

    Parameters
    ----------
    sound : Sound
        Tones and maybe broadband noise.
    a_weighted : bool
        Whether the levels are A-weighted.

    Returns
    -------
    dict of str to (n_observers,) array
        OASPL [dB or dBA] of each source of the tones, of "broadband" where there is such noise, and
        of the "total".
    """
    weight, band_weight = (
        np.asarray(a_weighting(frequency)) ** 2 if a_weighted else np.ones(np.size(frequency))
        for frequency in (sound.tones.frequency_hz, sound.bands_hz)
    )
    energy = {
        source: np.asarray(mean_square(pressure)) @ weight
        for source, pressure in amplitudes(sound.tones).items()
    }
    total = energy.pop("total")
    if sound.has_broadband:
        energy["broadband"] = sound.broadband @ band_weight
        total = total + energy["broadband"]
    energy["total"] = total
    return {source: np.asarray(level_db(power)) for source, power in energy.items()}


def band_levels(sound: Sound, observer: int = 0) -> Floats:
    """Third octaves of tones and broadband noise together.

    Parameters
    ----------
    sound : Sound
        Tones and broadband noise.
    observer : int
        Index of the observer.

    Returns
    -------
    (n_bands,) array
        Levels in the bands of the broadband noise [dB].
    """
    tones = mean_square(sound.tones.total[observer])
    in_bands = tones_in_bands(sound.tones.frequency_hz, tones, sound.bands_hz)
    return np.asarray(level_db(np.asarray(in_bands) + sound.broadband[observer]))


def band_edges(bands_hz: Floats) -> Floats:
    """Frequencies between neighbouring third octaves, and at the ends of them all.

    Parameters
    ----------
    bands_hz : (n_bands,) array
        Mid-band frequencies [Hz].

    Returns
    -------
    (n_bands + 1,) array
        Edges [Hz].
    """
    return np.append(bands_hz / HALF_BAND, bands_hz[-1] * HALF_BAND)


def analysis_sound(analysis: Analysis) -> Sound:
    """Sound of an analysis at all of its observers.

    Parameters
    ----------
    analysis : Analysis
        Analysis with or without broadband noise.

    Returns
    -------
    Sound
        Tones, and broadband noise where there is any.
    """
    if analysis.broadband is None:
        return Sound.of_tones(analysis.tones)
    return Sound(analysis.tones, BANDS_HZ, np.asarray(analysis.broadband.total))


def mechanism_levels(analysis: Analysis, observer: int = 0) -> dict[str, Floats]:
    """Third octaves of an analysis by mechanism of the broadband noise.

    Parameters
    ----------
    analysis : Analysis
        Analysis with broadband noise.
    observer : int
        Index of the observer.

    Returns
    -------
    dict of str to (n_bands,) array
        Levels in the bands `propmdao.analysis.self_noise.BANDS_HZ` [dB]: "total", with the tones,
        "broadband", and each mechanism by its name.
    """
    noise = analysis.broadband
    assert noise is not None
    sound = analysis_sound(analysis)
    powers = {"broadband": sound.broadband[observer]}
    powers |= {name.replace("_", " "): getattr(noise, name)[observer] for name in MECHANISMS}
    levels = {name: np.asarray(level_db(power)) for name, power in powers.items()}
    return {"total": band_levels(sound, observer)} | levels

"""Levels that observers of a PSU-WOPWOP case hear: spectra and third octaves of each segment."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from propmdao.acoustics.levels.bands import middle_hz, third_octaves_of_spectrum
from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.epnl import EffectivePerceivedNoise, effective_perceived_noise_level
from propmdao.acoustics.levels.perceived_noise import PERCEIVED_BANDS_HZ
from propmdao.acoustics.levels.spectrum import narrowband
from propmdao.acoustics.levels.time_levels import sound_exposure_level_db
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.acoustics.propagation.absorption import absorb
from propmdao.analysis.wopwop.broadband_sources import BANDS_HZ
from propmdao.analysis.wopwop.foreign_case import CaseResult
from propmdao.formats.wopwop.binary import WopwopFileError

Array = NDArray[np.float64]

#: Parts of the tones in `CaseLevels`.
TONES = ("thickness", "loading", "total")
#: Sums in third octaves: of the broadband noise, and of tones and broadband noise.
BROADBAND, ALL = "broadband", "all"


@dataclass(frozen=True)
class CaseLevels:
    """Mean squares at a group of observers, after absorption where a case asks for it.

    Attributes
    ----------
    time : (n_segments,) array
        Middle of each segment [s].
    step : float
        Time that a segment stands for [s].
    frequency_hz : (n_bins,) array
        Frequencies of the narrowband spectra [Hz].
    narrowband : dict of (n_observers, n_segments, n_bins) arrays
        Mean squares of `TONES` [Pa^2].
    center_hz : (n_bands,) array
        Exact mid-band frequencies of the third octaves [Hz].
    bands : dict of (n_observers, n_segments, n_bands) arrays
        Mean squares of `TONES`, of each part of the broadband noise, `BROADBAND` and `ALL` [Pa^2].
    """

    time: Array
    step: float
    frequency_hz: Array
    narrowband: dict[str, Array]
    center_hz: Array
    bands: dict[str, Array]

    def overall(self, part: str) -> Array:
        """Mean square of a part in all, (n_observers, n_segments) [Pa^2]."""
        if part in self.narrowband:
            return np.asarray(self.narrowband[part].sum(axis=-1))
        tones = self.narrowband["total"].sum(axis=-1) if part == ALL else 0.0
        return np.asarray(self.bands[BROADBAND if part == ALL else part].sum(axis=-1) + tones)

    def overall_dba(self, part: str) -> Array:
        """A-weighted level of a part, (n_observers, n_segments) [dBA]."""
        if part in self.narrowband:
            return np.asarray(level_dba(self.frequency_hz, self.narrowband[part]))
        if part != ALL:
            return np.asarray(level_dba(self.center_hz, self.bands[part]))
        levels = (self.overall_dba(name) for name in ("total", BROADBAND))
        return np.asarray(10.0 * np.log10(sum(10.0 ** (0.1 * level) for level in levels)))

    def exposure_db(self) -> Array:
        """A-weighted sound exposure level of the whole record, SEL, (n_observers,) [dBA]."""
        return sound_exposure_level_db(self.overall_dba(ALL), self.step)

    def perceived(self, observer: int) -> EffectivePerceivedNoise:
        """Effective perceived noise at an observer, whose record has to begin and end quietly."""
        band = np.round(10.0 * np.log10(PERCEIVED_BANDS_HZ / 1000.0))
        number = np.round(10.0 * np.log10(self.center_hz / 1000.0))
        mean_square = self.bands[ALL][observer]
        wanted = np.zeros((len(mean_square), band.size))
        in_both = np.isin(band, number)
        wanted[:, in_both] = mean_square[:, np.isin(number, band)]
        return effective_perceived_noise_level(np.asarray(level_db(wanted)), self.step)


def case_levels(result: CaseResult) -> CaseLevels:
    """Work out the spectra of a group of observers, segment by segment.

    Parameters
    ----------
    result : CaseResult
        Pressure and broadband noise of a case.

    Returns
    -------
    CaseLevels
        Mean squares of the segments.

    Raises
    ------
    WopwopFileError
        If a segment has fewer than two samples.

    Notes
    -----
    The air absorbs on the way from the middle of the sources; the record of the pressure has no
    absorption. A window is made up for, so that bins hold the mean square of the record.
    """
    grid, pressure = result.listening, result.pressure
    n_times = grid.times.size
    rate = (n_times - 1) / float(grid.times[-1] - grid.times[0])
    whole = grid.segment_starts.size == 1
    n = n_times if whole and grid.segment * rate > n_times - 1.5 else round(grid.segment * rate)
    if n < 2:
        raise WopwopFileError(
            f"{result.case}: segmentSize must be two samples of {1 / rate:g} s or more; it is"
            f" {grid.segment:g} s"
        )
    first = np.round((grid.segment_starts - grid.times[0]) * rate).astype(int)
    first = np.minimum(first, n_times - n)
    samples = first[:, None] + np.arange(n)
    spectra: dict[str, Array] = {}
    for part in TONES:
        record = np.asarray(getattr(pressure, part))[:, samples]
        frequency_hz, spectra[part] = narrowband(record, rate, rate / n, grid.window)

    def arriving(mean_square: Array, frequencies: Array) -> Array:
        if not grid.absorption:
            return mean_square
        return np.asarray(absorb(mean_square, frequencies, result.distance, result.air))

    spectra = {part: arriving(spectrum, frequency_hz) for part, spectrum in spectra.items()}
    tonal_hz, _ = third_octaves_of_spectrum(frequency_hz, spectra["total"])
    band = np.round(10.0 * np.log10(np.concatenate([tonal_hz, BANDS_HZ]) / 1000.0))
    numbers = np.arange(band.min(), band.max() + 1)
    shape = (*result.distance.shape, numbers.size)

    def placed(mean_square: Array, center_hz: Array) -> Array:
        bands = np.zeros(shape)
        start = int(np.round(10.0 * np.log10(center_hz[0] / 1000.0)) - numbers[0])
        bands[..., start : start + center_hz.size] = mean_square
        return bands

    bands = {
        part: placed(third_octaves_of_spectrum(frequency_hz, spectrum)[1], tonal_hz)
        for part, spectrum in spectra.items()
    }
    noise = {
        part: placed(arriving(spectrum, BANDS_HZ), BANDS_HZ)
        for part, spectrum in result.broadband.items()
    }
    together = sum(noise.values(), np.zeros(shape))
    bands |= noise | {BROADBAND: together, ALL: bands["total"] + together}
    return CaseLevels(
        grid.segment_starts + 0.5 * grid.segment,
        grid.segment if whole else grid.step,
        frequency_hz,
        spectra,
        middle_hz(numbers),
        bands,
    )

"""Effective perceived noise level of a flyover, EPNL.

References
----------
ICAO Annex 16 Volume I, Appendix 2, section 4; 14 CFR Part 36, Appendix A, section A36.4.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.levels.perceived_noise import perceived_noise_level, tone_correction

Floats = NDArray[np.float64]

_REFERENCE_DURATION = 10.0  # s


@dataclass(frozen=True)
class EffectivePerceivedNoise:
    """Effective perceived noise level of a flyover, with the histories behind it.

    Attributes
    ----------
    epnl : float
        Effective perceived noise level [EPNdB].
    pnltm : float
        Maximum of PNLT, band-sharing adjustment included [PNdB].
    pnl, tone_correction, pnlt : (n_times,) arrays
        Perceived noise level [PNdB], its correction for tones [dB] and their sum.
    first, last : int
        Numbers of the times, both included, between which PNLT counts: 10 dB below the maximum.
    """

    epnl: float
    pnltm: float
    pnl: Floats
    tone_correction: Floats
    pnlt: Floats
    first: int
    last: int


def slow_response(level_db: ArrayLike) -> Floats:
    """Band levels as an analyser with SLOW response gives them, from half-second averages.

    Parameters
    ----------
    level_db : (n_times, ...) array_like
        Levels of half seconds one after the other [dB].

    Returns
    -------
    (n_times, ...) array
        Levels [dB]; they belong to the time 0.75 s before the end of the half second, and hold
        from the sixth on.

    References
    ----------
    14 CFR Part 36, A36.3.7.5 and A36.3.7.6.
    """
    from scipy.signal import lfilter  # here: loading it takes as long as all the rest

    energy = 10 ** (0.1 * np.asarray(level_db, float))
    return np.asarray(10 * np.log10(lfilter([0.39347], [1, -0.60653], energy, axis=0)))


def effective_perceived_noise_level(
    level_db: ArrayLike, step: float = 0.5
) -> EffectivePerceivedNoise:
    """Effective perceived noise level of a flyover, EPNL.

    Parameters
    ----------
    level_db : (n_times, 24) array_like
        Band levels [dB re 20 uPa] at equal steps of time.
    step : float
        Step between the spectra [s]: 0.5 in certification.

    Returns
    -------
    EffectivePerceivedNoise
        The level and the histories behind it.

    Raises
    ------
    ValueError
        If the flyover is not heard, or does not begin and end 10 dB below its maximum.

    References
    ----------
    ICAO Annex 16 Volume I, Appendix 2, 4.3 to 4.6, the band-sharing adjustment (4.4.2) included.
    """
    pnl, correction = perceived_noise_level(level_db), tone_correction(level_db)
    pnlt = pnl + correction
    peak = int(np.argmax(pnlt))
    if not pnl[peak] > 0:
        raise ValueError("nothing of the flyover is heard: all bands are below 0.1 noys")
    around = round(1 / step)
    shared = correction[max(peak - around, 0) : peak + around + 1].mean() - correction[peak]
    adjustment = max(float(shared), 0.0)
    level, first, last = integrated_level(pnlt, step, pnlt[peak] + adjustment)
    return EffectivePerceivedNoise(
        level + adjustment,
        float(pnlt[peak]) + adjustment,
        pnl,
        correction,
        pnlt,
        first,
        last,
    )


def integrated_level(
    pnlt: ArrayLike, duration: ArrayLike, maximum: float
) -> tuple[float, int, int]:
    """PNLT over the time in which it is within 10 dB of its maximum, referred to 10 s.

    Parameters
    ----------
    pnlt : (n_times,) array_like
        Tone-corrected perceived noise level [PNdB].
    duration : float or (n_times,) array_like
        Time that each of the values stands for [s].
    maximum : float
        Maximum of PNLT, band-sharing adjustment included, PNLTM [PNdB].

    Returns
    -------
    level : float
        Effective perceived noise level [EPNdB].
    first, last : int
        Numbers of the first and the last value nearest to 10 dB below the maximum; both and all
        between them count.

    Raises
    ------
    ValueError
        If the record does not begin and end 10 dB below the maximum.

    References
    ----------
    14 CFR Part 36, A36.4.5, with 10 log10(10 s) where it rounds to 13 for half seconds.
    """
    history = np.asarray(pnlt, float)
    limit = maximum - 10
    loud = np.flatnonzero(history >= limit)
    first, last = int(loud[0]), int(loud[-1])
    if first == 0 or last == history.size - 1:
        raise ValueError(
            f"a flyover must begin and end 10 dB below its maximum of {maximum:.1f} PNdB; "
            f"it begins at {history[0]:.1f} and ends at {history[-1]:.1f}"
        )
    first -= int(limit - history[first - 1] < history[first] - limit)
    last += int(limit - history[last + 1] < history[last] - limit)
    energy = 10 ** (0.1 * history) * np.asarray(duration, float) / _REFERENCE_DURATION
    return float(10 * np.log10(energy[first : last + 1].sum())), first, last

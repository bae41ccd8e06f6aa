"""Perceived noise of aircraft at an instant: noys, PNL and the correction for tones.

Levels are third octaves in the 24 bands from 50 Hz to 10 kHz, `PERCEIVED_BANDS_HZ`, along the last
axis. No maintained library of this runs on all of the Pythons of this package.

References
----------
ICAO Annex 16 Volume I, Appendix 2, section 4; 14 CFR Part 36, Appendix A, section A36.4.
"""

from __future__ import annotations

import numpy as np
from numpy.typing import ArrayLike, NDArray

from propmdao.acoustics.levels.bands import middle_hz

Floats = NDArray[np.float64]

#: Exact mid-band frequencies [Hz].
PERCEIVED_BANDS_HZ: Floats = middle_hz(np.arange(-13, 11))

# Table A36-3 (Annex 16: A2-3): SPL(a), SPL(b), SPL(c), SPL(d), SPL(e) [dB]
_CORNERS = """
91.0 64 52 49 55, 85.9 60 51 44 51, 87.3 56 49 39 46, 79.9 53 47 34 42, 79.8 51 46 30 39,
76.0 48 45 27 36, 74.0 46 43 24 33, 74.9 44 42 21 30, 94.6 42 41 18 27, inf 40 40 16 25,
inf 40 40 16 25, inf 40 40 16 25, inf 40 40 16 25, inf 40 40 16 25, inf 38 38 15 23,
inf 34 34 12 21, inf 32 32 9 18, inf 30 30 5 15, inf 29 29 4 14, inf 29 29 5 14, inf 30 30 6 15,
inf 31 31 10 17, 44.3 37 34 17 23, 50.7 41 37 21 29
"""
# and M(b), M(c), M(d), M(e) [1/dB]; M(c) counts above SPL(a) only
_SLOPES = """
.043478 .030103 .079520 .058098, .040570 .030103 .068160 .058098, .036831 .030103 .068160 .052288,
.036831 .030103 .059640 .047534, .035336 .030103 .053013 .043573, .033333 .030103 .053013 .043573,
.033333 .030103 .053013 .040221, .032051 .030103 .053013 .037349, .030675 .030103 .053013 .034859,
.030103 0 .053013 .034859, .030103 0 .053013 .034859, .030103 0 .053013 .034859,
.030103 0 .053013 .034859, .030103 0 .053013 .034859, .030103 0 .059640 .034859,
.029960 0 .053013 .040221, .029960 0 .053013 .037349, .029960 0 .047712 .034859,
.029960 0 .047712 .034859, .029960 0 .053013 .034859, .029960 0 .053013 .034859,
.029960 0 .068160 .037349, .042285 .029960 .079520 .037349, .042285 .029960 .059640 .043573
"""


def _columns(table: str) -> Floats:
    return np.array([row.split() for row in table.split(",")], float).T


_A, _B, _C, _D, _E = _columns(_CORNERS)
_MB, _MC, _MD, _ME = _columns(_SLOPES)

_FIRST_TONE_BAND = 2  # 80 Hz


def perceived_noisiness(level_db: ArrayLike) -> Floats:
    """Perceived noisiness of each band.

    Parameters
    ----------
    level_db : (..., 24) array_like
        Band levels [dB re 20 uPa].

    Returns
    -------
    (..., 24) array
        Noisiness in noys; 0 for bands that are not heard.

    References
    ----------
    14 CFR Part 36, A36.4.7.3 and table A36-3.
    """
    level = _bands(level_db)
    return np.select(
        [level >= _A, level >= _B, level >= _E, level >= _D],
        [
            10 ** (_MC * (level - _C)),
            10 ** (_MB * (level - _B)),
            0.3 * 10 ** (_ME * (level - _E)),
            0.1 * 10 ** (_MD * (level - _D)),
        ],
        0.0,
    )


def perceived_noise_level(level_db: ArrayLike) -> Floats:
    """Perceived noise level, PNL.

    Parameters
    ----------
    level_db : (..., 24) array_like
        Band levels [dB re 20 uPa].

    Returns
    -------
    (...,) array
        Perceived noise level [PNdB]; 0 where nothing is heard.

    References
    ----------
    14 CFR Part 36, A36.4.2.1.
    """
    noys = perceived_noisiness(level_db)
    total = 0.85 * noys.max(axis=-1) + 0.15 * noys.sum(axis=-1)
    return np.where(total > 0, 40 + 10 / np.log10(2) * np.log10(np.maximum(total, 1e-9)), 0.0)


def tone_correction(level_db: ArrayLike) -> Floats:
    """Correction for tones that stick out of the spectrum, as for aeroplanes (from 80 Hz).

    Parameters
    ----------
    level_db : (..., 24) array_like
        Band levels [dB re 20 uPa].

    Returns
    -------
    (...,) array
        Correction, the largest of the bands' factors C, 0 to 6 2/3 dB. Bands that are not heard
        have none.

    Notes
    -----
    The procedure takes the edge of a spectrum that stops short of 10 kHz for a tone. Predictions
    without broadband noise are corrected as their tones deserve; broadband noise that is cut off
    below 10 kHz is not.

    References
    ----------
    14 CFR Part 36, A36.4.3.1, steps 1 to 10, and table A36-2.
    """
    level = _bands(level_db)
    excess = level[..., _FIRST_TONE_BAND:] - tone_background(level)
    frequency = PERCEIVED_BANDS_HZ[_FIRST_TONE_BAND:]
    # Table A36-2: from 500 to 5000 Hz tones count twice
    weight = np.where((frequency > 499) & (frequency < 5100), 1.0, 0.5)
    factor = weight * np.select(
        [excess < 1.5, excess < 3, excess < 20], [0.0, 2 * excess / 3 - 1, excess / 3], 20 / 3
    )
    audible = perceived_noisiness(level)[..., _FIRST_TONE_BAND:] > 0
    return np.where(audible, factor, 0.0).max(axis=-1)


def tone_background(level_db: ArrayLike) -> Floats:
    """Spectrum smoothed of its tones, SPL'' of the tone correction.

    Parameters
    ----------
    level_db : (..., 24) array_like
        Band levels [dB re 20 uPa].

    Returns
    -------
    (..., 22) array
        Band levels from 80 Hz on [dB re 20 uPa].

    References
    ----------
    14 CFR Part 36, A36.4.3.1, steps 1 to 7.
    """
    level = _bands(level_db)[..., _FIRST_TONE_BAND:]
    slope = np.diff(level)  # step 1
    before, after = slope[..., :-1], slope[..., 1:]
    irregular = np.abs(after - before) > 5  # step 2
    # Step 3: the band that sticks out is where the slope rises, or the one before it falls.
    tone = np.zeros(level.shape, bool)
    tone[..., 2:] |= irregular & (after > 0) & (after > before)
    tone[..., 1:-1] |= irregular & (after <= 0) & (before > 0)
    # Step 4: it becomes the mean of its neighbours, the last band an extrapolation.
    instead = level.copy()
    instead[..., 1:-1] = 0.5 * (level[..., :-2] + level[..., 2:])
    instead[..., -1] = level[..., -2] + slope[..., -2]
    slope = np.diff(np.where(tone, instead, level))  # step 5
    slope = np.concatenate([slope[..., :1], slope, slope[..., -1:]], axis=-1)
    mean = (slope[..., :-2] + slope[..., 1:-1] + slope[..., 2:]) / 3  # step 6
    first = level[..., :1]
    return np.concatenate([first, first + np.cumsum(mean, axis=-1)], axis=-1)  # step 7


def _bands(level_db: ArrayLike) -> Floats:
    level = np.asarray(level_db, float)
    if level.shape[-1:] != (24,):
        raise ValueError(
            f"perceived noise needs the 24 third octaves from 50 Hz to 10 kHz; got {level.shape}"
        )
    return level

"""Perceived noise against the regulations' worked examples."""

import numpy as np
import pytest

from propmdao.acoustics.levels import perceived_noise
from propmdao.acoustics.levels.epnl import (
    effective_perceived_noise_level,
    integrated_level,
    slow_response,
)
from propmdao.acoustics.levels.perceived_noise import (
    PERCEIVED_BANDS_HZ,
    perceived_noise_level,
    perceived_noisiness,
    tone_background,
    tone_correction,
)

AT_1_KHZ = int(np.argmin(np.abs(PERCEIVED_BANDS_HZ - 1000)))
SILENCE = np.full(24, -200.0)

# ICAO Doc 9501, Environmental Technical Manual I, table 3-7, and ISO 3891:1978, annex C: tone
# correction of a turbofan engine from 80 Hz on; levels, background and excess [thirds of a dB].
TURBOFAN_DB = np.array(
    [0, 0, 70, 62, 70, 80, 82, 83, 76, 80, 80, 79, 78, 80, 78, 76, 79, 85, 79, 78, 71, 60, 54, 45],
    float,
)
BACKGROUND_THIRDS = [
    *(210, 203, 213, 233, 241, 237, 233, 234, 237, 237, 237),
    *(236, 234, 233, 234, 237, 236, 228, 209, 185, 159, 135),
]

# ICAO Doc 9501, Environmental Technical Manual I, table 4-4: PNLT [PNdB] and its duration [s]
PNLT = [
    *(84.62, 85.84, 85.37, 88.57, 88.82, 88.03, 88.76, 87.06, 86.92, 90.39, 89.89, 91.00, 90.08),
    *(89.71, 89.61, 90.21, 91.14, 92.10, 93.68, 94.89, 95.87, 97.06, 97.40, 96.23, 94.73, 92.30),
    *(88.75, 86.96, 85.41, 83.88, 83.01),
]
DURATION = [
    *(0.3950, 0.3950, 0.3951, 0.3951, 0.3952, 0.3953, 0.3954, 0.3956, 0.3957, 0.3960, 0.3963),
    *(0.3967, 0.3973, 0.3981, 0.3992, 0.4009, 0.4033, 0.4066, 0.4108, 0.4153, 0.4196, 0.4231),
    *(0.4256, 0.4273, 0.4285, 0.4294, 0.4299, 0.4304, 0.4307, 0.4309, 0.4311),
]


def only(band, level):
    spectrum = SILENCE.copy()
    spectrum[band] = level
    return spectrum


def test_bands_are_from_50_hz_to_10_khz():
    np.testing.assert_allclose(
        PERCEIVED_BANDS_HZ[[0, AT_1_KHZ, 23]], [10**1.7, 1000.0, 10000.0], rtol=1e-12
    )


@pytest.mark.parametrize(("level", "noys"), [(16, 0.1), (25, 0.3), (40, 1.0), (50, 2.0), (90, 32)])
def test_noys_at_1_khz(level, noys):
    """The definition: 1 noy at 40 dB, twice as many for every 10 dB more; 0.3 and 0.1 below."""
    n = perceived_noisiness(only(AT_1_KHZ, level))
    assert n[AT_1_KHZ] == pytest.approx(noys, rel=1e-5)
    assert n.sum() == n[AT_1_KHZ]


def test_nothing_is_heard_below_a_tenth_of_a_noy():
    assert perceived_noisiness(only(AT_1_KHZ, 15.9)).sum() == 0
    assert perceived_noise_level(SILENCE) == 0


def test_the_lines_of_the_noy_table_meet_at_its_corners():
    """A slip in any constant of table A36-3 would open a step; the table has 0.1 dB, 5 digits."""
    for corner in (perceived_noise._A, perceived_noise._B, perceived_noise._E):
        bands = np.flatnonzero(np.isfinite(corner))
        for band in bands:
            low, high = (
                perceived_noisiness(only(band, corner[band] + e))[band] for e in (-1e-9, 0)
            )
            # SPL(a) is rounded to 0.1 dB where slopes differ by up to 0.0135 per dB
            assert np.log10(high / low) == pytest.approx(0.0, abs=0.05 * 0.0135 + 1e-4)
    for band, corner in enumerate(perceived_noise._D):
        assert perceived_noisiness(only(band, corner))[band] == pytest.approx(0.1, rel=1e-12)


def test_perceived_noise_level_of_equal_bands():
    """N = 0.85 n_max + 0.15 sum n: one noy is 40 PNdB, two bands of one noy are 1.15 noys."""
    assert perceived_noise_level(only(AT_1_KHZ, 40.0)) == pytest.approx(40.0)
    two = only([AT_1_KHZ, AT_1_KHZ - 3], 40.0)
    assert perceived_noise_level(two) == pytest.approx(40 + 10 * np.log2(1.15))
    many = np.array([two, only(AT_1_KHZ, 50.0)])
    np.testing.assert_allclose(
        perceived_noise_level(many), [40 + 10 * np.log2(1.15), 50.0], rtol=1e-6
    )


def test_background_of_the_worked_example():
    np.testing.assert_allclose(3 * tone_background(TURBOFAN_DB), BACKGROUND_THIRDS, atol=1e-9)


def test_tone_correction_of_the_worked_example():
    """6 dB above the background at 2500 Hz: C = 6 / 3, the largest of all bands."""
    assert tone_correction(TURBOFAN_DB) == pytest.approx(2.0, abs=1e-12)


@pytest.mark.parametrize(
    ("band", "step", "factor"), [(AT_1_KHZ, 30.0, 20 / 3), (AT_1_KHZ, 6.0, 2.0), (3, 30.0, 10 / 3)]
)
def test_a_tone_on_a_flat_spectrum(band, step, factor):
    spectrum = np.full(24, 60.0)
    assert tone_correction(spectrum) == 0
    spectrum[band] += step
    assert tone_correction(spectrum) == pytest.approx(factor)


def test_bands_that_are_not_heard_have_no_tones():
    spectrum = np.linspace(70, -45, 24)
    spectrum[20] += 12.0
    assert np.any(spectrum[2:] - tone_background(spectrum) > 3)
    assert tone_correction(spectrum) == 0


def test_epnl_of_the_worked_example():
    """Integrated method: 92.61892 EPNdB over the records 4 to 28."""
    level, first, last = integrated_level(PNLT, DURATION, max(PNLT))
    assert level == pytest.approx(92.61892, abs=1e-5)
    assert (first, last) == (3, 27)


def flyover(n=60, tone=0.0):
    """A bell of a flat spectrum, heard every half second, with a tone at 1 kHz."""
    level = np.tile(100 - 0.05 * (np.arange(n) - 30.0) ** 2, (24, 1)).T
    level[:, AT_1_KHZ] += tone
    return level


def test_epnl_of_a_flat_spectrum_is_the_integral_of_its_pnl():
    heard = effective_perceived_noise_level(flyover())
    assert not np.any(heard.tone_correction)
    np.testing.assert_allclose(heard.pnlt, perceived_noise_level(flyover()))
    assert heard.pnltm == heard.pnl.max()
    within = slice(heard.first, heard.last + 1)
    total = np.sum(10 ** (0.1 * heard.pnl[within])) / 20
    assert heard.epnl == pytest.approx(10 * np.log10(total))
    assert abs(heard.pnl[heard.first] - (heard.pnltm - 10)) < 0.5


def test_epnl_of_a_tone_is_higher_by_its_correction():
    plain, tonal = flyover(), flyover(tone=9.0)
    tonal[:, AT_1_KHZ] = plain[:, AT_1_KHZ] + 9.0
    heard = effective_perceived_noise_level(tonal)
    np.testing.assert_allclose(heard.tone_correction, 3.0)
    assert heard.epnl == pytest.approx(integrated_level(heard.pnl, 0.5, heard.pnl.max())[0] + 3.0)


def test_a_tone_that_hides_at_the_maximum_is_counted():
    """Band sharing: the mean correction of the two seconds around, where that is more."""
    level = flyover(tone=9.0)
    level[30] = flyover()[30] + 4.0
    heard = effective_perceived_noise_level(level)
    assert np.argmax(heard.pnlt) == 30
    assert heard.tone_correction[30] == 0
    assert heard.pnltm - heard.pnlt[30] == pytest.approx(4 * 3.0 / 5)


def test_slow_response_keeps_a_steady_level_and_averages_over_a_second():
    steady = slow_response(np.full((12, 24), 60.0))
    np.testing.assert_allclose(steady[5:], 60.0, atol=0.25)  # from the sixth on
    click = slow_response([[60.0]] + [[-200.0]] * 3)[:, 0]
    assert click[0] == pytest.approx(60 + 10 * np.log10(0.39347))
    np.testing.assert_allclose(np.diff(click), 10 * np.log10(np.exp(-0.5)), atol=1e-4)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: perceived_noise_level(np.zeros(10)), r"24 third octaves .* got \(10,\)"),
        (
            lambda: effective_perceived_noise_level(flyover()[25:]),
            "a flyover must begin and end 10 dB below its maximum of 1.*; it begins at",
        ),
        (
            lambda: effective_perceived_noise_level(np.full((9, 24), -50.0)),
            "nothing of the flyover is heard",
        ),
    ],
)
def test_what_cannot_be_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()

"""Levels over time as a class 1 sound level meter shows them."""

import numpy as np
import pytest

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.time_levels import (
    FAST,
    SLOW,
    a_weighted,
    short_time_level_db,
    sound_exposure_level_db,
    third_octave_history,
    time_weighted_level_db,
)

RATE = 48000.0

# IEC 61672-1:2013, table 3: nominal frequency, A-weighting, class 1 limits above and below [dB]
CLASS_1 = """
10 -70.4 3.0 inf, 12.5 -63.4 2.5 inf, 16 -56.7 2.0 4.0, 20 -50.5 2.0 2.0, 25 -44.7 2.0 1.5,
31.5 -39.4 1.5 1.5, 40 -34.6 1.0 1.0, 50 -30.2 1.0 1.0, 63 -26.2 1.0 1.0, 80 -22.5 1.0 1.0,
100 -19.1 1.0 1.0, 125 -16.1 1.0 1.0, 160 -13.4 1.0 1.0, 200 -10.9 1.0 1.0, 250 -8.6 1.0 1.0,
315 -6.6 1.0 1.0, 400 -4.8 1.0 1.0, 500 -3.2 1.0 1.0, 630 -1.9 1.0 1.0, 800 -0.8 1.0 1.0,
1000 0.0 0.7 0.7, 1250 0.6 1.0 1.0, 1600 1.0 1.0 1.0, 2000 1.2 1.0 1.0, 2500 1.3 1.0 1.0,
3150 1.2 1.0 1.0, 4000 1.0 1.0 1.0, 5000 0.5 1.5 1.5, 6300 -0.1 1.5 2.0, 8000 -1.1 1.5 2.5,
10000 -2.5 2.0 3.0, 12500 -4.3 2.0 5.0, 16000 -6.6 2.5 16.0, 20000 -9.3 3.0 inf
"""

# IEC 61672-1:2013, table 4: duration of a 4 kHz burst [s], LAFmax - LA, LASmax - LA, LAE - LA
BURSTS = [
    (1.0, 0.0, -2.0, 0.0),
    (0.5, -0.1, -4.1, -3.0),
    (0.2, -1.0, -7.4, -7.0),
    (0.1, -2.6, -10.2, -10.0),
    (0.05, -4.8, -13.1, -13.0),
    (0.02, -8.3, -17.0, -17.0),
    (0.01, -11.1, -20.0, -20.0),
    (0.005, -14.1, -23.0, -23.0),
]


def test_a_weighting_of_records_is_within_class_1():
    t = np.arange(int(RATE)) / RATE
    for nominal, goal, above, below in np.array([r.split() for r in CLASS_1.split(",")], float):
        exact = 1000 * 10 ** (np.round(10 * np.log10(nominal / 1000)) / 10)
        # whole periods, for the record is taken to repeat; within 0.5 Hz or 5 % of the lowest
        tone = np.sqrt(2) * np.sin(2 * np.pi * max(round(exact), 10) * t)
        shown = 10 * np.log10(np.mean(a_weighted(tone, RATE) ** 2))
        assert -below <= shown - goal <= above
        if nominal >= 100:
            assert shown == pytest.approx(goal, abs=0.09)  # rounding of the table and of the tone


def test_a_weighting_keeps_the_phase():
    t = np.arange(4800) / RATE
    tone = np.cos(2 * np.pi * 1000 * t)
    np.testing.assert_allclose(a_weighted([tone, 2 * tone], RATE), [tone, 2 * tone], atol=1e-12)


@pytest.mark.parametrize(("duration", "fast", "slow", "exposure"), BURSTS)
def test_bursts(duration, fast, slow, exposure):
    """Far inside the class 1 limits of 0.5 dB and more: within the table's last digit."""
    t = np.arange(int(2.5 * RATE)) / RATE
    burst = np.where((t >= 0.1) & (t < 0.1 + duration), np.sin(2 * np.pi * 4000 * t), 0.0)
    steady = float(level_db(0.5))
    assert time_weighted_level_db(burst, RATE, FAST).max() - steady == pytest.approx(fast, abs=0.06)
    assert time_weighted_level_db(burst, RATE, SLOW).max() - steady == pytest.approx(slow, abs=0.06)
    _, level = short_time_level_db(burst, RATE, 0.05)
    assert sound_exposure_level_db(level, 0.05) - steady == pytest.approx(exposure, abs=0.06)


def test_short_time_levels_of_a_step():
    record = np.r_[np.full(4800, 0.1), np.full(4800, 1.0), np.full(100, 9.0)]
    time, level = short_time_level_db([record, 2 * record], RATE, 0.1)
    np.testing.assert_allclose(time, [0.05, 0.15])
    np.testing.assert_allclose(level[0], level_db(np.array([0.01, 1.0])))
    np.testing.assert_allclose(level[1] - level[0], 20 * np.log10(2))


def test_exposure_of_a_flyover_is_that_of_its_mean_square():
    """A rotor in level flight at height h: the integral of 1/r^2 over time is pi / (h V)."""
    height, speed = 50.0, 60.0
    t = np.arange(-100.0, 100.0, 0.1)
    level = level_db(1 / (height**2 + (speed * t) ** 2))
    expected = 10 * np.log10(np.pi / (height * speed) / 4e-10)
    # what is heard before and after 100 s: 2 / (V^2 100 s), 0.5 % of it
    assert sound_exposure_level_db(level, 0.1) == pytest.approx(expected, abs=0.03)


def test_band_history_holds_the_energy_of_the_record():
    rng = np.random.default_rng(5)
    spectrum = np.fft.rfft(rng.normal(size=96000))
    f = np.fft.rfftfreq(96000, 1 / RATE)
    record = np.fft.irfft(np.where((f > 25) & (f < 17000), spectrum, 0))
    centers = third_octave_centers(25.0, 16000.0)
    time, bands = third_octave_history(record, RATE, centers, 0.5)
    np.testing.assert_allclose(time, [0.25, 0.75, 1.25, 1.75])
    total = bands.mean(axis=0).sum()
    assert 10 * np.log10(total / np.mean(record**2)) == pytest.approx(0.0, abs=1e-9)


def test_band_history_of_a_tone_is_in_its_band():
    t = np.arange(96000) / RATE
    _, bands = third_octave_history(np.cos(2 * np.pi * 1000 * t), RATE, [800, 1000, 1250], 0.5)
    np.testing.assert_allclose(bands, [[0.0, 0.5, 0.0]] * 4, atol=1e-12)
    at_the_edge = 1000 * 10**0.05
    record = np.cos(2 * np.pi * round(at_the_edge) * t)
    _, bands = third_octave_history(record, RATE, [1000.0, 1000 * 10**0.1], 0.5)
    np.testing.assert_allclose(bands, 0.25, atol=0.002)


def test_band_history_follows_a_sound_that_comes_and_goes():
    t = np.arange(int(6 * RATE)) / RATE
    swell = np.exp(-(((t - 3) / 1.0) ** 2))
    tones = 0.3 * np.cos(2 * np.pi * 100 * t) + 0.1 * np.cos(2 * np.pi * 1000 * t)
    time, bands = third_octave_history(swell * tones, RATE, [100.0, 1000.0, 10000.0], 0.5)
    fine = np.linspace(-0.25, 0.25, 101)
    expected = np.mean(np.exp(-2 * (time[:, None] + fine - 3) ** 2), axis=1)
    loud = expected > 1e-3
    np.testing.assert_allclose(bands[loud, 0], 0.045 * expected[loud], rtol=0.01)
    np.testing.assert_allclose(bands[loud, 1], 0.005 * expected[loud], rtol=0.01)
    assert bands[:, 2].max() < 1e-9


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: short_time_level_db(np.zeros(480), RATE, 0.5),
            r"slices must be between 2.08e-05 s \(a sample\) and 0.01 s \(the record\); got 0.5",
        ),
        (
            lambda: third_octave_history(np.zeros(9600), 16000.0, [10000.0], 0.5),
            "sample rate of 16000 Hz is too low for the band around 1e\\+04 Hz",
        ),
    ],
)
def test_what_cannot_be_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()

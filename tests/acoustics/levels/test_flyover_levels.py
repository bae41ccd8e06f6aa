"""From a rotor that flies over to what is heard of it: a source of tones with all of the chain.

The source is a point that radiates equally in all directions; its record at the ground has a closed
form by the emission time, so every level along the chain is known.
"""

import numpy as np
import pytest

from propmdao.acoustics.kinematics.tracks import fixed_observers, flyover_track, line_of_sight
from propmdao.acoustics.levels.bands import band_number
from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.epnl import effective_perceived_noise_level
from propmdao.acoustics.levels.perceived_noise import PERCEIVED_BANDS_HZ
from propmdao.acoustics.levels.time_levels import (
    a_weighted,
    short_time_level_db,
    sound_exposure_level_db,
    third_octave_history,
)
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.acoustics.propagation.absorption import absorb, absorption_db_per_m
from propmdao.records.air import Air

C, HEIGHT, SPEED, RATE = 340.0, 100.0, 60.0, 6000.0
TONES_HZ = np.array([200.0, 1000.0])
AT_1_M = np.array([4.0, 1.0])  # Pa, amplitudes
TIMES = np.arange(-12.0, 12.0, 1 / RATE)
BANDS_HZ = PERCEIVED_BANDS_HZ[:18]  # up to 2.5 kHz
TRACK = flyover_track(HEIGHT, SPEED)
BELOW = fixed_observers([[0.0, 0.0, 0.0]])


def seen(times):
    sight = line_of_sight(TRACK, BELOW, times, C)
    return [np.asarray(q)[0] for q in (sight.emission_time, sight.distance, sight.doppler)]


@pytest.fixture(scope="module")
def flight():
    return seen(TIMES)


@pytest.fixture(scope="module")
def record(flight):
    tau, distance, _ = flight
    phase = 2 * np.pi * np.outer(TONES_HZ, tau)
    return AT_1_M @ np.cos(phase) / distance


def test_bands_follow_the_doppler_shift(flight, record):
    time, bands = third_octave_history(record, RATE, BANDS_HZ, 0.5)
    _, _, doppler = seen(TIMES[0] + time)
    _, distance, _ = flight
    each = len(TIMES) // len(time)
    for tone, amplitude in zip(TONES_HZ, AT_1_M, strict=True):
        expected = np.mean((amplitude**2 / 2 / distance**2).reshape(-1, each), axis=1)
        number = np.asarray(band_number(tone * doppler)).astype(int) + 13
        # between the bands while the tone crosses an edge: both of them hold it
        held = sum(
            np.take_along_axis(bands, np.clip(number + k, 0, 17)[:, None], 1)[:, 0]
            for k in (-1, 0, 1)
        )
        np.testing.assert_allclose(10 * np.log10(held / expected), 0.0, atol=0.15)


def test_sound_exposure_is_the_integral_over_the_flight(flight, record):
    _, level = short_time_level_db(a_weighted(record, RATE), RATE, 0.125)
    _, distance, doppler = flight
    weight = np.asarray(a_weighting(np.outer(TONES_HZ, doppler)))
    heard = np.sum((AT_1_M[:, None] * weight) ** 2, axis=0) / 2 / distance**2
    expected = 10 * np.log10(heard.sum() / RATE / 4e-10)
    assert sound_exposure_level_db(level, 0.125) == pytest.approx(expected, abs=0.01)


def test_air_takes_its_share_on_the_way_of_the_sound(record):
    """The tones are heard between 160 and 250 and between 800 and 1250 Hz."""
    time, bands = third_octave_history(record, RATE, BANDS_HZ, 0.5)
    _, distance, _ = seen(TIMES[0] + time)
    air = Air(temperature=298.15, relative_humidity=0.7)
    absorbed = absorb(bands, BANDS_HZ, distance, air)
    lost = level_db(bands.sum(axis=1)) - level_db(absorbed.sum(axis=1))
    least, most = (float(absorption_db_per_m(f, air)) for f in (160.0, 1250.0))
    assert np.all((least * distance < lost) & (lost < most * distance))


def test_effective_perceived_noise_of_the_flyover(record):
    """Loudest after the sound's way from overhead; lasting for some heights over the speed."""
    _, bands = third_octave_history(record, RATE, BANDS_HZ, 0.5)
    level = np.pad(np.asarray(level_db(bands)), ((0, 0), (0, 6)), constant_values=-200.0)
    heard = effective_perceived_noise_level(level)
    assert 0 < heard.first < heard.last < len(level) - 1
    loudest = int(np.argmax(heard.pnlt))
    assert TIMES[0] + 0.25 + 0.5 * loudest == pytest.approx(HEIGHT / C, abs=1.0)
    duration = 0.5 * (heard.last - heard.first)
    # PNLT falls by 10 dB with some 8 dB of level: at 2.5 times the height
    assert duration == pytest.approx(2 * np.sqrt(2.5**2 - 1) * HEIGHT / SPEED, rel=0.25)
    assert heard.epnl - heard.pnltm == pytest.approx(10 * np.log10(duration / 2 / 10), abs=1.0)

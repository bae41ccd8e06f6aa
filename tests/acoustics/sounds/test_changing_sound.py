"""Sound that changes from step to step keeps its energies."""

import numpy as np
import pytest

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.propagation.absorption import absorption_db_per_m
from propmdao.acoustics.sounds.changing_sound import absorbed_record, changing_noise
from propmdao.records.air import Air

RATE, EACH = 8000, 4000
BANDS = third_octave_centers(100.0, 2000.0)


@pytest.mark.parametrize("n_steps", [1, 2, 9])
def test_steady_noise_has_its_mean_square(n_steps):
    record = changing_noise(BANDS, np.ones((n_steps, BANDS.size)), EACH, RATE)
    assert record.size == n_steps * EACH
    # 14 bands of 2200 Hz together, over half a second each: 2 % of scatter, three times that
    assert np.mean(record**2) == pytest.approx(BANDS.size, rel=0.06)


def test_noise_follows_its_bands():
    power = np.outer(10.0 ** np.arange(4), np.ones(BANDS.size))
    record = changing_noise(BANDS, power, EACH, RATE).reshape(4, EACH)
    heard = np.mean(record**2, axis=1) / power.sum(axis=1)
    # A quarter of the way to a neighbour ten times as loud its noise is already a seventh of all.
    middle = np.mean(record[:, 1900:2100] ** 2, axis=1) / power.sum(axis=1)
    np.testing.assert_allclose(middle, 1.0, rtol=0.5)
    assert np.all(heard[:-1] > 1.0) and heard[-1] < 1.0


@pytest.mark.parametrize("n_steps", [1, 2, 5])
def test_no_way_leaves_a_record_as_it_is(n_steps):
    record = np.random.default_rng(0).normal(size=n_steps * EACH)
    same = absorbed_record(record, np.zeros(n_steps), Air(), EACH, RATE)
    np.testing.assert_allclose(same, record, atol=1e-12)


def test_a_tone_loses_what_the_air_takes():
    f, ways = 2000.0, np.array([100.0, 200.0, 300.0, 400.0, 500.0])
    tone = np.cos(2 * np.pi * f * np.arange(5 * EACH) / RATE)
    heard = absorbed_record(tone, ways, Air(), EACH, RATE).reshape(5, EACH)
    middle = np.sqrt(2 * np.mean(heard[:, 1900:2100] ** 2, axis=1))
    lost = -20 * np.log10(middle[1:-1])
    np.testing.assert_allclose(lost, ways[1:-1] * float(absorption_db_per_m(f, Air())), atol=0.05)

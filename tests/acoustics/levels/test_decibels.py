"""Decibels, weightings and bands."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.levels.bands import third_octave
from propmdao.acoustics.levels.decibels import oaspl_db, pressure_history, spl_db
from propmdao.acoustics.levels.weighting import a_weighting, oaspl_dba

RNG = np.random.default_rng(0)
FREQUENCY_HZ = 140.0 * np.arange(1, 11)
AMPLITUDE = RNG.normal(size=(3, 10)) + 1j * RNG.normal(size=(3, 10))

# IEC 61672-1:2013, table 3: nominal frequency [Hz], A-weighting [dB]
A_WEIGHTING_TABLE = """
10 -70.4, 12.5 -63.4, 16 -56.7, 20 -50.5, 25 -44.7, 31.5 -39.4, 40 -34.6, 50 -30.2, 63 -26.2,
80 -22.5, 100 -19.1, 125 -16.1, 160 -13.4, 200 -10.9, 250 -8.6, 315 -6.6, 400 -4.8, 500 -3.2,
630 -1.9, 800 -0.8, 1000 0.0, 1250 0.6, 1600 1.0, 2000 1.2, 2500 1.3, 3150 1.2, 4000 1.0, 5000 0.5,
6300 -0.1, 8000 -1.1, 10000 -2.5, 12500 -4.3, 16000 -6.6, 20000 -9.3
"""


def test_a_tone_of_one_pascal_rms_is_94_decibels():
    assert spl_db(1 / np.sqrt(2)) == pytest.approx(93.979, abs=1e-3)  # 20 log10(1 / 20e-6)


def test_a_sine_of_amplitude_a_has_the_level_of_its_mean_square():
    """p = a cos(w t) is P = a/2."""
    assert spl_db(0.3 / 2) == pytest.approx(10 * np.log10(0.3**2 / 2 / 20e-6**2))


def test_overall_level_is_that_of_the_mean_square_pressure():
    """Parseval: the harmonics hold all of p(t)."""
    time, pressure = pressure_history(FREQUENCY_HZ, AMPLITUDE, 32)
    assert time[-1] == pytest.approx(31 / 32 / 140.0)
    np.testing.assert_allclose(
        oaspl_db(AMPLITUDE), 10 * np.log10(np.mean(pressure**2, axis=-1) / 20e-6**2), rtol=1e-12
    )


def test_pressure_history_is_the_sum_of_its_tones():
    time, pressure = pressure_history(FREQUENCY_HZ, AMPLITUDE, 25)
    phase = np.exp(-2j * np.pi * np.outer(FREQUENCY_HZ, time))
    np.testing.assert_allclose(pressure, 2 * (AMPLITUDE @ phase).real, rtol=1e-10, atol=1e-12)


def test_a_weighting_is_the_standards_table_to_its_last_digit():
    rows = [row.split() for row in A_WEIGHTING_TABLE.split(",")]
    for nominal, tabulated in np.array(rows, float):
        exact = 1000 * 10 ** (np.round(10 * np.log10(nominal / 1000)) / 10)
        assert 20 * np.log10(a_weighting(exact)) == pytest.approx(tabulated, abs=0.051)


def test_a_weighted_level_of_one_tone_is_its_level_plus_the_weighting():
    weighted = oaspl_dba(FREQUENCY_HZ[:1], AMPLITUDE[:, :1])
    expected = spl_db(AMPLITUDE[:, 0]) + 20 * np.log10(a_weighting(140.0))
    np.testing.assert_allclose(weighted, expected, rtol=1e-12)


@pytest.mark.parametrize("level", [oaspl_db, lambda p: oaspl_dba(jnp.zeros(4), p), spl_db])
def test_silence_is_minus_200_decibels_and_differentiable(level):
    np.testing.assert_allclose(level(jnp.zeros(4)), -200.0)
    assert not np.any(jax.jacrev(level)(jnp.zeros(4)))


def test_the_floor_under_silence_is_not_heard():
    assert oaspl_db([1e-12]) == pytest.approx(20 * np.log10(np.sqrt(2) * 1e-12 / 20e-6), abs=1e-5)


def test_third_octaves_hold_all_tones_exactly_once():
    center, level = third_octave(FREQUENCY_HZ, AMPLITUDE)
    assert level.shape == (3, center.size)
    total = 10 * np.log10(np.sum(10 ** (level / 10), axis=-1))
    np.testing.assert_allclose(total, oaspl_db(AMPLITUDE), rtol=1e-12)


def test_third_octaves_by_hand():
    """1000 and 1100 Hz share the 1 kHz band (891 to 1122 Hz); 1130 Hz is in the next."""
    center, level = third_octave([100.0, 1000.0, 1100.0, 1130.0], [1e-3, 1e-3, 1e-3, 1e-3])
    np.testing.assert_allclose(center, [100.0, 1000.0, 1258.925412])
    one = float(spl_db(1e-3))
    np.testing.assert_allclose(level, [one, one + 10 * np.log10(2), one])


def test_no_band_where_nothing_turns():
    center, level = third_octave(np.zeros(4), np.zeros((2, 4)))
    assert center.shape == (0,)
    assert level.shape == (2, 0)


def test_too_few_times_for_the_harmonics_are_refused():
    with pytest.raises(
        ValueError, match="n_times must be more than twice the 10 harmonics; got 20"
    ):
        pressure_history(FREQUENCY_HZ, AMPLITUDE, 20)


def test_no_history_of_a_rotor_at_rest():
    with pytest.raises(ValueError, match="blade passage frequency must be positive"):
        pressure_history(np.zeros(2), np.zeros((1, 2)), 8)

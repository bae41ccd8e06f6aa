"""Pegg's method by hand, and as PSU-WOPWOP tabulates and spreads it."""

from __future__ import annotations

import numpy as np
import pytest

from propmdao.acoustics.broadband.pegg import SHAPE_DB, LoadedRotor, pegg_noise

# About the size of a light helicopter.
ROTOR = LoadedRotor(thrust=10e3, tip_speed=200.0, blade_area=4.0)
PEAK = 942.0 + 2.448 * 200.0 - 240.0 * 4.0
SPEED_OF_SOUND = 340.0


def level(frequency, sight=(100.0, 0.0, -50.0), lift=0.4, rotor=ROTOR, axis=(0.0, 0.0, 1.0)):
    power = pegg_noise(frequency, rotor, lift, sight, axis, SPEED_OF_SOUND)
    return 10 * np.log10(np.asarray(power) / 4e-10)


def test_level_at_the_peak_by_hand():
    """60 log M + 10 log(A (cos^2 + 0.1) / r^2) + 130 - 7.5, at the lift of 0.4 where f is 0."""
    assert float(ROTOR.peak_frequency_hz) == pytest.approx(PEAK, rel=1e-12)
    cos2, square = 50.0**2 / (100.0**2 + 50.0**2), 100.0**2 + 50.0**2
    expected = 60 * np.log10(200 / 340) + 10 * np.log10(4.0 * (cos2 + 0.1) / square) + 130.0 - 7.5
    assert float(level([PEAK])[0]) == pytest.approx(expected, abs=1e-9)


def test_shape_at_octaves_and_between_them_as_psu_wopwop_spreads_it():
    octaves = PEAK * 2.0 ** np.arange(-5, 8)
    shape = level(octaves) - level([PEAK]) - 7.5
    np.testing.assert_allclose(shape, SHAPE_DB, atol=1e-9)
    thirds = PEAK * 2.0 ** (np.array([-14, -13, -2, 1, 2, 4]) / 3)
    spread = [-27.83035528, -26.35669527, -10.60833159, -8.5396842, -9.849604208, -11.65595263]
    np.testing.assert_allclose(level(thirds) - level([PEAK]) - 7.5, spread, atol=1e-6)


def test_silence_outside_the_shape():
    outside = np.array([PEAK / 33.0, PEAK * 129.0])
    assert not np.any(pegg_noise(outside, ROTOR, 0.4, (9.0, 0.0, 9.0), (0.0, 0.0, 1.0), 340.0))


def test_lift_beyond_stall_is_loud_and_joins_what_is_below():
    assert float(level([PEAK], lift=0.48)[0] - level([PEAK])[0]) == pytest.approx(
        10 * np.log10(1.2), abs=1e-9
    )
    just, twice = (float(level([PEAK], lift=c)[0]) for c in (0.48 + 1e-9, 0.96))
    assert twice - just == pytest.approx(80 * np.log10(2.0), abs=1e-6)
    assert just - float(level([PEAK], lift=0.48)[0]) == pytest.approx(0.0, abs=0.02)


def test_ten_decibels_louder_on_the_axis_than_in_the_plane():
    axis, plane = (float(level([PEAK], sight=s)[0]) for s in ((0.0, 0.0, 70.0), (70.0, 0.0, 0.0)))
    assert axis - plane == pytest.approx(10 * np.log10(11.0), abs=1e-9)
    other = level([PEAK], sight=(70.0, 0.0, 0.0), axis=(-2.0, 0.0, 0.0))
    assert float(other[0]) == pytest.approx(axis, abs=1e-9)


def test_mean_lift_coefficient():
    assert ROTOR.mean_lift_coefficient(1.225) == pytest.approx(
        6 * 10e3 / (1.225 * 4.0 * 200.0**2), rel=1e-12
    )

"""Third octaves and narrow bands hold the energy they are given."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from jax.test_util import check_grads

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.levels.bands import (
    bands_in_bins,
    third_octave,
    third_octaves_of_spectrum,
    tones_in_bands,
    tones_in_bins,
)
from propmdao.acoustics.levels.decibels import energy_sum_db, level_db, mean_square, oaspl_db
from propmdao.acoustics.levels.spectrum import narrowband, third_octaves_of_record
from propmdao.acoustics.levels.weighting import level_dba

RNG = np.random.default_rng(2)
FREQUENCY_HZ = 140.0 * np.arange(1, 11)
AMPLITUDE = RNG.normal(size=(3, 10)) + 1j * RNG.normal(size=(3, 10))
BANDS = third_octave_centers(100.0, 2000.0)


def noise(n, colour=0.0):
    """Random record whose density goes with frequency to the power of `colour`."""
    spectrum = np.fft.rfft(np.random.default_rng(3).normal(size=n))
    f = np.arange(spectrum.size) + 1.0
    return np.fft.irfft(spectrum * f ** (colour / 2), n)


def test_tones_in_given_bands_are_those_of_the_bands_that_hold_any():
    given = level_db(tones_in_bands(FREQUENCY_HZ, mean_square(AMPLITUDE), BANDS))
    center, level = third_octave(FREQUENCY_HZ, AMPLITUDE)
    where = [int(np.argmin(np.abs(BANDS - c))) for c in center]
    np.testing.assert_allclose(given[:, where], level, rtol=1e-12)
    np.testing.assert_allclose(np.delete(given, where, axis=1), -200.0)


def test_bands_of_tones_have_derivatives():
    @jax.jit
    def level(scale):
        bands = tones_in_bands(FREQUENCY_HZ, mean_square(scale * AMPLITUDE), BANDS)
        return level_dba(BANDS, bands)[0] + level_db(bands)[1, 2]

    check_grads(level, (1.3,), order=1, rtol=1e-6)
    at_rest = jax.grad(lambda f: tones_in_bands(f, mean_square(AMPLITUDE), BANDS).sum())
    slopes = jax.jit(at_rest)(jnp.zeros(10))
    assert not np.any(slopes)  # at rest, too


def test_levels_add_as_energies():
    assert energy_sum_db([60.0, 60.0]) == pytest.approx(60 + 10 * np.log10(2))
    bands = tones_in_bands(FREQUENCY_HZ, mean_square(AMPLITUDE), BANDS)
    np.testing.assert_allclose(energy_sum_db(level_db(bands)), oaspl_db(AMPLITUDE), rtol=1e-12)


@pytest.mark.parametrize("colour", [0.0, -1.0, -4.0])
@pytest.mark.parametrize("window", ["hann", "boxcar"])
def test_third_octaves_hold_the_energy_of_the_narrowband_spectrum(colour, window):
    f, bins = narrowband(noise(30000, colour), 48000.0, 5.0, window)
    center, bands = third_octaves_of_spectrum(f, bins)
    assert 10 * np.log10(bands.sum() / bins.sum()) == pytest.approx(0.0, abs=1e-10)
    assert center[-1] == pytest.approx(1000 * 10**1.4)


def test_third_octaves_of_a_record_hold_its_mean_square():
    records = np.array([noise(4410), noise(4410, -2.0)]) + 3.0
    _, bands = third_octaves_of_record(records, 44100.0)
    np.testing.assert_allclose(bands.sum(axis=-1), records.var(axis=-1), rtol=1e-12)


def test_third_octaves_of_a_record_of_tones_are_those_of_the_tones():
    t = np.arange(4800) / 48000.0  # 0.1 s: every tone fits
    record = np.sqrt(2) * (0.1 * np.sin(2 * np.pi * 1000 * t) + 0.3 * np.cos(2 * np.pi * 4000 * t))
    center, bands = third_octaves_of_record(record, 48000.0)
    heard = bands > 1e-6
    np.testing.assert_allclose(center[heard], [1000.0, 1000 * 10**0.6])
    np.testing.assert_allclose(bands[heard], [0.01, 0.09], rtol=1e-6)


def test_white_noise_has_the_same_density_at_any_bin_width():
    record = noise(480000)
    for width in (2.0, 5.0, 20.0):
        f, bins = narrowband(record, 48000.0, width)
        assert f[0] == pytest.approx(width)
        # 10 s hold 20 times the width independent values: their scatter is in proportion
        np.testing.assert_allclose(
            bins.sum(), record.var(), rtol=3 / np.sqrt(10 * 24000), err_msg=str(width)
        )
        assert bins[10:-10].mean() == pytest.approx(record.var() * width / 24000, rel=0.02)


def test_a_tone_in_a_narrowband_spectrum():
    """All of its energy is there: in one bin without a window, 2/3 of it in the middle by Hann."""
    t = np.arange(96000) / 48000.0
    tone = 0.2 * np.cos(2 * np.pi * 140.0 * t)
    for window, most in (("boxcar", 1.0), ("hann", 2 / 3)):
        f, bins = narrowband(tone, 48000.0, 5.0, window)
        assert f[np.argmax(bins)] == pytest.approx(140.0)
        assert bins.max() == pytest.approx(most * 0.02, rel=1e-9)
        assert bins.sum() == pytest.approx(0.02, rel=1e-9)


def test_tones_in_bins_are_where_their_frequency_is():
    bins = 5.0 * np.arange(1, 401)
    spectrum = tones_in_bins([140.0, 281.0, 420.0, 5000.0], [[1.0, 2.0, 4.0, 8.0]], bins)
    assert spectrum.shape == (1, 400)
    np.testing.assert_allclose(spectrum[0, [27, 55, 83]], [1.0, 2.0, 4.0])
    assert float(spectrum.sum()) == 7.0  # the last one is beyond


SMOOTH_DB = 50 + 12 * np.sin(np.arange(24) / 4) - 0.4 * np.arange(24)
ROUGH_DB = RNG.uniform(20, 60, 24)
WITH_SILENCE_DB = np.where(np.arange(24) % 7 == 3, -200.0, SMOOTH_DB)


@pytest.mark.parametrize("level", [SMOOTH_DB, ROUGH_DB, WITH_SILENCE_DB])
@pytest.mark.parametrize("width", [0.5, 5.0, 20.0])
def test_bands_spread_over_bins_and_gathered_again_are_the_same(level, width):
    center = third_octave_centers(100.0, 20000.0)
    bins = width * np.arange(1, int(24000 / width))
    given = 4e-10 * 10 ** (level / 10)
    back_center, back = third_octaves_of_spectrum(bins, bands_in_bins(center, given, bins))
    first = int(np.argmin(np.abs(back_center - 100.0)))
    loud = level > -100
    got = 10 * np.log10(back[first : first + 24][loud] / given[loud])
    # bins across an edge are in both bands, by their share
    np.testing.assert_allclose(got, 0.0, atol=1e-9)
    assert np.all(back[first : first + 24][~loud] < 1e-3 * given.max())
    # what the lowest bin has of the band below: less than half a bin of the 23.1 Hz wide one
    assert back[:first].sum() < 0.5 * width / 23.1 * given[0]


def test_spread_bands_have_no_steps_at_their_edges():
    bins = 0.5 * np.arange(1, 46000)
    spectrum = bands_in_bins(third_octave_centers(100.0, 20000.0), 10 ** (SMOOTH_DB / 10), bins)
    inside = (bins > 90) & (bins < 22000)
    steps = np.abs(np.diff(10 * np.log10(spectrum[inside])))
    assert steps.max() < 0.06  # dB per bin; bands differ by up to 3.4 dB


def test_several_observers_and_silence():
    center, bins = third_octave_centers(500.0, 2000.0), 5.0 * np.arange(1, 600)
    two = bands_in_bins(center, np.array([np.ones(7), np.zeros(7)]), bins)
    assert two.shape == (2, 599)
    assert two[0].sum() == pytest.approx(7.0, rel=1e-3)
    assert not np.any(two[1])


def test_one_band_alone_is_flat():
    bins = 1.0 * np.arange(1, 2000)
    spectrum = bands_in_bins([1000.0], [5.0], bins)
    inside = (bins > 892) & (bins < 1122)
    np.testing.assert_allclose(spectrum[inside], 5.0 / 230.8, rtol=0.01)
    assert spectrum.sum() == pytest.approx(5.0, rel=0.005)


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda: narrowband(np.zeros(100), 1000.0, 1.0),
            r"bin width must be between 10 Hz \(one over the record's length\) and 500 Hz; got 1",
        ),
        (lambda: narrowband(np.zeros(100), 1000.0, 0.0), "bin width must be between"),
        (
            lambda: third_octaves_of_spectrum([0.0, 1.0, 2.0], np.ones(3)),
            "a spectrum must start above 0 Hz",
        ),
        (
            lambda: third_octaves_of_spectrum([1.0, 2.0, 4.0], np.ones(3)),
            "frequencies of a narrowband spectrum must be evenly spaced",
        ),
        (lambda: third_octaves_of_spectrum([1.0], np.ones(1)), "at least 2 bins; got 1"),
        (
            lambda: bands_in_bins([100.0, 1000.0], np.ones(2), np.arange(1, 3000)),
            "bands must be neighbouring third octaves",
        ),
        (
            lambda: bands_in_bins(BANDS, np.ones(14), 50.0 * np.arange(1, 99)),
            "bins of 50 Hz are wider than the band around 100 Hz, 23.1 Hz",
        ),
        (
            lambda: bands_in_bins(BANDS, np.ones(14), 5.0 * np.arange(1, 99)),
            "bins from 2.5 to 492.5 Hz do not cover the bands, 89.13 to 2239 Hz",
        ),
    ],
)
def test_what_cannot_be_is_refused(call, message):
    with pytest.raises(ValueError, match=message):
        call()

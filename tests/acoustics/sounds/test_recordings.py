"""Sound files: what is heard has the levels that were computed, and loops without a click."""

import numpy as np
import pytest
import soundfile

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.levels.bands import third_octaves_of_spectrum
from propmdao.acoustics.levels.decibels import level_db, oaspl_db, pressure_history
from propmdao.acoustics.levels.spectrum import narrowband, third_octaves_of_record
from propmdao.acoustics.sounds.recordings import (
    SAMPLE_RATE,
    broadband_record,
    common_full_scale,
    looped_record,
    tone_record,
)
from propmdao.formats.wav import write_wav

RNG = np.random.default_rng(8)
FREQUENCY_HZ = 136.7 * np.arange(1, 11)
AMPLITUDE = (RNG.normal(size=(2, 10)) + 1j * RNG.normal(size=(2, 10))) / 100
BANDS = third_octave_centers(100.0, 20000.0)
LEVEL_DB = 55 + 10 * np.sin(BANDS.size * np.linspace(0, 0.4, BANDS.size))
MEAN_SQUARE = 4e-10 * 10 ** (LEVEL_DB / 10)


def test_tones_last_as_asked_and_have_their_pressure():
    record = tone_record(FREQUENCY_HZ, AMPLITUDE, 2.0)
    assert record.shape[1] / SAMPLE_RATE == pytest.approx(2.0, abs=0.5 / 136.7 + 1 / SAMPLE_RATE)
    np.testing.assert_allclose(level_db(record.var(axis=-1)), oaspl_db(AMPLITUDE), rtol=1e-12)
    t = np.arange(100) / SAMPLE_RATE
    expected = 2 * (AMPLITUDE @ np.exp(-2j * np.pi * np.outer(FREQUENCY_HZ, t))).real
    # the pitch is off by up to half a sample in 2 s, 5e-6: a phase of 1e-4 of the highest tone
    np.testing.assert_allclose(record[:, :100], expected, atol=1e-3 * np.abs(expected).max())


def test_tones_repeat_without_a_click():
    record = tone_record(FREQUENCY_HZ, AMPLITUDE, 0.5)[0]
    center, once = third_octaves_of_record(record, SAMPLE_RATE)
    thrice_center, thrice = third_octaves_of_record(np.tile(record, 3), SAMPLE_RATE)
    thrice = thrice[-center.size :]
    np.testing.assert_allclose(thrice_center[-center.size :], center)
    np.testing.assert_allclose(thrice, once, rtol=1e-9, atol=1e-20 * once.sum())
    assert once[-3:].sum() < 1e-20 * once.sum()  # a click would be heard there


def test_tones_above_the_range_of_the_file_are_left_out():
    high = tone_record(5000.0 * np.arange(1, 11), np.ones(10), 0.1)
    assert high.var() == pytest.approx(2 * 4)  # 5, 10, 15, 20 kHz


def test_any_periodic_history_can_be_heard():
    time, passage = pressure_history(FREQUENCY_HZ, AMPLITUDE, 64)
    record = looped_record(passage, 1 / 136.7, 1.5)
    np.testing.assert_allclose(record, tone_record(FREQUENCY_HZ, AMPLITUDE, 1.5), atol=1e-12)
    odd = looped_record(pressure_history(FREQUENCY_HZ, AMPLITUDE, 33)[1], 1 / 136.7, 1.5)
    np.testing.assert_allclose(odd, record, atol=1e-12)


@pytest.mark.parametrize("n_times", [24000, 48000 + 17])
def test_noise_has_the_right_level_in_every_band(n_times):
    record = broadband_record(BANDS, [MEAN_SQUARE, 10 * MEAN_SQUARE], n_times)
    center, bands = third_octaves_of_record(record, SAMPLE_RATE)
    first = int(np.argmin(np.abs(center - BANDS[0])))
    heard = bands[:, first : first + BANDS.size]
    off = 10 * np.log10(heard / [MEAN_SQUARE, 10 * MEAN_SQUARE])
    np.testing.assert_allclose(off, 0.0, atol=0.2)  # the promise
    np.testing.assert_allclose(off, 0.0, atol=0.03)  # what it is


def test_noise_is_smooth_across_bands():
    record = broadband_record(BANDS, MEAN_SQUARE, 4 * 48000)
    f, bins = narrowband(record, SAMPLE_RATE, 0.25, "boxcar")
    inside = (f > 100) & (f < 19000)
    assert np.abs(np.diff(10 * np.log10(bins[inside]))).max() < 0.05


def test_noise_repeats_without_a_click():
    record = broadband_record(BANDS, MEAN_SQUARE, 24000)
    step = np.abs(np.diff(record))
    assert abs(record[0] - record[-1]) < step.max()
    center, once = third_octaves_of_record(record, SAMPLE_RATE)
    _, thrice = third_octaves_of_spectrum(
        *narrowband(np.tile(record, 3), SAMPLE_RATE, 2.0, "boxcar")
    )
    np.testing.assert_allclose(thrice, once, rtol=1e-6, atol=1e-20)


def test_noise_is_the_same_for_the_same_seed_only_and_gaussian():
    one, same, other = (broadband_record(BANDS, MEAN_SQUARE, 48000, seed=s) for s in (1, 1, 2))
    np.testing.assert_array_equal(one, same)
    assert abs(np.corrcoef(one, other)[0, 1]) < 0.05
    kurtosis = np.mean(one**4) / np.mean(one**2) ** 2
    assert kurtosis == pytest.approx(3.0, abs=0.15)


def test_bands_above_the_range_of_the_file_are_left_out():
    record = broadband_record(BANDS, MEAN_SQUARE, 8000, sample_rate=16000)
    assert record.var() == pytest.approx(MEAN_SQUARE[BANDS < 7000].sum(), rel=0.01)


@pytest.mark.parametrize("bits", [24, 32])
def test_a_file_holds_the_pressure(tmp_path, bits):
    pressure = tone_record(FREQUENCY_HZ, AMPLITUDE, 0.5)
    written = write_wav(tmp_path / "two.wav", pressure, 2.5, bits=bits)
    numbers, rate = soundfile.read(written.path)
    assert rate == SAMPLE_RATE
    np.testing.assert_allclose(numbers.T * written.full_scale, pressure, atol=2.5 * 2.0**-22)
    assert written.duration == pytest.approx(pressure.shape[1] / SAMPLE_RATE)
    assert written.peak == np.abs(pressure).max()
    with soundfile.SoundFile(written.path) as file:
        assert file.comment == "full scale = 2.5 Pa"
        assert file.subtype == f"PCM_{bits}"
        assert file.channels == 2


def test_two_blades_in_files_differ_by_their_levels(tmp_path):
    loud = tone_record(FREQUENCY_HZ, AMPLITUDE[0], 0.5)
    quiet = tone_record(FREQUENCY_HZ, 0.5 * AMPLITUDE[0], 0.5)
    scale = common_full_scale(loud, quiet)
    heard = [
        soundfile.read(write_wav(tmp_path / f"{k}.wav", p, scale).path)[0]
        for k, p in enumerate((loud, quiet))
    ]
    assert 10 * np.log10(heard[0].var() / heard[1].var()) == pytest.approx(6.02, abs=0.01)


@pytest.mark.parametrize(("peak", "scale"), [(0.0342, 0.035), (1.0, 1.0), (-7.21, 7.3)])
def test_full_scale_is_the_peak_rounded_up(peak, scale):
    assert common_full_scale([0.0, 0.1 * peak], [peak]) == scale


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (
            lambda path: write_wav(path, [0.1, -0.37, 0.2], 0.3),
            "pressure would be clipped: its peak is 0.37 Pa, full scale 0.3 Pa",
        ),
        (lambda path: write_wav(path, [0.1, np.nan], 1.0), "must be finite; 1 samples are not"),
        (lambda path: write_wav(path, [0.1], 1.0, bits=16), "must be 24 or 32; got 16"),
        (lambda path: write_wav(path, [0.1], 0.0), r"full scale must be within .* Pa; it is 0"),
        (lambda path: write_wav(path, np.zeros((0, 4)), 1.0), r"pressures; got \(0, 4\)"),
        (lambda path: common_full_scale([0.0]), "nothing to be heard"),
        (lambda path: tone_record([0.0, 0.0], [1, 1], 1.0), "frequency must be positive"),
        (lambda path: tone_record([100.0], [1], -1.0), r"duration .* positive \[s\]; got -1"),
        (lambda path: looped_record([1.0, 2.0], 0.01, 1.0), "at least 3 samples .* got 2"),
        (
            lambda path: broadband_record([1000.0], [1.0], 1000, 2000),
            "sample rate of 2000 Hz is too low for the band around 1000 Hz",
        ),
        (
            lambda path: broadband_record(BANDS, MEAN_SQUARE, 1000),
            "bins of 48 Hz are wider than the band around 100 Hz",
        ),
    ],
)
def test_what_cannot_be_is_refused(tmp_path, call, message):
    path = tmp_path / "no.wav"
    with pytest.raises(ValueError, match=message):
        call(path)
    assert not path.exists()

"""Levels of cases: segments, windows, absorption, exposure, perceived noise, and their files."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.levels.decibels import level_db
from propmdao.acoustics.levels.epnl import effective_perceived_noise_level
from propmdao.acoustics.levels.perceived_noise import PERCEIVED_BANDS_HZ
from propmdao.acoustics.propagation.absorption import absorption_db_per_m
from propmdao.analysis.wopwop.broadband_sources import BANDS_HZ
from propmdao.analysis.wopwop.case_levels import ALL, BROADBAND, case_levels
from propmdao.analysis.wopwop.foreign_case import CaseResult, run_case
from propmdao.analysis.wopwop.level_output import write_levels
from propmdao.formats.wopwop.namelists.case_records import ObserverGrid, Wanted
from propmdao.formats.wopwop.outputs.pressure_file import PressureHistories, read_pressure
from propmdao.records.air import Air

RATE, TONE_HZ, PASCAL = 8000.0, 500.0, 0.2
AIR = Air()
NOTHING = Wanted(*[False] * 7, text=True)


def result(seconds=2.0, segment=None, step=None, window="boxcar", absorption=False, loud=None):
    """A tone at two observers, the second twice as loud, and a band of broadband noise."""
    n = round(seconds * RATE)
    time = np.arange(n) / RATE
    grid = ObserverGrid(
        "grid", np.array([[10.0, 0.0, 0.0], [0.0, 5.0, 0.0]]), np.zeros(3), time,
        (0.0, np.inf), (2, 1), segment or time[-1], step or segment or time[-1], window, True,
        absorption,
    )  # fmt: skip
    envelope = np.ones(n) if loud is None else loud(time)
    tone = PASCAL * np.sqrt(2.0) * envelope * np.sin(2.0 * np.pi * TONE_HZ * time)
    loading = np.stack([tone, 2.0 * tone])
    pressure = PressureHistories(
        np.broadcast_to(grid.position[:, None], (2, n, 3)),
        np.broadcast_to(time, (2, n)), 0.0 * loading, loading, loading,
    )  # fmt: skip
    n_segments = grid.segment_starts.size
    noise = np.zeros((2, n_segments, BANDS_HZ.size))
    noise[..., np.argmin(np.abs(BANDS_HZ - 2000.0))] = 1e-4
    way = np.broadcast_to([[400.0], [800.0]], (2, n_segments))
    return CaseResult(
        "case.nam", "grid", pressure, grid, NOTHING, AIR, np.array(way), {"pressure_side": noise}
    )


def tone_of(levels, observer=0):
    near = np.abs(levels.frequency_hz - TONE_HZ) < 20.0
    return levels.narrowband["total"][observer][:, near].sum(axis=-1)


@pytest.mark.parametrize("window", ["boxcar", "hann"])
def test_every_segment_holds_the_mean_square_of_the_tone(window):
    levels = case_levels(result(segment=0.5, step=0.25, window=window))
    assert_allclose(levels.time, 0.25 + 0.25 * np.arange(6))  # the last sample ends the record
    for observer, factor in enumerate((1.0, 4.0)):
        assert_allclose(tone_of(levels, observer), factor * PASCAL**2, rtol=1e-6)
    assert_allclose(levels.overall("total")[0], PASCAL**2, rtol=1e-6)
    assert_allclose(levels.overall(BROADBAND), 1e-4)
    assert_allclose(levels.overall(ALL)[0], PASCAL**2 + 1e-4, rtol=1e-6)
    assert levels.step == 0.25 and levels.frequency_hz[0] == pytest.approx(2.0)


def test_third_octaves_hold_tones_and_noise():
    levels = case_levels(result())
    bands = {round(f): q for f, q in zip(levels.center_hz, levels.bands[ALL][0, 0], strict=True)}
    assert bands[501] == pytest.approx(PASCAL**2, rel=1e-3)
    assert bands[1995] == pytest.approx(1e-4, rel=1e-6)
    assert_allclose(levels.bands[ALL].sum(axis=-1), levels.overall(ALL), rtol=1e-9)


def test_the_air_absorbs_on_the_way():
    free, damped = (case_levels(result(absorption=one)) for one in (False, True))
    for frequency, part in ((TONE_HZ, "total"), (1995.26, BROADBAND)):
        lost = level_db(free.overall(part)) - level_db(damped.overall(part))
        per_metre = float(absorption_db_per_m(frequency, AIR))
        assert_allclose(lost[:, 0], per_metre * np.array([400.0, 800.0]), rtol=2e-3)


def test_exposure_of_a_steady_sound_is_its_level_for_a_second():
    levels = case_levels(result(seconds=4.0, segment=0.5))
    steady = levels.overall_dba(ALL)[:, 0]
    assert_allclose(levels.exposure_db(), steady + 10.0 * np.log10(3.5), atol=1e-6)
    whole = case_levels(result(seconds=4.0))
    assert_allclose(whole.exposure_db(), steady + 10.0 * np.log10(4.0), atol=1e-3)


def test_effective_perceived_noise_is_that_of_the_bands():
    def flyover(time):
        return np.exp(-(((time - 10.0) / 3.0) ** 2)) + 1e-3

    silent = result(seconds=20.0, segment=0.5, loud=flyover)
    silent = dataclasses.replace(silent, broadband={})
    levels = case_levels(silent)
    found = levels.perceived(1)
    number = [int(np.argmin(np.abs(levels.center_hz - f))) for f in PERCEIVED_BANDS_HZ[:20]]
    bands = np.full((levels.time.size, 24), 0.0)
    bands[:, :20] = levels.bands[ALL][1][:, number]
    known = effective_perceived_noise_level(np.asarray(level_db(bands)), 0.5)
    assert found.epnl == pytest.approx(known.epnl, abs=0.01)
    steady = case_levels(result(seconds=4.0, segment=0.5))
    with pytest.raises(ValueError, match="must begin and end 10 dB below its maximum"):
        steady.perceived(0)


@pytest.mark.parametrize("text", [True, False])
def test_files_are_as_psu_wopwop_writes_them(tmp_path, text):
    wanted = Wanted(True, True, True, True, False, False, False, text)
    asked = dataclasses.replace(result(segment=0.5), wanted=wanted)
    stems = write_levels(tmp_path / "out", [asked])
    names = ["spl_spectrum", "spl_octFilt_spectrum", "spl_mspBB", "OASPLdB", "OASPLdBA"]
    assert [stem.name for stem in stems] == names
    levels = case_levels(asked)
    # The reader of pressures takes any such files: its names are found by these words.
    labels = (tmp_path / "out" / "OASPLdB.nam").read_text().splitlines()
    assert labels[:4] == [" Observer Time (s)", " Thickness_dB", " Loading_dB", " Total_dB"]
    read = read_pressure(tmp_path / "out" / "OASPLdB")
    assert_allclose(read.time, np.broadcast_to(levels.time, (2, 3)), rtol=1e-5)
    assert_allclose(read.total, level_db(levels.overall(ALL)), rtol=1e-5)
    assert_allclose(read.position[:, 0], asked.listening.position)
    labels = (tmp_path / "out" / "spl_octFilt_spectrum.nam").read_text().split()
    assert labels[:6] == [
        "Frequency", "Thickness_dB", "Loading_dB", "Total_dB", "BPM-TBLTEp_dB",
        "Broadband-Total_dB",
    ]  # fmt: skip
    assert "Total_dBA" in labels
    if text:
        lines = (tmp_path / "out" / "spl_mspBB.fn").read_text().splitlines()
        sizes = [int(size) for size in lines[0].split()]
        assert sizes == [2, 1, levels.center_hz.size, 3] and len(lines) == 1 + np.prod(sizes)


def test_several_groups_of_observers_have_folders_of_their_own(tmp_path):
    wanted = dataclasses.replace(NOTHING, spectrum=True)
    each = dataclasses.replace(result(), wanted=wanted, broadband={})
    stems = write_levels(tmp_path, [each, each])
    assert [stem.parent.name for stem in stems] == ["case_1", "case_1", "case_2", "case_2"]


def test_a_case_says_how_its_observers_listen(make_case):
    folder = make_case(
        EnvironmentConstants={"RelHumidity": 40.0, "mu": 1.8e-5},
        ObserverIn={
            "segmentSize": 0.02, "segmentStepSize": 0.01, "windowFunction": "Hanning Window",
            "octaveFlag": True, "octaveNumber": 3, "AtmAtten": True,
        },
    )  # fmt: skip
    (found,) = run_case(folder)
    grid = found.listening
    assert (grid.segment, grid.step, grid.window) == (0.02, 0.01, "hann")
    assert grid.third_octaves and grid.absorption and grid.shape == (1, 2)
    assert grid.segment_starts.size == 5
    assert float(found.air.relative_humidity) == pytest.approx(0.4)
    # Temperature of a perfect gas with this speed of sound, pressure of one with this density
    assert float(found.air.temperature) == pytest.approx(340.0**2 / (1.4 * 287.05287))
    assert float(found.air.pressure) == pytest.approx(1.2 * 340.0**2 / 1.4)
    assert found.distance.shape == (2, 5)
    assert_allclose(found.distance[:, 0], np.hypot([3.0, 4.0], 2.0), rtol=1e-6)
    assert found.broadband == {}


@pytest.mark.parametrize(
    ("group", "message"),
    [
        ({"segmentSize": 1.0}, "segmentSize must be within the record of 0.062341 s"),
        ({"segmentSize": 0.01, "segmentStepSize": 0.0}, "segmentStepSize above 0"),
        ({"windowFunction": "Flat Top Window"}, "is not done, only 'Hanning Window'"),
        ({"octaveFlag": True, "octaveNumber": 1}, "octaveNumber must be 3"),
    ],
)
def test_what_observers_cannot_do_is_refused(make_case, group, message):
    with pytest.raises(ValueError) as caught:
        run_case(make_case(ObserverIn=group))
    assert message in str(caught.value) and "\n" not in str(caught.value)

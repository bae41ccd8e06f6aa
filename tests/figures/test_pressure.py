"""Pressure over time is that of the tones or of the record."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.figures.contents.pressures import sampled


def test_a_blade_passage_has_the_overall_level(sounds, figures, line):
    for i, sound in enumerate(sounds.values()):
        total = line(figures["pressure"], "total", i)
        rms = np.sqrt(np.mean((1e-3 * total.get_ydata()) ** 2))
        assert_allclose(20 * np.log10(rms / 20e-6), oaspl_db(sound.tones.total[3]), atol=1e-9)


def test_pressure_is_that_of_the_record(figures, line):
    time, p = line(figures["pressure_of_records"], "total").get_data()
    assert time[-1] == pytest.approx(20.0, abs=0.1)  # ms
    assert_allclose(p, 100.0 * np.sin(0.9 * time))  # mPa


def test_a_record_that_is_shorter_than_asked_for_is_shown_whole():
    record = sampled({"short": [1.0, 2.0, 3.0]}, 100.0, 1.0)
    assert_allclose(record.time, [0.0, 0.01, 0.02])

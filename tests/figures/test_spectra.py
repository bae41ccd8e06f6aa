"""Spectra show the levels that they are given."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.figures.contents.palette import MARKERS
from propmdao.figures.contents.sound import amplitudes, band_levels
from propmdao.figures.spectra import third_octaves


def test_harmonics_have_the_levels_of_each_source(sounds, figures):
    for axes, sound in zip(figures["harmonic_spectrum"].axes, sounds.values(), strict=True):
        shown = {stems.get_label(): stems.markerline for stems in axes.containers}
        frequency = np.asarray(sound.tones.frequency_hz)
        for source, pressure in amplitudes(sound.tones).items():
            level = np.asarray(spl_db(pressure[3]))
            assert_allclose(shown[source].get_ydata(), level[level > axes.get_ylim()[0]])
            # Side by side, but nowhere near the next harmonic.
            n = shown[source].get_xdata().size
            offset = shown[source].get_xdata() - frequency[:n]
            assert np.abs(offset).max() < 0.06 * frequency[0]


def energy_db(levels):
    return 10 * np.log10(np.sum(10 ** (np.asarray(levels) / 10)))


def test_narrow_bands_and_third_octaves_have_the_same_energy(sounds, figures):
    for axes, sound in zip(figures["narrowband_spectrum"].axes, sounds.values(), strict=True):
        (bands,) = axes.patches
        levels = bands.get_data().values
        assert_allclose(levels, band_levels(sound, 3))
        # A bin across an edge belongs to one band.
        narrow = energy_db(axes.lines[0].get_ydata())
        assert narrow == pytest.approx(energy_db(levels), abs=0.02)


def test_narrow_bands_of_tones_alone_have_their_energy(sounds, figures):
    rows = figures["narrowband_spectrum_of_tones"].axes
    for axes, sound in zip(rows, sounds.values(), strict=True):
        (tones,) = axes.lines
        assert not axes.patches
        assert energy_db(tones.get_ydata()) == pytest.approx(float(oaspl_db(sound.tones.total[3])))


def test_third_octaves_leave_out_what_is_silent():
    bands = np.array([100.0, 125.0, 160.0])
    figure = third_octaves(bands, {"loud": 0 * bands + 50.0, "silent": 0 * bands - 200.0})
    assert [drawn.get_label() for drawn in figure.axes[0].lines] == ["loud"]


def test_measurements_are_dots_of_the_colour_of_their_line(figures, line):
    for name in ("third_octaves", "directivity"):
        computed, measured = (line(figures[name], label) for label in ("total", "total, measured"))
        assert computed.get_color() == measured.get_color()
        assert measured.get_marker() in MARKERS

"""Spectra of two sounds over each other show the levels of each."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.levels.decibels import spl_db
from propmdao.figures.contents.sound import Sound, band_levels, source_levels
from propmdao.figures.designs.spectra_over_each_other import spectra_over_each_other


def test_tones_bands_and_overall_levels_are_those_of_the_sounds(figures, sounds):
    above, plain, weighted = figures["spectra_over_each_other"].axes
    for number, (name, sound) in enumerate(sounds.items()):
        (dots,) = (line for line in above.lines if str(line.get_label()).startswith(name))
        floor, top = above.get_ylim()
        level = np.asarray(spl_db(sound.tones.total[3]))
        assert_allclose(dots.get_ydata(), level[level > floor])
        # The bands stand in the order of the sounds, those that are drawn with their level.
        bands = plain.patches[number].get_data().values
        assert_allclose(bands, np.maximum(band_levels(sound, 3), plain.get_ylim()[0] - 1.0))
        for axes, a_weighted, unit in ((plain, False, "dB"), (weighted, True, "dBA")):
            overall = source_levels(sound, a_weighted)["total"][3]
            texts = [text.get_text() for text in axes.get_legend().get_texts()]
            assert texts[number] == f"{name}: {overall:.1f} {unit}"
            assert max(axes.patches[number].get_data().values) < axes.get_ylim()[1]


def test_silence_says_so(sounds):
    sound = sounds["before"]
    tones = sound.tones
    silent = type(tones)(tones.frequency_hz, {name: 0.0 * p for name, p in tones.parts.items()})
    figure = spectra_over_each_other({"nothing": Sound.of_tones(silent)})
    said = [axes.texts[0].get_text() for axes in figure.axes]
    assert said == ["nothing above -100 dB"] * 3

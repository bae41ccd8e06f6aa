"""Levels of the sound that figures show."""

from __future__ import annotations

import dataclasses

import jax
import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.figures.contents.sound import Sound, amplitudes, band_levels, source_levels


def test_source_levels_add_energies_of_tones_and_noise(sounds, levels):
    sound = sounds["before"]
    tones = oaspl_db(sound.tones.total)
    noise = 10 * np.log10(sound.broadband.sum(axis=1) / 4e-10)
    assert list(levels) == ["thickness", "loading", "broadband", "total"]
    assert_allclose(levels["broadband"], noise)
    for source, pressure in sound.tones.parts.items():
        assert_allclose(levels[source], oaspl_db(pressure))
    assert_allclose(10 ** (levels["total"] / 10), 10 ** (tones / 10) + 10 ** (noise / 10))


def test_sound_without_broadband_noise_has_no_level_of_it(sounds):
    tones = sounds["before"].tones
    levels = source_levels(Sound.of_tones(tones))
    assert list(levels) == ["thickness", "loading", "total"]
    assert_allclose(levels["total"], oaspl_db(tones.total))


def test_bands_hold_tones_and_noise(sounds, levels):
    level = band_levels(sounds["before"], 3)
    assert_allclose(10 * np.log10(np.sum(10 ** (level / 10))), levels["total"][3])


def test_sources_keep_their_order_through_jax_and_the_total_is_last(sounds):
    tones = jax.tree.map(lambda leaf: leaf, sounds["before"].tones)  # sorts the sources by name
    tones = dataclasses.replace(tones, parts=tones.parts | {"another": tones.total})
    assert list(amplitudes(tones)) == ["thickness", "loading", "another", "total"]

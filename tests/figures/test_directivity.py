"""Polar diagrams and maps show the levels that they are given."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.figures.contents.sound import amplitudes
from propmdao.figures.directivity import directivity, hemisphere_map

ELEVATIONS = np.linspace(-90.0, 90.0, 13)


def test_directivity_shows_every_source_and_keeps_silence_at_the_centre(figures, levels, line):
    floor, _ = figures["directivity"].axes[0].get_ylim()
    for name, level in levels.items():
        angle, drawn = line(figures["directivity"], name).get_data()
        assert_allclose(np.degrees(angle), ELEVATIONS)
        assert_allclose(drawn, np.maximum(level, floor))
    figure = directivity([0.0, 45.0], {"one": [50.0, -200.0]})
    drawn = line(figure, "one").get_ydata()
    assert_allclose(drawn, [50.0, figure.axes[0].get_ylim()[0]])


def test_directivity_of_two_sounds_shows_every_source_of_each(figures, sounds, line):
    floor, _ = figures["directivity_of_two"].axes[0].get_ylim()
    styles = []
    for name, sound in sounds.items():
        for source, pressure in amplitudes(sound.tones).items():
            drawn = line(figures["directivity_of_two"], f"{name}, {source}")
            angle, level = drawn.get_data()
            assert_allclose(np.degrees(angle), ELEVATIONS)
            assert_allclose(level, np.maximum(oaspl_db(pressure), floor))
            styles.append(drawn.get_linestyle())
    assert styles == ["--"] * 3 + ["-"] * 3
    angle, _ = line(figures["directivity_of_two"], "microphone").get_data()
    assert_allclose(np.degrees(angle), -45.0)


def test_measurements_are_drawn_where_they_were_taken(figures, line):
    angle, level = line(figures["directivity"], "total, measured").get_data()
    assert_allclose(np.degrees(angle), [-45.0, 0.0])
    assert_allclose(level, [60.0, 62.0])


def test_map_has_straight_below_in_its_middle_and_turns_as_seen_from_below(figures):
    axes = figures["hemisphere_map"].axes[0]
    assert axes.get_ylim() == (-90.0, 0.0)
    assert axes.get_theta_direction() == -1
    assert axes.get_theta_offset() == pytest.approx(np.pi / 2)


def test_contours_are_round_levels_that_stand_on_their_lines():
    elevation, azimuth = np.linspace(-90.0, 0.0, 10), np.linspace(0.0, 360.0, 37)
    level = np.tile(47.3 + elevation[:, None] / 9.0, (1, 37))  # 37.3 ... 47.3 dB
    figure = hemisphere_map(elevation, azimuth, level)
    ticks = figure.axes[1].get_yticks()
    assert_allclose(ticks, np.arange(37.0, 49.0))
    written = {float(text.get_text()): text.get_position() for text in figure.axes[0].texts}
    assert set(written) <= set(np.arange(38.0, 48.0)) and len(written) > 4
    for step, (_, place) in written.items():
        assert step == pytest.approx(47.3 + place / 9.0)
    boxes = [text.get_window_extent() for text in figure.axes[0].texts]
    assert not any(box.overlaps(other) for i, box in enumerate(boxes) for other in boxes[:i])


def test_a_silent_map_says_so():
    elevation, azimuth = np.linspace(-90.0, 0.0, 4), np.linspace(0.0, 360.0, 13)
    figure = hemisphere_map(elevation, azimuth, np.full((4, 13), -200.0))
    assert [text.get_text() for text in figure.axes[0].texts] == ["nothing above -100 dB"]


def test_half_a_circle_fills_its_page(figures):
    figure = figures["directivity"]
    figure.draw_without_rendering()
    arc = figure.axes[0].patch.get_window_extent()
    assert arc.height > 0.8 * figure.bbox.height and arc.width > 0.5 * figure.bbox.width


def test_map_of_one_level_can_be_drawn():
    elevation, azimuth = np.linspace(-90.0, 0.0, 4), np.linspace(0.0, 360.0, 25)
    hemisphere_map(elevation, azimuth, np.full((4, 25), 60.0)).draw_without_rendering()

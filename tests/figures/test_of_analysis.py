"""Figures of an analysis: which there are, of which observers."""

from __future__ import annotations

from types import SimpleNamespace

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.kinematics.observers import arc, hemisphere, point
from propmdao.acoustics.levels.decibels import mean_square, oaspl_db
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.acoustics.signals import Tones
from propmdao.analysis.results import MECHANISMS
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.sound import analysis_sound, band_levels, mechanism_levels
from propmdao.figures.of_analysis import analysis_figures
from propmdao.records.listening import Listening, ObserverGroup, Surroundings

FREE_FIELD = Surroundings()
ARC = arc(1.905, [-45.0, 0.0, 45.0])


def analysis(observers, groups=(), broadband=False, surroundings=FREE_FIELD):
    """All that the figures want to know of an analysis, of random numbers."""
    rng = np.random.default_rng(1)
    n = len(observers)
    thickness, loading = (jnp.asarray(1e-3 * (1.0 + rng.random((n, 3)))) for _ in range(2))
    noise = {name: 1e-7 * (1.0 + rng.random((n, BANDS_HZ.size))) for name in MECHANISMS}
    return SimpleNamespace(
        propeller=SimpleNamespace(name="blade"),
        rpm=4200.0,
        point=SimpleNamespace(speed=8.0, incidence_deg=0.0),
        loads=None,
        tones=Tones(140.0 * jnp.arange(1.0, 4.0), {"thickness": thickness, "loading": loading}),
        broadband=SelfNoise(**noise) if broadband else None,
        listening=Listening(observers, surroundings, groups),
    )


def test_figures_of_what_there_is():
    groups = (ObserverGroup("arc", "arc", 3),)
    assert set(analysis_figures(analysis(ARC, groups))) == {"spectrum", "pressure", "directivity"}
    assert set(analysis_figures(analysis(ARC, groups, broadband=True))) == {
        "spectrum", "pressure", "third_octaves", "directivity"
    }  # fmt: skip
    two = (ObserverGroup("arc", "arc", 2),)
    assert set(analysis_figures(analysis(ARC[:2], two))) == {"spectrum", "pressure"}


def test_figures_need_observers_that_there_are():
    with pytest.raises(ValueError, match="figures need observers, an incidence or"):
        analysis_figures(analysis(np.zeros((0, 3))))
    for wrong in (-1, 3):
        with pytest.raises(ValueError, match=f"observer must be within 0 ... 2; it is {wrong}"):
            analysis_figures(analysis(ARC), wrong)


def test_spectrum_and_pressure_are_at_the_observer_asked_for():
    for observer, place in ((0, "observer 1: -45°"), (2, "observer 3: 45°")):
        figures = analysis_figures(analysis(ARC), observer)
        title = f"blade, 4200 rpm, 8 m/s; {place}, 1.905 m"
        assert figures["pressure"].axes[0].get_title(loc="left") == title
        assert figures["spectrum"].axes[0].get_title(loc="left") == f"{title}: BPF 140.0 Hz"


def test_the_observer_of_the_loudest_tones_is_drawn_unless_another_is_asked_for(line):
    found = analysis(ARC)
    loud = found.tones.each(lambda p: p.at[1].multiply(3.0).at[0].multiply(1e-13))
    found = SimpleNamespace(**vars(found) | {"tones": loud})
    figures = analysis_figures(found)
    assert "; observer 2: 0°, 1.905 m" in figures["pressure"].axes[0].get_title(loc="left")
    silent = analysis_figures(found, 0)
    for name in ("spectrum", "pressure"):
        axes = silent[name].axes[0]
        assert not axes.lines and not axes.containers
        assert [text.get_text() for text in axes.texts] == ["nothing above -100 dB"]
    _, level = line(figures["directivity"], "total").get_data()
    assert level[1] == pytest.approx(float(oaspl_db(loud.total)[1]))


def test_levels_over_direction_can_be_a_weighted(line):
    found = analysis(ARC, broadband=True)
    figure = analysis_figures(found, a_weighted=True)["directivity"]
    frequency = np.concatenate([found.tones.frequency_hz, BANDS_HZ])
    power = np.concatenate(
        [mean_square(found.tones.total), np.asarray(found.broadband.total)], axis=1
    )
    expected = np.asarray(level_dba(frequency, power))
    floor = figure.axes[0].get_ylim()[0]
    assert_allclose(line(figure, "total").get_ydata(), np.maximum(expected, floor))
    assert "dBA" in [text.get_text() for text in figure.texts][0]


def test_every_group_has_its_own_figure_of_its_own_observers(line):
    """An arc is drawn of its own levels, whatever stands before it, and by rising elevation."""
    lone, falling = point(3.0, 0.0, 90.0), arc(2.0, [60.0, 0.0, -60.0])
    near, far = hemisphere(5.0, 45.0), hemisphere(9.0, 30.0)
    observers = np.concatenate([near, lone, ARC, far, falling])
    groups = (
        ObserverGroup("near", "hemisphere", len(near)),
        ObserverGroup("lone", "point", 1),
        ObserverGroup("first", "arc", 3),
        ObserverGroup("far", "hemisphere", len(far)),
        ObserverGroup("falling", "arc", 3),
    )
    found = analysis(observers, groups)
    figures = analysis_figures(found)
    assert set(figures) == {
        "spectrum", "pressure", "directivity", "directivity_2", "hemisphere", "hemisphere_2"
    }  # fmt: skip
    total = np.asarray(oaspl_db(found.tones.total))
    first = len(near) + 1
    angle, level = line(figures["directivity"], "total").get_data()
    assert_allclose(np.degrees(angle), [-45.0, 0.0, 45.0], atol=1e-9)
    assert_allclose(level, total[first : first + 3])
    angle, level = line(figures["directivity_2"], "total").get_data()
    assert_allclose(np.degrees(angle), [-60.0, 0.0, 60.0], atol=1e-9)
    assert_allclose(level, total[:-4:-1])
    for name, radius in (("hemisphere", 5), ("hemisphere_2", 9)):
        assert figures[name].axes[1].get_ylabel() == "OASPL, dB re 20 µPa"
        assert figures[name].texts[0].get_text() == f"blade, 4200 rpm, 8 m/s; {radius} m"


def test_observers_without_groups_are_an_arc_if_they_lie_on_one():
    assert "directivity" in analysis_figures(analysis(ARC))
    scattered = point([1.0, 2.0, 3.0], [-45.0, 0.0, 45.0])
    assert "directivity" not in analysis_figures(analysis(scattered))


def test_a_hemisphere_below_an_aircraft_is_named_from_its_nose():
    around = Surroundings(ground=20.0, level_flight=True)
    below = around.from_ground_axes(hemisphere(5.0, 45.0))
    groups = (ObserverGroup("below", "hemisphere", len(below)),)
    figures = analysis_figures(analysis(below, groups, surroundings=around))
    title = figures["hemisphere"].texts[0].get_text()
    assert title == "blade, 4200 rpm, 8 m/s; 5 m; azimuth from the nose"


def test_third_octaves_of_the_mechanisms_add_up_to_the_noise():
    found = analysis(ARC, broadband=True)
    levels = mechanism_levels(found, 1)
    assert list(levels)[:2] == ["total", "broadband"] and len(levels) == 2 + len(MECHANISMS)
    parts = np.array([levels[name.replace("_", " ")] for name in MECHANISMS])
    assert_allclose(10 * np.log10(np.sum(10 ** (parts / 10), axis=0)), levels["broadband"])
    assert_allclose(levels["total"], band_levels(analysis_sound(found), 1))

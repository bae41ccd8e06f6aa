"""Figures of tones with broadband noise show the numbers that they are given, without a display."""

from __future__ import annotations

import subprocess
import sys

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from matplotlib import colors
from matplotlib.figure import Figure

from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.acoustics.signals import Tones
from propmdao.figures import acoustic_plots, directivity
from propmdao.figures.acoustic_plots import SOURCE_COLORS, Heard

BANDS = third_octave_centers(50.0, 20e3)
ELEVATIONS = np.linspace(-90.0, 90.0, 13)
AZIMUTHS = np.linspace(0.0, 360.0, 25)
RATE = 48000


def sound(seed: int, bpf_hz: float) -> Heard:
    rng = np.random.default_rng(seed)
    fall = 1e-3 * 10.0 ** -np.arange(4.0)  # 20 dB from one harmonic to the next
    thickness, loading = (
        fall * (1.0 + rng.random((13, 4))) * np.exp(6j * rng.random((13, 4))) for _ in range(2)
    )
    tones = Tones(bpf_hz * jnp.arange(1.0, 5.0), jnp.asarray(thickness), jnp.asarray(loading))
    return Heard(tones, BANDS, 1e-7 * (1.0 + rng.random((13, 1))) * (BANDS / 1000.0) ** 0.3)


HEARD = {"before": sound(1, 140.0), "after": sound(2, 155.0)}
LEVELS = acoustic_plots.source_levels(HEARD["before"])
MEASURED = {"total": ([-45.0, 0.0], [60.0, 62.0])}


def figures() -> dict[str, Figure]:
    time = np.arange(RATE) / RATE
    records = {"total": 0.1 * np.sin(900.0 * time), "tones": 0.05 * np.cos(900.0 * time)}
    below = np.where(ELEVATIONS <= 0)[0]
    return {
        "spectrum": acoustic_plots.spectrum(HEARD, 3),
        "third_octaves": acoustic_plots.third_octaves(
            BANDS,
            {"total": acoustic_plots.band_levels(HEARD["before"], 3), "separation": BANDS * 0 + 20},
            {"total": ([125.0, 1000.0], [50.0, 45.0])},
        ),
        "pressure": acoustic_plots.pressure({"one": records, "two": records}, RATE, 0.02),
        "directivity": directivity.directivity(ELEVATIONS, LEVELS, MEASURED),
        "hemisphere_map": directivity.hemisphere_map(
            ELEVATIONS[below], AZIMUTHS, 60 - np.outer(below, np.cos(np.radians(AZIMUTHS)))
        ),
        "level_history": acoustic_plots.level_history(
            [0.0, 1.0, 2.0], {"total": [50.0, 60.0, 50.0]}, "level, dB", {"overhead": 1.0}
        ),
    }


@pytest.fixture(scope="module", name="figures")
def all_figures() -> dict[str, Figure]:
    return figures()


ALL = "spectrum third_octaves pressure directivity hemisphere_map level_history".split()


def line(figure: Figure, label: str, axes: int = 0):
    (found,) = (one for one in figure.axes[axes].lines if one.get_label() == label)
    return found


@pytest.mark.parametrize("name", ALL)
def test_figures_are_1200_pixels_wide_without_a_display(figures, name, tmp_path):
    figures[name].savefig(tmp_path / "figure.png")
    assert int.from_bytes((tmp_path / "figure.png").read_bytes()[16:20], "big") == 1200


@pytest.mark.parametrize("name", ALL)
def test_every_label_lies_inside_the_figure(figures, name):
    figure = figures[name]
    figure.draw_without_rendering()
    labels = [text for axes in figure.axes for text in (axes.xaxis.label, axes.yaxis.label)]
    if name not in ("pressure", "level_history"):  # theirs include some beyond the ends of the axis
        labels += [text for axes in figure.axes for text in axes.get_xticklabels()]
    labels = [text for text in (*labels, *figure.texts) if text.get_text()]
    for text in (*labels, *figure.legends):
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= figure.bbox.x1
        assert 0.0 <= box.y0 <= box.y1 <= figure.bbox.y1


@pytest.mark.parametrize("name", ALL)
def test_labels_do_not_lie_on_each_other(figures, name):
    figure = figures[name]
    figure.draw_without_rendering()
    for axes in figure.axes:
        axis = [text for text in (*axes.get_xticklabels(), axes.xaxis.label) if text.get_text()]
        boxes = [text.get_window_extent() for text in axis]
        boxes += [legend.get_window_extent() for legend in figure.legends]
        for i, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[:i])


@pytest.mark.parametrize("name", ["spectrum", "third_octaves", "pressure", "level_history"])
def test_axes_have_names_with_units(figures, name):
    figure = figures[name]
    assert all("," in axes.get_ylabel() for axes in figure.axes)
    assert figure.axes[-1].get_xlabel().rsplit(", ", 1)[1] in {"Hz", "ms", "s"}


def test_missing_matplotlib_is_one_line_that_says_what_to_install():
    for module in ("acoustic_plots", "directivity_plots"):
        code = f"import sys; sys.modules['matplotlib'] = None; import propmdao.{module}"
        run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
        last = run.stderr.splitlines()[-1]
        assert last.endswith("figures need matplotlib: pip install 'propmdao[plots]'")


def test_source_levels_add_energies_of_tones_and_noise():
    heard = HEARD["before"]
    tones, noise = oaspl_db(heard.tones.total), 10 * np.log10(heard.broadband.sum(axis=1) / 4e-10)
    assert_allclose(LEVELS["broadband"], noise)
    assert_allclose(LEVELS["loading"], oaspl_db(heard.tones.loading))
    assert_allclose(LEVELS["thickness"], oaspl_db(heard.tones.thickness))
    assert_allclose(10 ** (LEVELS["total"] / 10), 10 ** (tones / 10) + 10 ** (noise / 10))


def test_bands_hold_tones_and_noise():
    level = acoustic_plots.band_levels(HEARD["before"], 3)
    assert_allclose(10 * np.log10(np.sum(10 ** (level / 10))), LEVELS["total"][3])


def test_spectrum_and_its_third_octaves_have_the_same_energy(figures):
    for axes, heard in zip(figures["spectrum"].axes, HEARD.values(), strict=True):
        total = axes.lines[0].get_ydata()
        (bands,) = axes.patches
        levels = bands.get_data().values
        assert_allclose(levels, acoustic_plots.band_levels(heard, 3))
        narrow, wide = (10 * np.log10(np.sum(10 ** (np.asarray(q) / 10))) for q in (total, levels))
        assert narrow == pytest.approx(wide, abs=0.02)  # a bin across an edge belongs to one band


def test_third_octaves_leave_out_what_is_silent():
    figure = acoustic_plots.third_octaves(
        BANDS, {"loud": 0 * BANDS + 50.0, "silent": 0 * BANDS - 200.0}
    )
    assert [one.get_label() for one in figure.axes[0].lines] == ["loud"]


def test_measurements_are_dots_of_the_colour_of_their_line(figures):
    for name in ("third_octaves", "directivity"):
        computed, measured = (line(figures[name], label) for label in ("total", "total, measured"))
        assert computed.get_color() == measured.get_color()
        assert measured.get_marker() == "o"
    angle, level = line(figures["directivity"], "total, measured").get_data()
    assert_allclose(np.degrees(angle), MEASURED["total"][0])
    assert_allclose(level, MEASURED["total"][1])


def test_pressure_is_that_of_the_record(figures):
    time, p = line(figures["pressure"], "total").get_data()
    assert time[-1] == pytest.approx(20.0, abs=0.1)  # ms
    assert_allclose(p, 100.0 * np.sin(0.9 * time))  # mPa


def test_directivity_shows_every_source_and_keeps_silence_at_the_centre(figures):
    floor, _ = figures["directivity"].axes[0].get_ylim()
    for name, level in LEVELS.items():
        angle, drawn = line(figures["directivity"], name).get_data()
        assert_allclose(np.degrees(angle), ELEVATIONS)
        assert_allclose(drawn, np.maximum(level, floor))
    figure = directivity.directivity([0.0, 45.0], {"one": [50.0, -200.0]})
    drawn = line(figure, "one").get_ydata()
    assert_allclose(drawn, [50.0, figure.axes[0].get_ylim()[0]])


def test_map_has_straight_below_in_its_middle_and_turns_as_seen_from_below(figures):
    axes = figures["hemisphere_map"].axes[0]
    assert axes.get_ylim() == (-90.0, 0.0)
    assert axes.get_theta_direction() == -1
    assert axes.get_theta_offset() == pytest.approx(np.pi / 2)


def test_map_of_one_level_can_be_drawn():
    figure = directivity.hemisphere_map(
        np.linspace(-90.0, 0.0, 4), AZIMUTHS, np.full((4, 25), 60.0)
    )
    figure.draw_without_rendering()


def test_history_marks_moments(figures):
    assert_allclose(line(figures["level_history"], "total").get_ydata(), [50.0, 60.0, 50.0])
    assert_allclose(line(figures["level_history"], "overhead").get_xdata(), 1.0)


def test_a_source_has_one_colour_in_every_figure_and_nothing_else_has_it(figures):
    for name in ("third_octaves", "directivity", "pressure", "level_history"):
        for axes in figures[name].axes:
            for one in axes.lines:
                shown = colors.to_hex(one.get_color()).upper()
                label = str(one.get_label()).removesuffix(", measured")
                if label in SOURCE_COLORS:
                    assert shown == SOURCE_COLORS[label]
                else:
                    assert shown not in SOURCE_COLORS.values()

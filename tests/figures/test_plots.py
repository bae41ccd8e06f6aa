"""Figures show the numbers they are given, in one set of colours, without a display."""

from __future__ import annotations

import dataclasses
import subprocess
import sys

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from matplotlib import colors
from matplotlib.figure import Figure

from propmdao.acoustics.levels.decibels import oaspl_db, spl_db
from propmdao.acoustics.signals import Tones
from propmdao.figures import plots
from propmdao.formats.propellers import load_propeller

ELEVATIONS = np.linspace(-90.0, 90.0, 13)


def tones(seed: int, bpf_hz: float) -> Tones:
    rng = np.random.default_rng(seed)
    fall = 1e-3 * 10.0 ** -np.arange(4.0)  # 20 dB from one harmonic to the next
    thickness, loading = (
        fall * (1.0 + rng.random((13, 4))) * np.exp(6j * rng.random((13, 4))) for _ in range(2)
    )
    return Tones(bpf_hz * jnp.arange(1.0, 5.0), jnp.asarray(thickness), jnp.asarray(loading))


@pytest.fixture(scope="module")
def heard() -> dict[str, Tones]:
    return {"before": tones(1, 140.0), "after": tones(2, 155.0)}


@pytest.fixture(scope="module")
def propellers():
    before = load_propeller("apcsf_11x4.7_thesis")  # its thickness is that of its airfoils
    return {
        "before": before,
        "after": dataclasses.replace(before, airfoils=[(0.15, "naca6406"), (1.0, "naca4403")]),
    }


@pytest.fixture(scope="module")
def figures(heard, propellers) -> dict[str, Figure]:
    return {
        "convergence": plots.convergence([3.0, 2.0, np.nan], [1, 1, 0], "level, dB", {"start": 4}),
        "blades": plots.blades(propellers, (0.15, 0.5, 1.0)),
        "spectrum": plots.spectrum(heard, 3),
        "directivity": plots.directivity(heard, ELEVATIONS, -45.0),
        "pressure": plots.pressure(heard, 3),
    }


ALL = ("convergence", "blades", "spectrum", "directivity", "pressure")


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
    if name == "directivity":  # the one that is not laid out by matplotlib
        labels += figure.axes[0].get_xticklabels()
    labels = [text for text in (*labels, *figure.texts) if text.get_text()]
    for text in (*labels, *figure.legends):
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= figure.bbox.x1
        assert 0.0 <= box.y0 <= box.y1 <= figure.bbox.y1


def test_missing_matplotlib_is_one_line_that_says_what_to_install():
    code = "import sys; sys.modules['matplotlib'] = None; import propmdao.figures.plots"
    run = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True)
    last = run.stderr.splitlines()[-1]
    assert last.endswith("figures need matplotlib: pip install 'propmdao[plots]'")


def test_nothing_but_plots_needs_matplotlib():
    code = (
        "import sys; sys.modules['matplotlib'] = None;"
        "import propmdao.analysis.single_point, propmdao.components, propmdao.analysis.comparisons"
    )
    subprocess.run([sys.executable, "-c", code], check=True)


def test_best_line_is_that_of_feasible_designs():
    objective = [5.0, 1.0, 4.0, np.nan, 3.0, 3.5]
    feasible = [False, False, True, False, True, True]
    figure = plots.convergence(objective, feasible, "level, dB")
    best = line(figure, "best feasible").get_ydata()
    assert_allclose(best, [np.nan, np.nan, 4.0, 4.0, 3.0, 3.0])


def test_failed_and_infeasible_designs_are_marked_apart():
    figure = plots.convergence([5.0, 1.0, np.nan], [True, False, False], "level, dB")
    axes = figure.axes[0]
    marked = {dots.get_label(): dots.get_offsets().tolist() for dots in axes.collections}
    assert marked == {"feasible (1)": [[1.0, 5.0]], "violates a constraint (1)": [[2.0, 1.0]]}
    assert_allclose(line(figure, "analysis failed (1)").get_xdata(), [3.0])


def test_blades_pass_through_the_stations(propellers, figures):
    chord, angle, thickness, camber = figures["blades"].axes[:4]
    for name, propeller in propellers.items():
        for axes, values in ((chord, propeller.c_over_R), (angle, propeller.beta_deg)):
            (drawn,) = (one for one in axes.lines if one.get_label() == name)
            at_stations = np.interp(propeller.r_over_R, *drawn.get_data())
            assert_allclose(at_stations, values, rtol=3e-3)  # of a curve drawn in 200 points
    (after,) = (one for one in thickness.lines if one.get_label() == "after")
    assert_allclose(after.get_ydata()[[0, -1]], [0.06, 0.03], rtol=1e-3)
    (after,) = (one for one in camber.lines if one.get_label() == "after")
    assert_allclose(after.get_ydata()[[0, -1]], [0.06, 0.04], rtol=1e-3)


def test_given_thickness_replaces_that_of_the_airfoils(propellers):
    thick = dataclasses.replace(
        propellers["before"], thickness_over_chord=np.full_like(propellers["before"].c_over_R, 0.2)
    )
    figure = plots.blades({"thick": thick}, (0.5,))
    assert_allclose(line(figure, "thick", 2).get_ydata(), 0.2, rtol=1e-3)
    x, z = figure.axes[5].lines[0].get_data()
    n = x.size // 2
    assert_allclose((z[:n][::-1] - z[n:]).max(), 0.2, rtol=1e-12)


def test_planform_has_its_quarter_chord_on_the_radial_line(propellers, figures):
    r, y = line(figures["blades"], "before", 4).get_data()
    n = r.size // 2
    leading, trailing = y[:n], y[n:][::-1]
    assert_allclose(0.75 * leading + 0.25 * trailing, 0.0, atol=1e-15)


def test_spectrum_shows_the_levels_of_each_source(heard, figures):
    for axes, tone in zip(figures["spectrum"].axes, heard.values(), strict=True):
        shown = {stems.get_label(): stems.markerline for stems in axes.containers}
        for part in ("thickness", "loading", "total"):
            level = np.asarray(spl_db(getattr(tone, part)[3]))
            assert_allclose(shown[part].get_ydata(), level[level > axes.get_ylim()[0]])
            # Side by side, but nowhere near the next harmonic.
            n = shown[part].get_xdata().size
            offset = shown[part].get_xdata() - np.asarray(tone.frequency_hz)[:n]
            assert np.abs(offset).max() < 0.06 * tone.frequency_hz[0]


def test_directivity_shows_overall_levels_and_keeps_silence_at_the_centre(heard, figures):
    floor, _ = figures["directivity"].axes[0].get_ylim()
    for name, tone in heard.items():
        for part in ("thickness", "loading", "total"):
            angle, level = line(figures["directivity"], f"{name}, {part}").get_data()
            assert_allclose(np.degrees(angle), ELEVATIONS)
            assert_allclose(level, np.maximum(oaspl_db(getattr(tone, part)), floor))
    silent = Tones(jnp.array([100.0]), jnp.zeros((1, 1)), jnp.full((1, 1), 1e-3))
    figure = plots.directivity({"one": silent}, [0.0])
    assert_allclose(line(figure, "one, thickness").get_ydata(), figure.axes[0].get_ylim()[0])


def test_pressure_history_has_the_overall_level(heard, figures):
    for axes, tone in zip(figures["pressure"].axes, heard.values(), strict=True):
        (total,) = (one for one in axes.lines if one.get_label() == "total")
        rms = np.sqrt(np.mean((1e-3 * total.get_ydata()) ** 2))
        assert_allclose(20 * np.log10(rms / 20e-6), oaspl_db(tone.total[3]), atol=1e-9)


def test_a_source_has_one_colour_in_every_figure(figures):
    shown = {part: set() for part in plots.PART_COLORS}
    for name in ("directivity", "pressure", "spectrum"):
        for axes in figures[name].axes:
            lines = [(one.get_label(), one) for one in axes.lines]
            lines += [(stems.get_label(), stems.markerline) for stems in axes.containers]
            for label, one in lines:
                part = str(label).split(", ")[-1]
                if part in shown:
                    shown[part].add(colors.to_hex(one.get_color()).upper())
    assert shown == {part: {color} for part, color in plots.PART_COLORS.items()}

"""What all figures have in common: size, labels, colours; and what they need."""

from __future__ import annotations

import subprocess
import sys

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from matplotlib import colors
from matplotlib.text import Text

from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.figures.contents.palette import SOURCE_COLORS, line_colors, line_styles
from propmdao.figures.spectra import third_octaves
from propmdao.figures.style import literal, page, save
from propmdao.runtime.output_files import OutputError

SOUNDS = [
    "narrowband_spectrum", "narrowband_spectrum_of_tones", "third_octaves", "pressure_of_records",
    "directivity", "hemisphere_map", "level_history", "spectra_over_each_other",
    "spectra_of_tones_over_each_other",
]  # fmt: skip
ALL = [*SOUNDS, "blades", "convergence", "harmonic_spectrum", "pressure", "directivity_of_two"]
# Tick labels of these lie on each other or include some beyond the ends of the axis.
TICKS_UNKNOWN = {
    "blades", "convergence", "harmonic_spectrum", "pressure", "pressure_of_records", "level_history"
}  # fmt: skip


def test_every_figure_is_tested(figures):
    assert set(figures) == set(ALL)


@pytest.mark.parametrize("name", ALL)
def test_figures_are_1200_pixels_wide_without_a_display(figures, name, tmp_path):
    figures[name].savefig(tmp_path / "figure.png")
    assert int.from_bytes((tmp_path / "figure.png").read_bytes()[16:20], "big") == 1200


@pytest.mark.parametrize("name", ALL)
def test_every_label_lies_inside_the_figure(figures, name):
    figure = figures[name]
    figure.draw_without_rendering()
    labels = [text for axes in figure.axes for text in (axes.xaxis.label, axes.yaxis.label)]
    if name not in TICKS_UNKNOWN:
        labels += [text for axes in figure.axes for text in axes.get_xticklabels()]
    labels = [text for text in (*labels, *figure.texts) if text.get_text()]
    for text in (*labels, *figure.legends):
        box = text.get_window_extent()
        assert 0.0 <= box.x0 <= box.x1 <= figure.bbox.x1
        assert 0.0 <= box.y0 <= box.y1 <= figure.bbox.y1


@pytest.mark.parametrize("name", [*SOUNDS, "directivity_of_two"])
def test_labels_do_not_lie_on_each_other(figures, name):
    figure = figures[name]
    figure.draw_without_rendering()
    for axes in figure.axes:
        axis = [text for text in (*axes.get_xticklabels(), axes.xaxis.label) if text.get_text()]
        boxes = [text.get_window_extent() for text in axis]
        boxes += [legend.get_window_extent() for legend in figure.legends]
        for i, box in enumerate(boxes):
            assert not any(box.overlaps(other) for other in boxes[:i])


@pytest.mark.parametrize(
    "name",
    [
        "narrowband_spectrum",
        "third_octaves",
        "pressure",
        "pressure_of_records",
        "level_history",
        "spectra_over_each_other",
    ],  # fmt: skip
)
def test_axes_have_names_with_units(figures, name):
    figure = figures[name]
    assert all("," in axes.get_ylabel() for axes in figure.axes)
    assert figure.axes[-1].get_xlabel().rsplit(", ", 1)[1] in {"Hz", "ms", "s"}


def test_a_source_has_one_colour_in_every_figure_and_nothing_else_has_it(figures):
    shown = set()
    for name in (
        "harmonic_spectrum", "third_octaves", "pressure", "pressure_of_records", "directivity",
        "directivity_of_two", "level_history",
    ):  # fmt: skip
        for axes in figures[name].axes:
            lines = [(drawn.get_label(), drawn) for drawn in axes.lines]
            lines += [(stems.get_label(), stems.markerline) for stems in axes.containers]
            for label, drawn in lines:
                color = colors.to_hex(drawn.get_color()).upper()
                source = str(label).removesuffix(", measured").split(", ")[-1]
                if source in SOURCE_COLORS:
                    assert color == SOURCE_COLORS[source]
                    shown.add(source)
                elif not str(label).startswith("_"):  # the stems of a marker line, without a name
                    assert color not in SOURCE_COLORS.values()
    assert shown == set(SOURCE_COLORS)


def test_a_source_without_a_colour_of_its_own_has_none_of_the_others():
    given = line_colors(["thickness", "steady", "unsteady", "total"])
    assert len(set(given.values())) == 4
    assert not {given["steady"], given["unsteady"]} & set(SOURCE_COLORS.values())


def test_lines_differ_in_style_as_well_as_in_colour():
    sources = line_styles(["thickness", "loading", "broadband", "total"])
    assert len(set(sources.values())) == 4 and sources["total"] == "-"
    compared = line_styles(["old", "new", "newer", "newest"])
    assert len(set(compared.values())) == 4
    assert line_styles(["alone"]) == {"alone": "-"}


WITHOUT_MATPLOTLIB = """
import importlib, sys
sys.modules["matplotlib"] = None
import propmdao.analysis.single_point, propmdao.components, propmdao.analysis.comparisons
from propmdao.figures.contents import disk_loads, distributions, palette, sound, subjects
print("nothing but figures needs it")
for module in ("rotor.blades", "directivity", "of_analysis", "spectra"):
    try:
        importlib.import_module(f"propmdao.figures.{module}")
    except ImportError as error:
        print(error)
"""


def test_missing_matplotlib_is_one_line_that_says_what_to_install():
    """And nothing but figures needs it."""
    command = [sys.executable, "-c", WITHOUT_MATPLOTLIB]
    run = subprocess.run(command, capture_output=True, text=True, check=True)
    first, *said = run.stdout.splitlines()
    assert first == "nothing but figures needs it" and len(said) == 4
    for line in said:
        assert line.endswith("figures need matplotlib: pip install 'propmdao[plots]'")


@pytest.mark.parametrize("name", ["$5 blade", "x$\\frac{$y", "$a$ and $b$"])
def test_a_dollar_in_a_name_begins_no_formula(name, tmp_path):
    figure = page(2.0)
    axes = figure.subplots()
    axes.set_title(literal(name))
    axes.plot([0.0, 1.0], label=literal(name))
    legend = axes.legend()
    save(figure, tmp_path / "figure.png")
    for text in (axes.title, *legend.get_texts()):
        assert text._preprocess_math(text.get_text()) == (name, False)


def test_names_of_propellers_are_literal(tmp_path):
    name = "x$\\frac{$y at 4000 rpm"
    figure = third_octaves(BANDS_HZ, {name: np.full(len(BANDS_HZ), 40.0)}, title=name)
    save(figure, tmp_path / "figure.png")
    named = [text for text in figure.findobj(Text) if "frac" in text.get_text()]
    assert named
    assert all(text._preprocess_math(text.get_text()) == (name, False) for text in named)


def test_a_figure_that_cannot_be_written_leaves_the_old_one(tmp_path):
    file = tmp_path / "figure.png"
    file.write_text("old")

    class Broken:
        def savefig(self, path):
            path.write_text("half")
            raise OSError(28, "No space left on device")

    with pytest.raises(OutputError, match="No space left"):
        save(Broken(), file)
    assert file.read_text() == "old" and list(tmp_path.iterdir()) == [file]

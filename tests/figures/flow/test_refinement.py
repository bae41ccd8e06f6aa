"""Figures of a resolution show every result where it belongs."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from propmdao.figures.flow.refinement import refinement


def test_results_are_drawn_over_the_resolution():
    panels = {
        "thrust, N": {"coarse": [1.0, 2.0], "fine": [3.0, 4.0]},
        "level, dB": {"coarse": [50.0, 51.0], "fine": [52.0, 53.0]},
    }
    figure = refinement([5.0, 10.0], panels, "time step, deg", "a blade")
    for axes, (name, lines) in zip(figure.axes, panels.items(), strict=True):
        assert axes.get_ylabel() == name
        for line, values in zip(axes.lines, lines.values(), strict=True):
            np.testing.assert_array_equal(line.get_xydata(), np.transpose([[5.0, 10.0], values]))
    assert figure.axes[-1].get_xlabel() == "time step, deg"
    (legend,) = figure.legends
    assert [text.get_text() for text in legend.get_texts()] == ["coarse", "fine"]


def test_names_stand_at_equal_distances_and_one_line_has_no_legend():
    figure = refinement(["25 x 40", "65 x 100"], {"thrust, N": {"": [0.5, 0.6]}}, "mesh")
    (axes,) = figure.axes
    figure.canvas.draw()
    assert [text.get_text() for text in axes.get_xticklabels()] == ["25 x 40", "65 x 100"]
    assert not figure.legends


def test_rounding_is_not_drawn_as_a_change():
    figure = refinement([5.0, 10.0], {"thrust, N": {"": [0.5, 0.5 + 1e-10]}}, "time step, deg")
    low, high = figure.axes[0].get_ylim()
    assert high - low == pytest.approx(0.005, rel=0.01)

"""Figures of searches: what they show and what they bear."""

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.figures.designs import searches


def test_history_shows_all_designs_and_marks_those_that_meet_the_constraints():
    runs = {"one": ([45.0, np.nan, 41.0, 42.0], [0.0, np.inf, 1e-2, 1e-5]), "two": ([44.0], [0.3])}
    figure = searches.history(runs, "objective, dB", 1e-4)
    above, below = figure.axes
    line, met = above.get_lines()[:2]
    assert_allclose(line.get_ydata(), [45.0, np.nan, 41.0, 42.0])
    assert_allclose(met.get_xdata(), [1, 4])
    assert [text.get_text() for text in above.get_legend().get_texts()] == ["one: 42.00", "two"]
    assert_allclose(below.get_lines()[0].get_ydata()[0], 1e-7)  # none, on a logarithmic axis
    assert above.get_ylabel() == "objective, dB"


def test_scans_show_values_and_second_differences():
    position = np.linspace(0.0, 1.0, 11)
    lines = {"a": np.array([position**2, np.abs(position - 0.5)]), "b": np.ones((2, 11))}
    figure = searches.line_scans(position, lines, {"a": "a, dB", "b": "b, N m"})
    assert len(figure.axes) == 4
    parabola, kink = figure.axes[1].get_lines()
    assert_allclose(parabola.get_ydata(), 0.02, atol=1e-12)
    assert_allclose(kink.get_ydata().max(), 0.2)
    assert figure.axes[2].get_ylabel() == "b, N m"

"""Figures of sweeps show the numbers of the table over what was varied."""

from __future__ import annotations

import itertools

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.figures.contents.sweeps import SHOWN, varied_columns
from propmdao.figures.rotor.sweep_maps import sweep_maps


def rows(rpms, speeds):
    return [
        {"rpm": rpm, "speed": speed}
        | {name: (k + 1) * rpm / 1e4 - speed / 1e2 for k, name in enumerate(SHOWN)}
        for rpm, speed in itertools.product(rpms, speeds)
    ]


def test_lines_are_drawn_over_the_variable_of_most_values():
    table = rows((3000.0, 4000.0), (0.0, 8.0, 4.0))
    columns = varied_columns(table)
    assert columns == ("speed", "rpm")
    figure = sweep_maps(table, columns, "blade")
    for k, axes in enumerate(figure.axes):
        assert len(axes.lines) == 2
        for line, rpm in zip(axes.lines, (3000.0, 4000.0), strict=True):
            assert_allclose(line.get_xdata(), [0.0, 4.0, 8.0])
            expected = (k + 1) * rpm / 1e4 - np.array([0.0, 4.0, 8.0]) / 1e2
            assert_allclose(line.get_ydata(), expected)
        assert axes.get_ylabel() == [*SHOWN.values()][k]
    assert figure.axes[-1].get_xlabel() == "flight speed, m/s"
    styles = [line.get_linestyle() for line in figure.axes[0].lines]
    assert len(set(styles)) == 2


def test_many_values_of_both_are_a_map_in_which_failures_are_gaps():
    table = rows(np.linspace(3000.0, 6000.0, 7), np.linspace(0.0, 10.0, 6))
    columns = varied_columns(table)
    figure = sweep_maps(table[1:], columns, "blade")
    maps = [axes for axes in figure.axes if axes.get_title(loc="left")]
    assert [axes.get_title(loc="left") for axes in maps] == [*SHOWN.values()]
    assert maps[-1].get_xlabel() == "rotation speed, rpm"
    assert all(axes.get_ylabel() == "flight speed, m/s" for axes in maps)
    figure.draw_without_rendering()


def test_one_variable_is_a_line_and_a_result_that_is_the_same_everywhere_is_said():
    table = rows((3000.0, 4000.0), (8.0,))
    assert varied_columns(table) == ("rpm",)
    assert len(sweep_maps(table, ("rpm",)).axes[0].lines) == 1
    still = [
        {**row, "eta": 0.0} for row in rows(np.linspace(3e3, 6e3, 7), np.linspace(0.0, 1.0, 6))
    ]
    figure = sweep_maps(still, ("rpm", "speed"))
    texts = [text.get_text() for axes in figure.axes for text in axes.texts]
    assert "efficiency 0 everywhere" in texts


@pytest.mark.parametrize(
    ("points", "message"),
    [
        ([{"rpm": 3000.0}], "over one or two variables; 0 vary"),
        ([{"rpm": 1.0, "speed": 2.0}, {"rpm": 2.0, "speed": 3.0}], "need every combination"),
        (
            [{"rpm": 1.0, "speed": 2.0, "rho": 1.0}, {"rpm": 2.0, "speed": 3.0, "rho": 1.1}],
            "3 vary: rpm, speed, rho",
        ),
    ],
)
def test_what_no_figure_shows_is_refused(points, message):
    with pytest.raises(ValueError, match=message):
        varied_columns(points)

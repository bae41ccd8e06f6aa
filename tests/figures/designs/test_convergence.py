"""How a search converges: its designs and the best one so far."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.figures.designs.convergence import convergence


def test_best_line_is_that_of_feasible_designs(line):
    objective = [5.0, 1.0, 4.0, np.nan, 3.0, 3.5]
    feasible = [False, False, True, False, True, True]
    figure = convergence(objective, feasible, "level, dB")
    best = line(figure, "best feasible").get_ydata()
    assert_allclose(best, [np.nan, np.nan, 4.0, 4.0, 3.0, 3.0])


def test_failed_and_infeasible_designs_are_marked_apart(line):
    figure = convergence([5.0, 1.0, np.nan], [True, False, False], "level, dB")
    axes = figure.axes[0]
    marked = {dots.get_label(): dots.get_offsets().tolist() for dots in axes.collections}
    assert marked == {"feasible (1)": [[1.0, 5.0]], "violates a constraint (1)": [[2.0, 1.0]]}
    assert_allclose(line(figure, "analysis failed (1)").get_xdata(), [3.0])

"""Levels of a flyover over time."""

from __future__ import annotations

import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")


def test_history_shows_levels_and_marks_moments(figures, line):
    assert_allclose(line(figures["level_history"], "total").get_ydata(), [50.0, 60.0, 50.0])
    assert_allclose(line(figures["level_history"], "overhead").get_xdata(), 1.0)

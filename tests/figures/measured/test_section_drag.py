"""Drag of sections, measured over computed."""

from __future__ import annotations

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.figures.measured.section_drag import drag_ratios


def test_each_group_is_drawn_over_lift_in_all_axes():
    cl, slow = np.array([0.2, 0.5, 0.9]), np.array([True, False, True])
    ratios = {"before": np.array([1.2, 1.5, np.nan]), "after": np.array([1.0, 1.1, 0.9])}
    figure = drag_ratios(cl, {"slow": slow, "fast": ~slow}, ratios)
    assert [axes.get_title() for axes in figure.axes] == ["before", "after"]
    for axes, ratio in zip(figure.axes, ratios.values(), strict=True):
        lines = {line.get_label(): line for line in axes.lines}
        assert_allclose(lines["slow"].get_xdata(), cl[slow])
        assert_allclose(lines["slow"].get_ydata(), ratio[slow])
        assert_allclose(lines["fast"].get_ydata(), ratio[~slow])
    assert [text.get_text() for text in figure.legends[0].get_texts()] == ["slow", "fast"]

"""The figure of two models over each other."""

import pytest

pytest.importorskip("matplotlib", reason="matplotlib, an extra, is not installed")

from propmdao.figures.designs.agreement import agreement


def test_designs_lie_where_the_models_have_them():
    groups = {"all": ([1.0, 2.0], [1.5, 2.5]), "a few": ([3.0], [2.0])}
    figure = agreement({"torque, N m": groups, "tones, dB": groups}, ("lattice", "elements"))
    for axes in figure.axes:
        first, second, equal = axes.lines
        assert first.get_xydata().tolist() == [[1.0, 1.5], [2.0, 2.5]]
        assert second.get_label() == "a few (1)"
        assert equal.get_xydata().tolist() == [[1.0, 1.0], [3.0, 3.0]]
    assert figure.axes[0].get_xlabel() == "torque, N m, lattice"
    assert figure.axes[1].get_ylabel() == "tones, dB, elements"

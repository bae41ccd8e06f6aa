"""Drawn blades are those that are described."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from numpy.testing import assert_allclose

pytest.importorskip("matplotlib")

from propmdao.figures.rotor.blades import blade_comparison


def test_blades_pass_through_the_stations(propellers, figures, line):
    chord, angle, thickness, camber = range(4)
    for name, propeller in propellers.items():
        for axes, values in ((chord, propeller.c_over_R), (angle, propeller.beta_deg)):
            drawn = line(figures["blades"], name, axes)
            at_stations = np.interp(propeller.r_over_R, *drawn.get_data())
            assert_allclose(at_stations, values, rtol=3e-3)  # of a curve drawn in 200 points
    for axes, ends in ((thickness, [0.06, 0.03]), (camber, [0.06, 0.04])):
        drawn = line(figures["blades"], "after", axes)
        assert_allclose(drawn.get_ydata()[[0, -1]], ends, rtol=1e-3)


def test_given_thickness_replaces_that_of_the_airfoils(propellers, line):
    thick = dataclasses.replace(
        propellers["before"], thickness_over_chord=np.full_like(propellers["before"].c_over_R, 0.2)
    )
    figure = blade_comparison({"thick": thick}, (0.5,))
    assert_allclose(line(figure, "thick", 2).get_ydata(), 0.2, rtol=1e-3)
    x, z = figure.axes[5].lines[0].get_data()
    n = x.size // 2
    assert_allclose((z[:n][::-1] - z[n:]).max(), 0.2, rtol=1e-12)


def test_planform_has_its_quarter_chord_on_the_radial_line(figures, line):
    r, y = line(figures["blades"], "before", 4).get_data()
    n = r.size // 2
    leading, trailing = y[:n], y[n:][::-1]
    assert_allclose(0.75 * leading + 0.25 * trailing, 0.0, atol=1e-15)

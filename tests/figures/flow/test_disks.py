"""Maps of the disk show the loads of the blades where the blades are."""

from __future__ import annotations

import numpy as np
import pytest

pytest.importorskip("matplotlib")

from propmdao.figures.flow import disks
from propmdao.figures.of_analysis import analysis_figures


@pytest.fixture
def drawn(monkeypatch):
    """Function that returns what `disk_of_loads` maps."""

    def of(loads):
        kept = {}
        monkeypatch.setattr(disks, "disk_maps", lambda r, maps, title: kept.update(r=r, **maps))
        disks.disk_of_loads(loads)
        return kept

    return of


def test_thrust_over_the_disk_adds_up_to_that_of_the_blades(edgewise, drawn):
    loads, maps = edgewise.loads, drawn(edgewise.loads)
    thrust = maps["thrust of a blade per span, N/m"]
    assert thrust.shape == (8, 5)
    of_blade = thrust @ np.asarray(loads.strips.width)
    np.testing.assert_allclose(of_blade, loads.blade_force[:, 2], rtol=1e-12)
    # The advancing side, at azimuth 270, carries more.
    assert of_blade[6] > 1.2 * of_blade[2]
    angle = maps["effective angle of attack, deg"]
    np.testing.assert_allclose(np.radians(angle), loads.sections.angle_of_attack)
    np.testing.assert_array_equal(maps["r"], loads.strips.r_over_R)


def test_an_azimuth_is_drawn_where_it_is_and_flight_upward():
    r, azimuth = np.linspace(0.2, 1.0, 9), np.radians(np.arange(0.0, 360.0, 10.0))
    # Most at azimuth 270, the advancing side, and there at the tip.
    values = np.outer(1.0 - np.sin(azimuth), r)
    figure = disks.disk_maps(r, {"load, N/m": values}, "a rotor")
    axes, scale = figure.axes
    assert figure.texts[0].get_text() == "a rotor" and scale.get_xlabel() == "load, N/m"
    highest = axes.collections[0].get_paths()[-1].vertices
    where = highest[highest[:, 1] > 0.0]
    assert abs(np.degrees(where[:, 0].mean()) - 270.0) < 5.0 and where[:, 1].max() == 1.0
    figure.canvas.draw()
    corner = axes.transAxes.inverted()

    def place(azimuth_deg, radius=1.0):
        return corner.transform(axes.transData.transform((np.radians(azimuth_deg), radius)))

    np.testing.assert_allclose(place(0.0), [0.5, 1.0], atol=1e-9)  # flight is upward
    np.testing.assert_allclose(place(90.0), [0.0, 0.5], atol=1e-9)  # turning to the left there
    named = {text.get_text() for text in axes.texts} | {
        text.get_text() for text in axes.get_xticklabels()
    }
    assert {"flight", "90°\nretreating", "270°\nadvancing"} <= named
    assert "white line: 0" not in named  # no value is below 0


def test_zero_is_marked_where_loads_change_sign():
    values = np.outer(np.cos(np.radians(np.arange(0.0, 360.0, 30.0))), [0.5, 1.0])
    (axes, _) = disks.disk_maps([0.3, 1.0], {"load": values}).axes
    assert "white line: 0" in [text.get_text() for text in axes.texts]
    zero = axes.collections[1].get_paths()[0].vertices
    np.testing.assert_allclose(np.cos(zero[:, 0]), 0.0, atol=1e-9)


def test_an_analysis_at_an_incidence_has_a_map_without_observers(edgewise):
    figures = analysis_figures(edgewise)
    assert set(figures) == {"disk"}
    said = "apcsf_11x4.7, 4200 rpm, 8 m/s at an incidence of 80°; seen from the thrust's side"
    assert figures["disk"].texts[0].get_text() == said


def test_a_march_has_a_picture_of_its_wake(marched):
    figures = analysis_figures(marched)
    assert set(figures) == {"disk", "wake"}
    tip = figures["wake"].axes[0].lines[-2]
    nodes = np.asarray(marched.loads.wake)[1, -1]
    np.testing.assert_allclose(tip.get_xdata(), nodes[:, 0] / 0.1397)

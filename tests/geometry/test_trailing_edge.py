"""Thickness and angle of trailing edges: wedges, the report's NACA 0012, rounded edges."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION

X = CHORD_FRACTION


def edge_of(blade, thickness):
    """Thickness [chord] and angle [deg] of a section of this thickness over chord."""
    shape = jnp.asarray(np.tile(thickness / thickness.max(), (5, 1)))
    blade = dataclasses.replace(
        blade, thickness_shape=shape, thickness_over_chord=jnp.full(5, thickness.max())
    )
    span = span_interpolation(np.linspace(0.2, 1.0, 5), [0.7])
    edge, angle = trailing_edge(blade, span)
    return [float(edge[0]), float(np.degrees(angle[0]))]


@pytest.fixture(scope="module")
def blade(straight):
    return Blade.from_propeller(straight("naca0012"))


@pytest.mark.parametrize("angle", [-5.0, 0.0, 14.0, 40.0, 90.0])
@pytest.mark.parametrize("blunt", [0.0, 0.01])
def test_a_wedge_has_its_angle(blade, angle, blunt):
    wedge = 1.0 + blunt + 2.0 * np.tan(np.radians(angle / 2)) * (1.0 - X)
    wedge -= 1.0 * (X > 0.0)  # a nose that sets the scale
    wedge = np.where(X < 0.5, 1.0, wedge)
    assert_allclose(edge_of(blade, wedge), [blunt, angle], atol=1e-12)


def test_naca_0012_has_nearly_the_angle_of_the_report(blade):
    # RP-1218 gives 14 deg for its sharp one; the series' polynomial has 15.9 at its very end.
    thickness, angle = edge_of(blade, 0.12 * np.asarray(blade.thickness_shape[0]))
    assert thickness == pytest.approx(0.021 * 0.12, rel=1e-3)
    assert 14.0 < angle < 15.9


def test_described_edges_are_what_was_described(straight):
    propeller = dataclasses.replace(
        straight("naca0012"), trailing_edge_over_R=0.004, trailing_edge_angle_deg=[4, 6, 8, 10, 12]
    )
    described = Blade.from_propeller(propeller)
    span = span_interpolation(np.linspace(0.2, 1.0, 5), [0.7])
    edge, angle = trailing_edge(described, span)
    assert_allclose(edge, 0.004 / (span.smooth @ described.chord_over_R), rtol=1e-12)
    assert_allclose(np.degrees(angle), 9.0, rtol=1e-12)
    # A thicker section does not change a described edge.
    thicker = dataclasses.replace(described, thickness_over_chord=jnp.full(5, 0.3))
    assert_allclose(trailing_edge(thicker, span)[0], edge, rtol=1e-12)


@pytest.mark.parametrize("radius", [0.001, 0.002, 0.004])
def test_a_rounded_edge_has_the_angle_of_the_surfaces_ahead_of_it(blade, radius):
    """Half a circle on a plate: over its last 0.04 % of chord it is as steep as a wall."""
    plate = 2.0 * np.sqrt(np.maximum(radius**2 - np.maximum(X - 1.0 + radius, 0.0) ** 2, 0.0))
    plate = np.where(X < 0.5, 0.1, plate)
    steepest = np.degrees(np.arctan((plate[-2] - plate[-1]) / (X[-1] - X[-2])))
    thickness, angle = edge_of(blade, plate)
    assert thickness == 0.0 and steepest > 60.0
    assert abs(angle) < 1e-9


def test_derivatives(blade, assert_derivatives):
    span = span_interpolation(np.linspace(0.2, 1.0, 5), [0.3, 0.7, 0.95])
    assert_derivatives(lambda b: jnp.concatenate(trailing_edge(b, span)), blade)
    described = dataclasses.replace(
        blade, edge_over_R=jnp.full(5, 0.004), edge_angle=jnp.linspace(0.1, 0.2, 5)
    )
    chord_fixed = {"chord_over_R": blade.chord_over_R}  # the edge over chord is not linear in it
    assert_derivatives(
        lambda b: jnp.concatenate(trailing_edge(dataclasses.replace(b, **chord_fixed), span)),
        described,
    )

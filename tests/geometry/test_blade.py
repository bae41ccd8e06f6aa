"""The blade as arrays: what comes from the description, and reading between stations."""

from __future__ import annotations

import dataclasses

import jax
import numpy as np
import pytest

from propmdao.geometry.blade import Blade, design_lift_coefficient, span_interpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, naca4_camber_line
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.description import Propeller

R_OVER_R = np.array([0.2, 0.45, 0.7, 0.9, 1.0])


def propeller(airfoils: list[tuple[float, str]], **changes: object) -> Propeller:
    described = Propeller(
        name="test",
        diameter=0.3,
        n_blades=2,
        r_over_R=R_OVER_R,
        c_over_R=np.array([0.1, 0.2, 0.2, 0.15, 0.1]),
        beta_deg=np.array([40.0, 30.0, 20.0, 15.0, 10.0]),
        airfoils=airfoils,
    )
    return dataclasses.replace(described, **changes)  # type: ignore[arg-type]


def test_blade_holds_the_description_in_radians_and_metres() -> None:
    blade = Blade.from_propeller(propeller([(0.0, "naca4412")], sweep_over_R=0.01))
    assert float(blade.radius) == 0.15
    np.testing.assert_allclose(blade.beta, np.radians([40.0, 30.0, 20.0, 15.0, 10.0]))
    np.testing.assert_allclose(blade.sweep_over_R, 0.01)
    np.testing.assert_allclose(blade.rake_over_R, 0.0)


def test_shape_times_maximum_is_the_section() -> None:
    blade = Blade.from_propeller(propeller([(0.2, "e63"), (1.0, "clarky")]))
    root, tip = find_airfoil("e63"), find_airfoil("clarky")
    weight = ((R_OVER_R - 0.2) / 0.8)[:, None]
    np.testing.assert_allclose(
        blade.camber_over_chord[:, None] * blade.camber_shape,
        (1.0 - weight) * root.camber + weight * tip.camber,
        atol=1e-15,
    )
    np.testing.assert_allclose(
        blade.thickness_over_chord[:, None] * blade.thickness_shape,
        (1.0 - weight) * root.thickness + weight * tip.thickness,
        atol=1e-15,
    )
    np.testing.assert_allclose(np.max(blade.camber_shape, axis=1), 1.0)
    np.testing.assert_allclose(np.max(blade.thickness_shape, axis=1), 1.0)


def test_airfoils_are_held_constant_beyond_the_first_and_last() -> None:
    blade = Blade.from_propeller(propeller([(0.45, "naca2408"), (0.7, "naca6412")]))
    np.testing.assert_allclose(blade.camber_over_chord, [0.02, 0.02, 0.06, 0.06, 0.06], rtol=1e-4)


def test_given_thickness_scales_the_shape_and_leaves_the_camber() -> None:
    thickness = np.array([0.2, 0.15, 0.12, 0.1, 0.09])
    own = Blade.from_propeller(propeller([(0.0, "clarky")]))
    scaled = Blade.from_propeller(propeller([(0.0, "clarky")], thickness_over_chord=thickness))
    np.testing.assert_array_equal(scaled.thickness_over_chord, thickness)
    np.testing.assert_array_equal(scaled.thickness_shape, own.thickness_shape)
    np.testing.assert_array_equal(scaled.camber_over_chord, own.camber_over_chord)


def test_a_section_without_camber_can_be_given_some() -> None:
    blade = Blade.from_propeller(propeller([(0.0, "naca0010")]))
    np.testing.assert_array_equal(blade.camber_over_chord, 0.0)
    np.testing.assert_allclose(blade.camber_shape[2], naca4_camber_line(1.0, 0.4), atol=1e-3)


def test_design_lift_divided_by_that_of_the_shape_is_camber() -> None:
    blade = Blade.from_propeller(propeller([(0.0, "naca6412")]))
    lift = blade.camber_over_chord * design_lift_coefficient(blade.camber_shape)
    np.testing.assert_allclose(lift, 0.767, atol=1.2e-3)


def test_spline_is_exact_for_a_cubic_and_linear_for_a_line() -> None:
    radii = np.linspace(0.2, 1.0, 33)
    span = span_interpolation(R_OVER_R, radii)
    np.testing.assert_allclose(span.smooth @ R_OVER_R**3, radii**3, atol=1e-13)
    np.testing.assert_allclose(span.linear @ (1.0 - 2.0 * R_OVER_R), 1.0 - 2.0 * radii, atol=1e-13)
    np.testing.assert_array_equal(span.r_over_R, radii)


def test_stations_are_reproduced() -> None:
    span = span_interpolation(R_OVER_R, R_OVER_R)
    np.testing.assert_allclose(span.smooth, np.eye(5), atol=1e-14)
    np.testing.assert_allclose(span.linear, np.eye(5), atol=1e-14)


@pytest.mark.parametrize("stations", [[0.2, 1.0], [0.2, 0.5, 1.0]])
def test_two_or_three_stations_are_enough(stations: list[float]) -> None:
    span = span_interpolation(stations, [0.3, 0.8])
    np.testing.assert_allclose(span.smooth @ np.array(stations), [0.3, 0.8], atol=1e-14)


def test_nothing_is_extrapolated() -> None:
    with pytest.raises(ValueError, match=r"within the blade's stations 0\.2\.\.1; got 0\.1"):
        span_interpolation(R_OVER_R, [0.1, 0.5])


def test_blade_passes_through_jit() -> None:
    blade = Blade.from_propeller(propeller([(0.0, "naca4412")]))
    wider = jax.jit(lambda b: dataclasses.replace(b, chord_over_R=2.0 * b.chord_over_R))(blade)
    np.testing.assert_allclose(wider.chord_over_R, 2.0 * blade.chord_over_R)
    assert wider.camber_shape.shape == (5, CHORD_FRACTION.size)

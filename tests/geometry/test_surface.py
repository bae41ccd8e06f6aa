"""The blade's skin: closed, outward, of the right volume, smooth in every input."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial

import jax
import numpy as np
import pytest

from propmdao.geometry.blade import Blade, SpanInterpolation, span_interpolation
from propmdao.geometry.surface import (
    surface_interpolation,
    surface_nodes,
    surface_panels,
    surface_span,
)
from propmdao.propeller.airfoils.airfoil import naca4_from_name
from propmdao.propeller.description import Propeller
from propmdao.records.panels import Panels
from propmdao.runtime.compilation import compiled

R_OVER_R = np.array([0.2, 0.4, 0.6, 0.8, 1.0])


def skin(propeller: Propeller, n_contour: int = 65, n_span: int = 80) -> Panels:
    blade = Blade.from_propeller(propeller)
    span = surface_interpolation(propeller.r_over_R, n_span)
    return panels_of(blade, span, n_contour)


@partial(compiled, static_argnames="n_contour", optimisation=0)
def panels_of(blade: Blade, span: SpanInterpolation, n_contour: int) -> Panels:
    return surface_panels(surface_nodes(blade, span, n_contour))


def volume(panels: Panels) -> float:
    """Divergence theorem: a third of the sum of center . vector area."""
    return float((panels.center * panels.vector_area).sum()) / 3.0


def area_integral(propeller: Propeller) -> float:
    """Integral of the section area over the radius, by Gauss points in the span."""
    blade = Blade.from_propeller(propeller)
    points, weights = np.polynomial.legendre.leggauss(200)
    pieces = zip(R_OVER_R[:-1], R_OVER_R[1:], strict=True)
    radii, gauss = (
        np.concatenate(parts)
        for parts in zip(
            *((a + (b - a) * (points + 1) / 2, (b - a) / 2 * weights) for a, b in pieces),
            strict=True,
        )
    )
    span = span_interpolation(propeller.r_over_R, radii)
    angle = np.linspace(0.0, np.pi, blade.thickness_shape.shape[1])
    # Simpson's rule over chord angle: dx = sin(angle) / 2 d(angle).
    simpson = np.where(np.arange(angle.size) % 2, 4.0, 2.0) * (angle[1] / 3.0)
    simpson[[0, -1]] = angle[1] / 3.0
    per_station = np.asarray(blade.thickness_shape) @ (simpson * np.sin(angle) / 2.0)
    thickness = np.asarray(span.linear @ blade.thickness_over_chord)
    chord = np.asarray(span.smooth @ blade.chord_over_R)
    section = np.asarray(span.linear @ per_station) * thickness * chord**2
    return float((gauss * section).sum()) * float(blade.radius) ** 3


def test_contour_runs_from_the_trailing_edge_over_the_upper_side(
    straight: Callable[..., Propeller],
) -> None:
    propeller = straight("naca2412")
    span = surface_interpolation(R_OVER_R, 5)
    nodes = np.asarray(surface_nodes(Blade.from_propeller(propeller), span, 65))
    assert nodes.shape == (65, 5, 3)
    section = nodes[:, 2, 1:]
    np.testing.assert_allclose(section[32], [0.05, 0.0], atol=1e-15)  # leading edge toward +y
    np.testing.assert_allclose(section[[0, -1], 0], -0.15)
    assert (section[1:32, 1] > section[-2:32:-1, 1]).all()
    assert section[0, 1] - section[-1, 1] == pytest.approx(0.2 * 0.00252)


def test_nodes_on_the_shared_grid_are_the_section_itself(
    straight: Callable[..., Propeller],
) -> None:
    section = naca4_from_name("naca4412")
    span = surface_interpolation(R_OVER_R, 5)
    nodes = np.asarray(surface_nodes(Blade.from_propeller(straight("naca4412")), span, 161))
    upper, lower = nodes[80::-1, 0, 2], nodes[80:, 0, 2]
    np.testing.assert_allclose(upper, 0.2 * (section.camber + section.thickness / 2), atol=1e-16)
    np.testing.assert_allclose(lower, 0.2 * (section.camber - section.thickness / 2), atol=1e-16)


@pytest.mark.parametrize("n_contour", [64, 3])
def test_a_contour_without_leading_edge_is_refused(
    n_contour: int, straight: Callable[..., Propeller]
) -> None:
    with pytest.raises(ValueError, match=f"n_contour must be odd and at least 5; got {n_contour}"):
        skin(straight(), n_contour)


def test_a_single_contour_is_refused() -> None:
    with pytest.raises(ValueError, match="n_span must be at least 2; got 1"):
        surface_span(0.2, 1)


def test_every_piece_of_the_surface_is_there(twisted: Propeller) -> None:
    panels = skin(twisted, 65, 80)
    assert panels.center.shape == panels.vector_area.shape == (65 * 79 + 32 + 32, 3)


@pytest.mark.parametrize(("n_contour", "n_span"), [(5, 2), (33, 7), (65, 80)])
def test_surface_is_watertight(
    n_contour: int, n_span: int, straight: Callable[..., Propeller], twisted: Propeller
) -> None:
    for propeller in (straight("naca0012"), straight("e63", 30.0), twisted):
        area = np.asarray(skin(propeller, n_contour, n_span).vector_area)
        # Round-off: areas of panels 1e-3 long come from coordinates of order 1.
        np.testing.assert_allclose(area.sum(axis=0), 0.0, atol=1e-14 * np.abs(area).sum())


def test_caps_have_the_section_s_area_and_look_along_the_span(
    straight: Callable[..., Propeller],
) -> None:
    panels = skin(straight("naca0012", 20.0))
    root, tip = np.asarray(panels.vector_area[-64:-32]), np.asarray(panels.vector_area[-32:])
    # Area of a NACA 4-digit section: 0.6851 t/c c^2, the integral of its polynomial.
    exact = 10.0 * (0.2969 / 1.5 - 0.126 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1015 / 5)
    section = exact * 0.12 * 0.2**2
    np.testing.assert_allclose(root.sum(axis=0), [-section, 0.0, 0.0], rtol=2e-3, atol=1e-17)
    np.testing.assert_allclose(tip.sum(axis=0), [section, 0.0, 0.0], rtol=2e-3, atol=1e-17)


def test_untwisted_rectangular_blade_has_area_times_length(
    straight: Callable[..., Propeller],
) -> None:
    exact = 10.0 * (0.2969 / 1.5 - 0.126 / 2 - 0.3516 / 3 + 0.2843 / 4 - 0.1015 / 5)
    expected = exact * 0.12 * 0.2**2 * 0.8
    # A polygon inside the contour: short of it by (pi / 32)^2 / 6 = 1.6e-3.
    assert volume(skin(straight("naca4412", 35.0))) == pytest.approx(expected, rel=2e-3)


def test_volume_converges_to_the_integral_of_the_section_area(twisted: Propeller) -> None:
    expected = area_integral(twisted)
    error = [
        abs(volume(skin(twisted, n_contour, n_span)) - expected) / expected
        for n_contour, n_span in ((33, 40), (65, 80), (129, 160))
    ]
    assert error[0] < 1e-2
    # Second order in the panel size.
    assert error[1] < error[0] / 3.5
    assert error[2] < error[1] / 3.5


def test_normals_look_outward(straight: Callable[..., Propeller]) -> None:
    panels = skin(straight("naca0012"), 65, 11)
    area = np.asarray(panels.vector_area)
    # The section is symmetric about its chord: outward is away from z = 0, from the middle of the
    # chord at y = -c/4 and from the middle of the span.
    middle = np.array([0.6, -0.05, 0.0])
    outward = (np.asarray(panels.center) - middle) * area
    skin_only = np.linalg.norm(area, axis=1) > 1e-12
    assert (outward.sum(axis=1)[skin_only] > 0.0).all()


def test_upper_side_looks_toward_thrust(straight: Callable[..., Propeller]) -> None:
    panels = skin(straight("naca2412"), 65, 2)
    upper = np.asarray(panels.vector_area)[:32, 2]
    assert (upper[8:] > 0.0).all()


def test_sharp_trailing_edge_has_panels_without_area_and_finite_derivatives(
    straight: Callable[..., Propeller],
) -> None:
    blade = Blade.from_propeller(straight("e63"))
    span = surface_interpolation(R_OVER_R, 4)

    def total(b: Blade) -> jax.Array:
        return (surface_panels(surface_nodes(b, span, 9)).vector_area ** 2).sum()

    gradient = compiled(jax.grad(total), optimisation=0)(blade)
    for name, slope in vars(gradient).items():
        assert slope is None or np.isfinite(slope).all(), name


def test_derivatives_agree_with_differences(
    twisted: Propeller, assert_derivatives: Callable[..., None]
) -> None:
    span = surface_interpolation(R_OVER_R, 5)
    blade = Blade.from_propeller(twisted)
    assert_derivatives(lambda b: surface_nodes(b, span, 9), blade)
    assert_derivatives(lambda b: surface_panels(surface_nodes(b, span, 9)).vector_area, blade)


def test_surface_passes_through_jit(twisted: Propeller) -> None:
    span = surface_interpolation(R_OVER_R, 5)
    blade = Blade.from_propeller(twisted)
    compiled = jax.jit(lambda b: surface_panels(surface_nodes(b, span, 9)).center)(blade)
    plain = surface_panels(surface_nodes(blade, span, 9)).center
    np.testing.assert_allclose(compiled, plain, atol=1e-16)

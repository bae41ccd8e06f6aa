"""Corner points of the vortex lattice: on the camber surface, in the right place."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable

import jax
import numpy as np
import pytest

from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_chord_fraction,
    lattice_interpolation,
    lattice_nodes,
    lattice_span,
    strip_interpolation,
    strip_radii,
)
from propmdao.propeller.description import Propeller

R_OVER_R = np.array([0.2, 0.4, 0.6, 0.8, 1.0])
SPAN = lattice_interpolation(R_OVER_R, 12)


def nodes(blade: Blade, n_chordwise: int = 8) -> np.ndarray:
    return np.asarray(lattice_nodes(blade, SPAN, n_chordwise))


def quarter_chord(points: np.ndarray) -> np.ndarray:
    """Point a quarter of the way along the chord line; both ends lie on it (camber 0)."""
    return points[0] + 0.25 * (points[-1] - points[0])


def test_radii_run_from_root_to_tip_and_close_up_at_both() -> None:
    radii = lattice_span(0.2, 12)
    steps = np.diff(radii)
    assert radii[0] == 0.2
    assert radii[-1] == 1.0
    assert (steps > 0.0).all()
    assert steps.argmax() in (5, 6)
    np.testing.assert_allclose(steps, steps[::-1], rtol=1e-12)


def test_strips_lie_at_the_middle_of_the_cosine_angle() -> None:
    radii, edges = strip_radii(0.2, 12), lattice_span(0.2, 12)
    assert ((radii > edges[:-1]) & (radii < edges[1:])).all()
    np.testing.assert_allclose(radii, lattice_span(0.2, 24)[1::2], rtol=1e-14)


def test_interpolations_reach_the_edges_and_the_strips() -> None:
    np.testing.assert_array_equal(SPAN.r_over_R, lattice_span(0.2, 12))
    np.testing.assert_array_equal(strip_interpolation(R_OVER_R, 12).r_over_R, strip_radii(0.2, 12))


@pytest.mark.parametrize(
    ("root", "n", "message"),
    [(0.0, 8, "root_r_over_R must be above 0 and below 1; got 0"), (0.2, 0, "n_spanwise must")],
)
def test_impossible_spacing_is_refused(root: float, n: int, message: str) -> None:
    with pytest.raises(ValueError, match=message):
        lattice_span(root, n)


def test_rows_are_chordwise_and_columns_spanwise(twisted: Propeller) -> None:
    assert nodes(Blade.from_propeller(twisted)).shape == (9, 13, 3)


def test_nodes_lie_on_the_mean_line_of_naca_4412(straight: Callable[..., Propeller]) -> None:
    points = nodes(Blade.from_propeller(straight("naca4412")), 40)
    x = lattice_chord_fraction(40)
    camber = np.where(x < 0.4, 0.04 / 0.16 * (0.8 * x - x**2), 0.04 / 0.36 * (0.2 + 0.8 * x - x**2))
    # Chord 0.2 m at zero blade angle: leading edge at y = +c/4, camber along +z. The tolerance is
    # the spline's error beside the step of curvature at 0.4 c, 4e-6 of the chord.
    np.testing.assert_allclose(points[:, :, 1], 0.2 * (0.25 - x[:, None]) + 0.0 * points[0, :, 1])
    np.testing.assert_allclose(points[:, :, 2], 0.2 * camber[:, None] + np.zeros(13), atol=1e-6)
    np.testing.assert_allclose(points[:, :, 0], lattice_span(0.2, 12) + np.zeros((41, 1)))


def test_chord_edges_are_where_beta_puts_them(straight: Callable[..., Propeller]) -> None:
    points = nodes(Blade.from_propeller(straight(beta_deg=30.0)))
    along = points[-1] - points[0]
    expected = 0.2 * np.array([0.0, -np.cos(np.radians(30.0)), -0.5])
    np.testing.assert_allclose(along, np.broadcast_to(expected, along.shape), atol=1e-15)
    assert (points[0, :, 1] > 0.0).all()
    assert (points[0, :, 2] > 0.0).all()


def test_quarter_chord_lies_on_the_reference_line(straight: Callable[..., Propeller]) -> None:
    line = quarter_chord(nodes(Blade.from_propeller(straight("clarky", beta_deg=25.0))))
    np.testing.assert_allclose(line[:, 1:], 0.0, atol=1e-15)


def test_positive_sweep_is_aft_and_positive_rake_toward_thrust(
    straight: Callable[..., Propeller],
) -> None:
    propeller = straight(beta_deg=20.0)
    moved = dataclasses.replace(propeller, sweep_over_R=0.3 * R_OVER_R, rake_over_R=0.1 * R_OVER_R)
    change = nodes(Blade.from_propeller(moved)) - nodes(Blade.from_propeller(propeller))
    radii = lattice_span(0.2, 12) + np.zeros((9, 1))
    np.testing.assert_allclose(change[..., 0], 0.0, atol=1e-15)
    np.testing.assert_allclose(change[..., 1], -0.3 * radii, rtol=1e-12)
    np.testing.assert_allclose(change[..., 2], 0.1 * radii, rtol=1e-12)


def test_size_follows_the_radius(twisted: Propeller) -> None:
    small = Blade.from_propeller(twisted)
    large = dataclasses.replace(small, radius=3.0 * small.radius)
    np.testing.assert_allclose(nodes(large), 3.0 * nodes(small), rtol=1e-14)


def test_thickness_does_not_touch_the_lattice(twisted: Propeller) -> None:
    blade = Blade.from_propeller(twisted)
    thicker = dataclasses.replace(blade, thickness_over_chord=2.0 * blade.thickness_over_chord)
    np.testing.assert_array_equal(nodes(thicker), nodes(blade))


def test_derivatives_agree_with_differences(
    twisted: Propeller, assert_derivatives: Callable[..., None]
) -> None:
    blade = Blade.from_propeller(twisted)
    assert_derivatives(lambda b: lattice_nodes(b, SPAN, 4), blade)


def test_lattice_passes_through_jit(twisted: Propeller) -> None:
    blade = Blade.from_propeller(twisted)
    compiled = jax.jit(lattice_nodes, static_argnums=2)(blade, SPAN, 8)
    np.testing.assert_allclose(compiled, nodes(blade), atol=1e-16)

"""Prandtl-Glauert where the flow is attached, and the drag of the first shocks."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.mach import (
    DIVERGENCE_MARGIN,
    DRAG_RISE_LIMIT,
    MACH_LIMIT,
    attached_share,
    beyond_critical,
    drag_rise,
    prandtl_glauert,
)
from propmdao.aerodynamics.sections.polars.table import PolarTable, section_coefficients


def shock_drag(mach: Any, alpha: jax.Array, cl: jax.Array, thickness: jax.Array) -> jax.Array:
    return attached_share(alpha) * drag_rise(beyond_critical(mach, thickness), cl)


def test_attached_lift_rises_by_prandtl_glauert() -> None:
    assert float(prandtl_glauert(0.6, jnp.array(0.1))) == pytest.approx(1.25)


def test_no_correction_without_speed_or_in_separated_flow() -> None:
    alpha = jnp.radians(jnp.array([-150.0, -60.0, 30.0, 90.0]))
    np.testing.assert_array_equal(prandtl_glauert(0.5, alpha), 1.0)
    np.testing.assert_array_equal(prandtl_glauert(0.0, jnp.linspace(-3.0, 3.0, 9)), 1.0)


def test_the_correction_is_held_at_the_limit() -> None:
    at_limit = 1.0 / np.sqrt(1.0 - MACH_LIMIT**2)
    assert float(prandtl_glauert(5.0, jnp.array(0.0))) == pytest.approx(at_limit)


@pytest.mark.parametrize("mach", [0.0, MACH_LIMIT - 0.05, MACH_LIMIT])
def test_c1_in_mach(mach: float) -> None:
    slope = jax.grad(lambda m: prandtl_glauert(m, jnp.array(0.05)))
    assert float(slope(mach + 1e-8)) == pytest.approx(float(slope(mach - 1e-8)), abs=1e-6)


@pytest.mark.parametrize("alpha_deg", [12.0, 30.0, -12.0, 90.0, 150.0])
def test_c1_in_angle(alpha_deg: float) -> None:
    slope = jax.grad(lambda a: prandtl_glauert(0.6, a))
    alpha = jnp.radians(alpha_deg)
    assert float(slope(alpha + 1e-8)) == pytest.approx(float(slope(alpha - 1e-8)), abs=1e-5)


def test_lift_and_moment_are_corrected_and_drag_rises(section: Callable[..., PolarTable]) -> None:
    alpha, re, table = jnp.radians(jnp.array([3.0])), jnp.array([1e5]), section("clarky")
    slow = section_coefficients(table, alpha, re)
    fast = section_coefficients(table, alpha, re, 0.6)
    np.testing.assert_allclose(np.ravel(fast[::2]) / np.ravel(slow[::2]), 1.25)
    assert table.thickness is not None
    shocks = shock_drag(0.6, alpha, fast[0], table.thickness)
    assert float(shocks[0]) > 1e-5
    np.testing.assert_allclose(fast[1] - slow[1], shocks, rtol=1e-9)
    without = dataclasses.replace(table, thickness=None)
    np.testing.assert_array_equal(section_coefficients(without, alpha, re, 0.6)[1], slow[1])


def rise(mach: Any, cl: float = 0.5, thickness: float = 0.12, alpha_deg: float = 2.0) -> jax.Array:
    return shock_drag(mach, jnp.radians(alpha_deg), jnp.array(cl), jnp.array(thickness))


def divergence(cl: float, thickness: float) -> float:
    """Korn's Mach number; a lift coefficient of 0.5 is the same within 0.0003 without its sign."""
    return 0.87 - thickness - 0.1 * abs(cl)


@pytest.mark.parametrize(("cl", "thickness"), [(0.5, 0.12), (-0.5, 0.12), (0.8, 0.09), (0.4, 0.18)])
def test_drag_diverges_where_korn_says_with_the_slope_of_lock(cl: float, thickness: float) -> None:
    mach = divergence(cl, thickness)
    slope = jax.grad(lambda m: rise(m, cl, thickness))
    assert float(slope(mach)) == pytest.approx(0.1, rel=0.01)
    # 20 (0.1/80)^(4/3): some 27 counts at divergence.
    assert float(rise(mach, cl, thickness)) == pytest.approx(0.00269, rel=0.02)
    assert float(rise(mach - DIVERGENCE_MARGIN - 0.001, cl, thickness)) == 0.0


def test_thick_and_lifting_sections_rise_first_and_separated_ones_not_at_all() -> None:
    assert 0.0 < rise(0.7, thickness=0.09) < rise(0.7, thickness=0.12) < rise(0.7, thickness=0.15)
    assert 0.0 < rise(0.7, cl=0.2) < rise(0.7, cl=0.5) == rise(0.7, cl=-0.5)
    assert float(rise(0.7, alpha_deg=30.0)) == 0.0 == float(rise(0.0))


def test_drag_rise_is_held_at_its_limit() -> None:
    held = 20.0 * (DRAG_RISE_LIMIT - divergence(0.5, 0.12) + DIVERGENCE_MARGIN) ** 4
    assert float(rise(5.0)) == pytest.approx(held, rel=0.01)


@pytest.mark.parametrize("mach", [0.592, DRAG_RISE_LIMIT - 0.05, DRAG_RISE_LIMIT])
def test_drag_rise_is_c1_in_all_it_depends_on(mach: float) -> None:
    gradient = jax.grad(lambda x: shock_drag(*x))
    for cl, alpha_deg in ((0.5, 2.0), (0.0, 12.0), (0.3, 30.0)):
        at = jnp.array([mach, np.radians(alpha_deg), cl, 0.12])
        below, above = gradient(at - 1e-8), gradient(at + 1e-8)
        np.testing.assert_allclose(below, above, atol=1e-5)
        step = 1e-6 * jnp.eye(4)
        difference = [
            (shock_drag(*(at + d)) - shock_drag(*(at - d))) / 2e-6 for d in step
        ]  # fmt: skip
        np.testing.assert_allclose(gradient(at), difference, atol=1e-5)

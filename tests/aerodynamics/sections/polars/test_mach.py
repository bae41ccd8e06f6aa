"""Prandtl-Glauert where the flow is attached."""

from __future__ import annotations

from collections.abc import Callable

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.mach import MACH_LIMIT, prandtl_glauert
from propmdao.aerodynamics.sections.polars.table import PolarTable, section_coefficients


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


def test_lift_and_moment_are_corrected_drag_is_not(section: Callable[..., PolarTable]) -> None:
    alpha, re = jnp.radians(jnp.array([3.0])), jnp.array([1e5])
    slow = section_coefficients(section("clarky"), alpha, re)
    fast = section_coefficients(section("clarky"), alpha, re, 0.6)
    np.testing.assert_allclose(np.ravel(fast) / np.ravel(slow), [1.25, 1.0, 1.25])

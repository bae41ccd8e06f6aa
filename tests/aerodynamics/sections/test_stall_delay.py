"""Stall delay: its limits, and Du and Selig's formula at a point worked out by hand."""

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.stall_delay import delay_factor, delayed_stall


def test_factor_by_hand():
    # c/r = 0.5 at half radius, Lambda = 1: 0.5^2 = 0.25, 1.6 * 0.5 / 0.1267 * 0.75 / 1.25 = 3.7885.
    factor = float(delay_factor(jnp.array(0.5), jnp.array(0.5), 1.0))
    assert factor == pytest.approx((3.7885 - 1.0) / (2.0 * np.pi), rel=1e-3)


def test_factor_is_never_negative_and_grows_toward_the_hub():
    r = jnp.linspace(0.15, 1.0, 40)
    factor = delay_factor(0.1 / r, r, 0.9)
    assert (factor > 0.0).all() and (np.diff(factor) < 0.0).all()
    assert delay_factor(jnp.array(0.02), jnp.array(1.0), 1.0) < 2e-3


def test_potential_lift_and_no_factor_are_left_alone():
    alpha, zero = jnp.radians(jnp.array([-10.0, 4.0, 12.0])), jnp.radians(jnp.full(3, -3.0))
    potential = 2.0 * jnp.pi * jnp.sin(alpha - zero)
    cd = jnp.full(3, 0.02)
    for cl, factor in ((potential, 0.4), (0.5 * potential, 0.0)):
        held, drag = delayed_stall(cl, cd, alpha, zero, jnp.full(3, factor))
        np.testing.assert_allclose(held, cl, rtol=1e-12)
        np.testing.assert_allclose(drag, cd, rtol=1e-12)


def test_what_is_added_acts_normal_to_the_chord():
    alpha, none = jnp.radians(jnp.array([18.0])), jnp.zeros(1)
    cl, cd = delayed_stall(jnp.array([1.0]), jnp.array([0.2]), alpha, none, jnp.array([0.5]))
    lift, drag = float(cl[0]) - 1.0, float(cd[0]) - 0.2
    along_chord = drag * np.cos(alpha[0]) - lift * np.sin(alpha[0])
    assert lift > 0.1 and abs(along_chord) < 1e-12


def test_deep_stall_is_that_of_two_dimensions():
    alpha = jnp.radians(jnp.array([55.0, 120.0, -170.0]))
    cl, cd = delayed_stall(jnp.ones(3), jnp.ones(3), alpha, jnp.zeros(3), jnp.full(3, 0.5))
    np.testing.assert_array_equal(cl, 1.0)
    np.testing.assert_array_equal(cd, 1.0)

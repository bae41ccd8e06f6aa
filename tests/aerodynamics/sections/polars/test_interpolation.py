"""Cubic stencils: exact where they must be, C1, held at the ends."""

from __future__ import annotations

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.interpolation import (
    MARGIN,
    clamped_stencil,
    dense,
    periodic_cubic,
    periodic_slopes,
)
from propmdao.runtime.compilation import compiled

NODES = jnp.array([0.0, 0.3, 1.0, 1.4, 2.5])
ANGLES = jnp.linspace(-jnp.pi, jnp.pi, 41) + 0.05 * jnp.sin(jnp.linspace(-jnp.pi, jnp.pi, 41))


@partial(compiled, optimisation=0)
def interpolated(values: jax.Array, x: jax.Array) -> jax.Array:
    return dense(*clamped_stencil(NODES, jnp.atleast_1d(x)), NODES.size) @ values


def test_nodes_are_met_and_parabolas_are_exact_between_inner_nodes() -> None:
    # The slope at a node is that of the parabola through it and its neighbours.
    np.testing.assert_allclose(interpolated(jnp.cos(NODES), NODES), jnp.cos(NODES), atol=1e-14)
    x = jnp.linspace(NODES[1], NODES[3], 20)
    np.testing.assert_allclose(interpolated(3.0 - NODES**2, x), 3.0 - x**2, atol=1e-14)


def test_a_straight_line_is_exact_up_to_the_ends() -> None:
    x = jnp.linspace(NODES[0], NODES[-1], 50)
    np.testing.assert_allclose(interpolated(2.0 * NODES - 1.0, x), 2.0 * x - 1.0, atol=1e-14)


@partial(compiled, optimisation=0)
@jax.vmap
@jax.grad
def slope_of_sine(x: jax.Array) -> jax.Array:
    return interpolated(jnp.sin(3.0 * NODES), x)[0]


@pytest.mark.parametrize("node", NODES.tolist())
def test_the_slope_is_the_same_on_both_sides_of_a_node(node: float) -> None:
    left, right = slope_of_sine(node + jnp.array([-1e-7, 1e-7]))
    assert float(left) == pytest.approx(float(right), abs=1e-5)  # second derivatives are below 30


def test_arguments_outside_are_held_within_a_margin() -> None:
    line = NODES
    far = interpolated(line, jnp.array([-1e3, 1e3]))
    np.testing.assert_allclose(far, [-MARGIN * 0.3, 2.5 + MARGIN * 1.1], atol=1e-12)


def around(values: jax.Array, angle: jax.Array) -> jax.Array:
    index, (by_value, by_slope) = periodic_cubic(ANGLES, angle)
    slopes = periodic_slopes(ANGLES, values)
    return (by_value * values[index] + by_slope * slopes[index]).sum(axis=1)


def test_slopes_over_a_turn_are_those_of_parabolas() -> None:
    # Of a parabola they are exact, but at the ends of the turn, where this one has a kink.
    slopes = periodic_slopes(ANGLES, jnp.stack([ANGLES**2, 0.0 * ANGLES + 2.0]))
    np.testing.assert_allclose(slopes[0, 1:-1], 2.0 * ANGLES[1:-1], atol=1e-12)
    np.testing.assert_allclose(slopes[0, [0, -1]], 0.0, atol=1e-12)
    np.testing.assert_array_equal(slopes[1], 0.0)


def test_angles_repeat_every_turn() -> None:
    values = jnp.sin(ANGLES - 0.3)
    x = jnp.linspace(-3.0, 3.0, 37)
    first, turned = (around(values, angle) for angle in (x, x + 4.0 * jnp.pi))
    np.testing.assert_allclose(first, turned, atol=1e-13)
    # Largest step 0.165 rad: slopes from parabolas err by h^2/6, values by h/4 of that.
    np.testing.assert_allclose(first, jnp.sin(x - 0.3), atol=2e-4)


def test_the_slope_is_continuous_across_the_turn() -> None:
    values = jnp.sin(ANGLES - 0.3)

    def value(angle: jax.Array) -> jax.Array:
        return around(values, angle[None])[0]

    left, right = jax.vmap(jax.grad(value))(jnp.pi + jnp.array([-1e-7, 1e-7]))
    assert float(left) == pytest.approx(float(right), abs=1e-5)

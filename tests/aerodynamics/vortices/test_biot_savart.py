"""Straight segments, filaments and the vortex core against closed forms."""

from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.vortices.biot_savart import (
    _kernel,
    filament_velocities,
    segment_velocities,
)
from propmdao.runtime.compilation import compiled

TINY_CORE = 1e-6
velocities_of = compiled(segment_velocities, optimisation=0)


def polygon(n, radius=1.0):
    angle = 2 * np.pi * np.arange(n + 1) / n
    return jnp.asarray(radius * np.stack([np.cos(angle), np.sin(angle), 0 * angle], axis=-1))


def axis_points(z):
    return jnp.asarray(np.stack([0 * z, 0 * z, z], axis=-1))


def of_ring(n, z):
    nodes = polygon(n)
    each = velocities_of(axis_points(z), nodes[None, :-1], nodes[None, 1:], TINY_CORE)
    return each.sum(axis=1).T


def test_polygon_ring_on_its_axis_is_the_closed_form():
    # One side of an n-gon in the unit circle: half length s, apothem a, distance h from the point.
    n, z = 7, np.array([-2.0, -0.3, 0.0, 0.5, 4.0])
    s, a = np.sin(np.pi / n), np.cos(np.pi / n)
    h = np.hypot(a, z)
    axial = n * a / h * 2 * s / (4 * np.pi * h * np.hypot(h, s))
    velocity = of_ring(n, z)
    np.testing.assert_allclose(velocity[:, 2], axial, rtol=1e-12)
    np.testing.assert_allclose(velocity[:, :2], 0.0, atol=1e-14)


def test_polygon_ring_converges_to_the_circle_with_second_order():
    z = np.array([0.0, 0.7])
    circle = 1.0 / (2.0 * (1.0 + z**2) ** 1.5)
    error = [np.abs(of_ring(n, z)[:, 2] - circle).max() for n in (20, 40, 80)]
    orders = np.log2(np.array(error[:-1]) / np.array(error[1:]))
    np.testing.assert_allclose(orders, 2.0, atol=0.02)


def test_filament_is_the_sum_of_its_segments():
    key = np.random.default_rng(1)
    nodes = jnp.asarray(key.normal(size=(3, 2, 6, 3)))
    points = jnp.asarray(key.normal(size=(4, 3)))
    by_segment = np.stack(
        [velocities_of(points, chains[:, :-1], chains[:, 1:], 0.1).sum(axis=1) for chains in nodes],
        axis=1,
    )
    start, end = (x.reshape(3, -1, 3) for x in (nodes[:, :, :-1], nodes[:, :, 1:]))
    filaments = filament_velocities(points, start, end, jnp.full(10, 0.1))
    np.testing.assert_allclose(filaments, by_segment, rtol=1e-10)


def test_core_of_a_long_line_is_vatistas_n_2():
    core, h, half = 0.1, np.array([0.01, 0.1, 1.0]), 100.0
    points = jnp.asarray(np.stack([h, 0 * h, 0 * h], axis=-1))
    ends = jnp.asarray([[[0.0, 0.0, -half]]]), jnp.asarray([[[0.0, 0.0, half]]])
    velocity = velocities_of(points, *ends, core)[:, 0].T
    swirl = h / (2 * np.pi * np.sqrt(h**4 + core**4)) * half / np.hypot(half, h)
    np.testing.assert_allclose(velocity[:, 1], swirl, rtol=1e-7)


@partial(compiled, optimisation=0)
def on_the_line(point, start, end):
    """Velocity at a point and its derivatives by the place."""

    def velocity(point):
        return velocities_of(point[None], start, end, 1e-4)[:, 0, 0]

    return velocity(point), jax.jacobian(velocity)(point)


@pytest.mark.parametrize("x", [0.3, 0.5, 1.7])
def test_segment_induces_nothing_on_its_own_line_and_its_derivative_is_finite(x):
    start, end = jnp.array([[[0.0, 0.0, 0.0]]]), jnp.array([[[1.0, 0.0, 0.0]]])

    velocity, slopes = on_the_line(jnp.array([x, 0.0, 0.0]), start, end)
    np.testing.assert_allclose(velocity, 0.0, atol=1e-12)
    assert np.isfinite(slopes).all()


def test_derivative_of_the_kernel_is_that_of_its_arithmetic():
    key = np.random.default_rng(2)
    at = tuple(jnp.asarray(key.normal(size=(3, n))) for n in (7, 5, 5)) + (jnp.full(5, 0.3),)
    along = tuple(jnp.asarray(key.normal(size=x.shape)) for x in at)
    exact, by_steps = compiled(
        lambda at, along: [jax.jvp(f, at, along) for f in (_kernel, _kernel.fun)], optimisation=0
    )(at, along)
    np.testing.assert_allclose(exact[0], by_steps[0], rtol=1e-13)
    np.testing.assert_allclose(exact[1], by_steps[1], rtol=1e-11)

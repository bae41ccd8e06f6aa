"""Boundary layers of a section's own: thicknesses, sides, trips, and where laminar layers shed."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.broadband.section_layers import layer_of_sections
from propmdao.records.loads import EdgeSide
from propmdao.runtime.compilation import compiled

CHORD = 0.1


def side(momentum=0.004, shape=1.5, transition=0.3):
    return EdgeSide(*map(jnp.asarray, (momentum, shape, transition, 0.95)))


def layer(degrees=5.0, upper=None, lower=None):
    sides = upper or side(), lower or side(0.002, 2.0)
    return layer_of_sections(CHORD, jnp.radians(jnp.asarray(degrees)), *sides)


def test_thicknesses_follow_from_momentum_thickness_and_shape():
    got = layer()
    assert_allclose(got.momentum_suction, 0.004 * CHORD, rtol=1e-6)
    assert_allclose(got.displacement_suction, 1.5 * 0.004 * CHORD, rtol=1e-6)
    assert_allclose(got.displacement_pressure, 2.0 * 0.002 * CHORD, rtol=1e-6)
    # theta (3.15 + 1.72 / (H - 1)) + delta*
    assert_allclose(got.thickness_pressure, 0.002 * CHORD * (3.15 + 1.72 + 2.0), rtol=1e-6)


def test_a_laminar_layer_on_a_plate_is_about_as_thick_as_blasius_has_it():
    # delta is 7.5 theta where the speed is 99 % of that outside, and delta* is 2.59 theta.
    got = layer(upper=side(0.001, 2.59))
    assert float(got.thickness_suction / got.momentum_suction) == pytest.approx(7.5, rel=0.1)


def test_lift_tells_the_suction_side():
    up, down = layer(5.0), layer(-5.0)
    assert_allclose(up.displacement_suction, down.displacement_pressure)
    middle = layer(0.0)
    assert_allclose(middle.momentum_suction, 0.003 * CHORD)
    assert_allclose(middle.momentum_pressure, middle.momentum_suction)


@pytest.mark.parametrize(
    ("shape", "transition", "degrees", "share"),
    [
        (7.0, 1.0, 5.0, 1.0),  # a laminar layer that has separated
        (4.0, 0.9, 5.0, 1.0),
        (2.59, 1.0, 5.0, 0.0),  # laminar, attached: waves do not grow
        (3.295, 1.0, 5.0, 0.5),
        (7.0, 0.85, 5.0, 0.5),
        (7.0, 0.8, 5.0, 0.0),  # turbulent
        (7.0, 1.0, -5.0, 0.0),  # the lower side is the suction side: it does not count
    ],
)
def test_laminar_layers_shed_where_they_separate_on_the_pressure_side(
    shape, transition, degrees, share
):
    lower = side(0.002, shape, transition)
    assert_allclose(layer(degrees, lower=lower).shedding, share, atol=1e-12)


def test_nothing_jumps_and_derivatives_are_those_of_the_values():
    @jax.vmap
    def with_slopes(t):
        return values(t), jax.jacfwd(values)(t)

    def values(t):
        moving = side(0.002 + 0.001 * t, 1.2 + 8.0 * t, 0.7 + 0.4 * t)
        return jnp.stack(jax.tree.leaves(layer(1.0 - 2.0 * t, lower=moving)))

    along = np.linspace(0.0, 1.0, 4001)
    traced, slope = map(np.asarray, compiled(with_slopes, optimisation=0)(along))
    largest = np.abs(slope).max(axis=0)
    numeric = (traced[2:] - traced[:-2]) / (along[2:] - along[:-2])[:, None]
    assert np.all(np.abs(slope[1:-1] - numeric) < 0.01 * largest)
    assert np.all(np.abs(np.diff(slope, axis=0)) < 0.05 * largest)

"""Closed forms, symmetries and derivatives of one airfoil's self-noise."""

from __future__ import annotations

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import Radiation, moving_radiation, radiation
from propmdao.acoustics.broadband.self_noise import (
    third_octave_centers,
    tip_noise,
    trailing_edge_noise,
)
from propmdao.acoustics.levels.decibels import level_db
from propmdao.records.air import Air
from propmdao.runtime.compilation import compiled

C, NU = 340.0, 1.5e-5
AIR = Air(density=1.2, sound_speed=C, dynamic_viscosity=1.2 * NU)
BANDS = third_octave_centers(200, 20e3)


@partial(compiled, static_argnames="trip", optimisation=0)
def noise(section, trip="none", sight=(0.3, 0.2, 1.0), layer=None, bands=BANDS):
    if layer is None:
        layer = boundary_layer(section.chord, section.speed, section.angle_of_attack, NU, trip)
    toward = radiation(*sight, section.speed / C)
    return trailing_edge_noise(bands, section, layer, toward, AIR)


def test_directivity_as_printed():
    # Equations B1 and B2, with angles.
    m, theta, phi, r = 0.2, 1.1, 0.7, 2.0
    y, z = r * np.sin(theta) * np.cos(phi), r * np.sin(theta) * np.sin(phi)
    got = radiation(r * np.cos(theta), y, z, m)
    moving = 1 + m * np.cos(theta)
    high = 2 * np.sin(theta / 2) ** 2 * np.sin(phi) ** 2
    high /= moving * (1 + 0.2 * m * np.cos(theta)) ** 2
    low = np.sin(theta) ** 2 * np.sin(phi) ** 2 / moving**4
    assert float(got.high * r**2) == pytest.approx(high, rel=1e-9)
    assert float(got.low * r**2) == pytest.approx(low, rel=1e-9)


def test_directivity_of_a_moving_edge_as_printed():
    # Equations 19 and 20 of Brooks and Burley; where nothing moves, that of an airfoil at rest.
    theta, phi, r, approach = 1.1, 0.7, 2.0, 0.8
    y, z = r * np.sin(theta) * np.cos(phi), r * np.sin(theta) * np.sin(phi)
    got = moving_radiation(r * np.cos(theta), y, z, approach)
    high = 2 * np.sin(theta / 2) ** 2 * np.sin(phi) ** 2 / approach**4
    low = np.sin(theta) ** 2 * np.sin(phi) ** 2 / approach**4
    assert float(got.high * r**2) == pytest.approx(high, rel=1e-9)
    assert float(got.low * r**2) == pytest.approx(low, rel=1e-9)
    for a, b in zip(
        jax.tree.leaves(moving_radiation(0.3, 0.2, 1.0, 1.0)),
        jax.tree.leaves(radiation(0.3, 0.2, 1.0, 0.0)),
        strict=True,
    ):
        assert float(a) == pytest.approx(float(b), rel=1e-12)


def test_directivity_is_finite_in_the_chord_line():
    for x in (-1.0, 1.0):
        value, slope = jax.value_and_grad(lambda z, x=x: radiation(x, 0.0, z, 0.2).high)(0.0)
        assert value == 0 and np.isfinite(slope)


def test_the_side_of_the_suction_does_not_matter(section):
    for up, down in zip(noise(section(degrees=3.0)), noise(section(degrees=-3.0)), strict=True):
        np.testing.assert_array_equal(up, down)


def test_suction_side_is_thicker_and_lower_in_pitch(section):
    s = section(chord=0.3, speed=70.0)
    layer = boundary_layer(s.chord, s.speed, s.angle_of_attack, NU)
    assert layer.displacement_suction > layer.displacement_pressure
    assert layer.thickness_suction > layer.displacement_suction > layer.momentum_suction
    edge = noise(s)
    assert BANDS[np.argmax(edge.suction_side)] < BANDS[np.argmax(edge.pressure_side)]


def test_light_trip_is_six_tenths_of_the_heavy_one():
    heavy = boundary_layer(0.1, 50.0, 0.05, NU, "heavy")
    light = boundary_layer(0.1, 50.0, 0.05, NU, "light")
    assert not (heavy.shedding or light.shedding)
    for a, b in zip(jax.tree.leaves(heavy)[:6], jax.tree.leaves(light)[:6], strict=True):
        assert float(b / a) == pytest.approx(0.6, rel=1e-12)


def test_beyond_25_degrees_the_layer_stays_as_it_is():
    end, beyond = (boundary_layer(0.1, 50.0, np.radians(a), NU) for a in (25.3, 60.0))
    for a, b in zip(jax.tree.leaves(end), jax.tree.leaves(beyond), strict=True):
        assert float(b / a) == pytest.approx(1.0, rel=1e-12)


def test_a_tripped_layer_sheds_no_laminar_vortices(section):
    assert not np.any(noise(section(), trip="heavy").laminar_shedding)
    assert np.all(noise(section()).laminar_shedding > 0)


def test_noise_grows_with_span_and_falls_with_squared_distance(section):
    near = noise(section(span=0.02), sight=(0.3, 0.2, 1.0))
    far = noise(section(span=0.01), sight=(0.6, 0.4, 2.0))
    for a, b in zip(near, far, strict=True):
        np.testing.assert_allclose(a, 8 * b, rtol=1e-9)


def test_displacement_thickness_of_another_model_is_used(section):
    s = section()
    layer = boundary_layer(s.chord, s.speed, s.angle_of_attack, NU)
    thicker = dataclasses.replace(layer, displacement_suction=10**0.3 * layer.displacement_suction)
    before, after = noise(s), noise(s, layer=thicker)
    np.testing.assert_array_equal(before.pressure_side, after.pressure_side)
    # 3 dB thicker: 3 dB more, three bands lower.
    np.testing.assert_allclose(
        after.suction_side[:-3], 10**0.3 * before.suction_side[3:], rtol=1e-9
    )


def test_stall_leaves_only_separation(section):
    edge = noise(section(degrees=15.0))
    assert not np.any(edge.pressure_side) and not np.any(edge.suction_side)
    assert np.all(edge.separation > 0)


def test_nothing_jumps_over_angle_speed_and_edge_thickness(section):
    # Half the step, half the change, wherever it is heard: a jump would stay.
    n = 3001
    for name, values in (
        ("degrees", np.linspace(0, 30, n)),
        ("speed", np.geomspace(5, 200, n)),
        ("edge", np.geomspace(1e-6, 3e-3, n)),
    ):
        s = jax.tree.map(lambda q: jnp.broadcast_to(q, n)[:, None], section(**{name: values}))
        level = np.asarray(level_db(sum(noise(s, bands=BANDS[2::6]))))
        coarse, fine = (np.abs(np.diff(q, axis=0)).max() for q in (level[::2], level))
        assert fine < 0.55 * coarse, (name, coarse, fine)


@partial(compiled, optimisation=0)
def with_derivatives(section, way, weights):
    """Logarithm of all mechanisms, its derivative along a way, and the weighted sum's by all."""

    def total(section):
        return jnp.log10(sum(noise(section)))

    value, forward = jax.jvp(total, (section,), (way,))
    return value, forward, jax.vjp(total, section)[1](weights)[0]


@pytest.mark.parametrize("degrees", [0.0, 5.0, 7.0])
def test_derivatives_are_those_of_the_values(section, degrees):
    s, rng = section(degrees=degrees), np.random.default_rng(0)
    random = iter(rng.normal(size=4))
    # By chord, speed, angle and a thousand thicknesses of the edge.
    way = dataclasses.replace(
        jax.tree.map(jnp.zeros_like, s),
        chord=next(random),
        speed=next(random),
        angle_of_attack=next(random),
        trailing_edge_thickness=1e-3 * next(random),
    )
    weights, eps = rng.normal(size=BANDS.size), 1e-7
    ends = [
        with_derivatives(jax.tree.map(lambda q, d, e=e: q + e * d, s, way), way, weights)[0]
        for e in (0.5 * eps, -0.5 * eps)
    ]
    _, forward, slopes = with_derivatives(s, way, weights)
    np.testing.assert_allclose(forward, (ends[0] - ends[1]) / eps, rtol=2e-3, atol=2e-3)
    along = sum(jax.tree.leaves(jax.tree.map(lambda g, d: float(g * d), slopes, way)))
    assert along == pytest.approx(float(weights @ forward), rel=1e-9)


@partial(compiled, optimisation=0)
@jax.value_and_grad
def with_slopes(section):
    """Level of all mechanisms and its derivatives."""
    vortex = tip_noise(BANDS, section, Radiation(high=1.0, low=1.0), AIR)
    return jnp.sum(level_db(sum(noise(section)) + vortex))


@pytest.mark.parametrize(
    "changes", [{"degrees": 0.0}, {"speed": 0.0}, {"chord": 0.0}, {"edge": 0.0}, {"span": 0.0}]
)
def test_derivatives_are_finite_where_nothing_is_left(section, changes):
    value, slopes = with_slopes(section(**changes))
    assert np.isfinite(value)
    assert all(np.isfinite(slope) for slope in jax.tree.leaves(slopes))


@pytest.mark.parametrize("tip", ["rounded", "square"])
def test_tip_vortex_as_printed(section, tip):
    # Equations 61 to 67 at 5 deg.
    u, c = 60.0, 0.03
    length = (0.008 * 5 if tip == "rounded" else 0.0378 + 0.0095 * 5) * c
    m = u / C
    m_max = m * (1 + 0.036 * 5)
    st = BANDS * length / (m_max * C)
    level = 10 * np.log10(m**2 * m_max**3 * length**2) - 30.5 * (np.log10(st) + 0.3) ** 2 + 126
    end = section(chord=c, speed=u, degrees=5.0)
    got = level_db(tip_noise(BANDS, end, Radiation(high=1.0, low=1.0), AIR, tip))
    np.testing.assert_allclose(got, level, atol=1e-6)

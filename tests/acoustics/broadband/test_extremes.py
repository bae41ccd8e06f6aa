"""Levels and derivatives stay finite, and nothing jumps, wherever a legal blade may lead."""

from __future__ import annotations

import dataclasses
import itertools
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import radiation
from propmdao.acoustics.broadband.rotor import rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import (
    third_octave_centers,
    tip_noise,
    trailing_edge_noise,
)
from propmdao.acoustics.broadband.shedding_spectra import (
    blunt_strouhal_peak,
    bounded_edge_angle,
)
from propmdao.acoustics.levels.decibels import level_db
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.trailing_edge import trailing_edge
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, naca4_thickness
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

AIR = Air()
BANDS = third_octave_centers(50, 20e3)[::3]


def levels(section, sight=(0.3, 0.2, 1.0), trip="none", tip="rounded"):
    """Level of each mechanism in each band, (6, n_bands)."""
    toward = radiation(*sight, section.speed / AIR.sound_speed)
    layer = boundary_layer(
        section.chord, section.speed, section.angle_of_attack, AIR.kinematic_viscosity, trip
    )
    edge = trailing_edge_noise(BANDS, section, layer, toward, AIR)
    return level_db(jnp.stack([*edge, tip_noise(BANDS, section, toward, AIR, tip)]))


@pytest.mark.parametrize(
    ("trip", "tip"),
    [("none", "rounded"), pytest.param("heavy", "square", marks=pytest.mark.slow)],
)
def test_levels_and_derivatives_are_finite_at_every_corner(trip, tip):
    """No chord, span, speed, thickness; stall, steep edges; observers in line with the section."""
    corners = np.array(
        list(
            itertools.product(
                [0.0, 1e-4, 10.0],  # chord [m]
                [0.0, 0.1],  # span [m]
                [0.0, 1.0, 339.9, 345.0],  # speed [m/s], induced velocities included
                np.radians([0.0, -7.5, 12.5, 90.0]),
                [0.0, 1e-9, 0.5],  # edge thickness over chord
                np.radians([-80.0, 0.0, 20.0, 39.1, 60.0, 120.0]),
            )
        )
    )
    sights = [(1.0, 0.0, 0.0), (-1.0, 0.0, 0.0), (0.0, 1.0, 0.0), (0.0, 0.0, 1.0), (-1.0, 1.0, 1.0)]

    def total(corner, sight):
        chord, span, speed, angle, edge, edge_angle = corner
        section = Section(chord, span, speed, angle, edge * chord, edge_angle)
        return jnp.sum(levels(section, sight, trip, tip))

    with_slopes = jax.vmap(jax.value_and_grad(total, argnums=(0, 1)), in_axes=(0, None))
    both = compiled(with_slopes, optimisation=0)
    for sight in sights:
        value, slopes = both(jnp.asarray(corners), tuple(jnp.asarray(q) for q in sight))
        assert np.isfinite(value).all()
        assert all(np.isfinite(slope).all() for slope in jax.tree.leaves(slopes))


def test_edge_angle_is_the_reports_where_it_has_one_and_the_peak_stays_positive():
    measured, all_of_them = np.linspace(0.0, 20.0, 41), np.linspace(-180.0, 180.0, 721)
    np.testing.assert_allclose(bounded_edge_angle(measured), measured, atol=1e-12)
    bounded = np.asarray(bounded_edge_angle(all_of_them))
    assert bounded.min() == -2.0 and bounded.max() == 30.0 and np.all(np.diff(bounded) >= 0.0)
    ratio = jnp.geomspace(1e-9, 1e3, 200)[:, None]
    assert np.min(blunt_strouhal_peak(ratio, bounded)) > 0.02


def section_of(thickness):
    """A strip of a blade whose sections have this thickness over chord on the shared grid."""
    shape = thickness / jnp.max(thickness)
    span = span_interpolation([0.2, 1.0], [0.5])
    blade = dataclasses.replace(
        BLADE,
        thickness_shape=jnp.stack([shape, shape]),
        thickness_over_chord=jnp.full(2, jnp.max(thickness)),
    )
    edge, angle = (q[0] for q in trailing_edge(blade, span))
    chord = 0.03
    return Section(chord, 0.01, 60.0, np.radians(4.0), edge * chord, angle)


BLADE = Blade.from_propeller(
    Propeller(
        name="two stations",
        diameter=0.3,
        n_blades=2,
        r_over_R=np.array([0.2, 1.0]),
        c_over_R=np.array([0.2, 0.2]),
        beta_deg=np.array([10.0, 10.0]),
        airfoils=[(0.2, "naca4412")],
    )
)


def scaled(thickness_over_chord):
    return thickness_over_chord * naca4_thickness(1.0)


def rounded(radius_over_chord):
    """NACA 0012 that ends in an ellipse as scanned edges do, and a face of 1 % of chord."""
    aft = jnp.clip((CHORD_FRACTION - 1.0) / radius_over_chord + 1.0, 0.0, 1.0)
    # Its root has no derivative at the very end, where the contour closes.
    return 0.01 + naca4_thickness(0.12) * jnp.sqrt(jnp.where(aft < 1.0, 1.0 - aft**2, 1e-30))


@pytest.mark.parametrize(
    ("shape", "positions"),
    [(scaled, np.linspace(0.05, 0.9, 851)), (rounded, np.geomspace(1e-3, 0.06, 851))],
)
def test_nothing_jumps_over_thickness_and_rounding(shape, positions):
    """Half the step, half the change: a jump would stay. Derivatives are those of the values."""
    with_slopes = jax.vmap(jax.value_and_grad(lambda q: bluntness_of(shape(q))))
    total = compiled(with_slopes, optimisation=0)
    value, slope = (np.asarray(q) for q in total(jnp.asarray(positions)))
    assert np.isfinite(value).all() and np.isfinite(slope).all()
    fine, coarse = np.abs(np.diff(value)), np.abs(np.diff(value[::2]))
    assert coarse.max() > 1e-4  # something changes
    assert fine.max() < 0.6 * coarse.max()
    steepest = np.abs(slope).max()
    np.testing.assert_allclose(np.gradient(value, positions), slope, atol=0.05 * steepest)


@partial(compiled, optimisation=0)
def bluntness_of(thickness):
    """Level of the mechanism that knows of the edge, all bands together."""
    bands = levels(section_of(thickness))[4]
    return 10 * jnp.log10(jnp.sum(10 ** (bands / 10)))


def test_a_blade_that_is_a_little_thicker_is_heard_a_little_louder():
    """NACA sections of t/c 0.45 and 0.50, 50 and 54 deg at the edge."""
    below, above = (float(bluntness_of(scaled(jnp.asarray(t)))) for t in (0.45, 0.50))
    assert abs(above - below) < 1.5


def test_trailing_edges_that_move_faster_than_sound_are_finite(strips):
    """The tip is slower, the corner of a wide blade behind it is not."""
    state = RotorState(0.999 * AIR.sound_speed / 0.14, 0.0, AIR)
    wide = dataclasses.replace(strips, position=strips.position + 0.1 * strips.chord_direction)
    moving = state.rotation_speed * np.linalg.norm(np.asarray(wide.position)[-1, :2])
    assert moving > AIR.sound_speed

    def noise(speed):
        turning = RotorState(speed, 0.0, AIR)
        observer = np.array([[0.5, 0.0, -0.5]])
        return jnp.sum(level_db(rotor_self_noise(wide, 2, turning, observer, BANDS).total))

    value, slope = compiled(jax.value_and_grad(noise), optimisation=0)(state.rotation_speed)
    assert np.isfinite(value) and np.isfinite(slope)

"""Edges in any motion: a rotor's are those of `broadband.rotor`, and an observer at rest hears."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.broadband.moving_edges import MovingEdges, moving_self_noise
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.kinematics.motion import place, poses, rotation, translation
from propmdao.records.air import Air
from propmdao.records.models import SelfNoiseModel
from propmdao.records.states import RotorState

BANDS = third_octave_centers(500.0, 8000.0)
AIR, OMEGA, N_TIMES, N_STRIPS = Air(), 400.0, 24, 5
RADIUS = np.linspace(0.06, 0.14, N_STRIPS)
OBSERVER = np.array([1.2, 0.3, -0.9])


def section():
    columns = (0.02, 0.02, OMEGA * RADIUS, 0.06, 2e-4, 0.1)
    return Section(*(jnp.broadcast_to(jnp.asarray(q), N_STRIPS) for q in columns))


def axes():
    """Chord and span of strips along +x that turn toward +y at a blade angle of 12 deg."""
    c, s = np.cos(np.radians(12.0)), np.sin(np.radians(12.0))
    chord = np.tile([0.0, -c, -s], (N_STRIPS, 1))
    return chord, np.tile([1.0, 0.0, 0.0], (N_STRIPS, 1))


def edges(flight, end=0.0):
    """One blade over a turn that ends at a time, flying at a velocity."""
    start = end - 2 * np.pi / OMEGA
    time = start + 2 * np.pi / OMEGA * np.arange(N_TIMES) / N_TIMES
    motion = translation(velocity=flight), rotation([0.0, 0.0, 1.0], rate=OMEGA)
    pose = poses(motion, time)
    position, velocity, _ = place(pose, np.outer(RADIUS, [1.0, 0.0, 0.0]))
    chord, span = (axis @ np.swapaxes(pose.rotation, 1, 2) for axis in axes())
    arrays = (jnp.asarray(q) for q in (time, position, velocity, chord, span))
    tip = jax.tree.map(lambda q: q[-1], section())
    return MovingEdges(*arrays, section=section(), tip=tip)


def heard(flight=(0.0, 0.0, 0.0), observer_velocity=None, observer=OBSERVER, end=0.0):
    velocity = np.asarray(flight if observer_velocity is None else observer_velocity)
    listening = jnp.asarray(observer), jnp.asarray(velocity), jnp.asarray(BANDS), AIR
    return moving_self_noise(edges(np.asarray(flight), end), *listening, "heavy", "square")


@pytest.mark.parametrize(("speed", "incidence_deg"), [(0.0, 0.0), (30.0, 0.0), (20.0, 70.0)])
def test_a_rotor_heard_by_those_who_fly_along_is_that_of_the_rotor_code(speed, incidence_deg):
    incidence = np.radians(incidence_deg)
    flight = speed * np.array([np.sin(incidence), 0.0, np.cos(incidence)])
    # The tip of the rotor code is fed by the section at 0.96 R, here by the last strip.
    strips = StripFlow(
        jnp.asarray(np.outer(RADIUS, [1.0, 0.0, 0.0])), *map(jnp.asarray, axes()), section()
    )
    state = RotorState(OMEGA, speed, AIR, incidence)
    model = SelfNoiseModel("heavy", tip="square")
    known = rotor_self_noise(strips, 1, state, OBSERVER[None], BANDS, model, N_TIMES)
    found = heard(flight)
    for name in ("pressure_side", "suction_side", "separation", "bluntness"):
        assert_allclose(getattr(found, name), getattr(known, name)[0], rtol=1e-9, err_msg=name)
    uniform = dataclasses.replace(section(), speed=jnp.full(N_STRIPS, section().speed[-1]))
    alike = dataclasses.replace(strips, section=uniform)
    known = rotor_self_noise(alike, 1, state, OBSERVER[None], BANDS, model, N_TIMES)
    assert_allclose(found.tip, known.tip[0], rtol=1e-9)


def test_an_observer_at_rest_hears_what_meets_him_flying_along_does_at_shifted_frequencies():
    flight, place_there = np.array([0.0, 0.0, 30.0]), 100.0 * OBSERVER
    at_rest = heard(flight, np.zeros(3), place_there)
    # Who flies along is there when the middle of the turn arrives.
    middle = -np.pi / OMEGA
    way = place_there - flight * middle
    distance = np.linalg.norm(way)
    beside = place_there - flight * (middle + distance / AIR.sound_speed)
    factor = 1.0 - float(flight @ way) / (distance * AIR.sound_speed)
    listening = jnp.asarray(beside), jnp.asarray(flight), jnp.asarray(BANDS * factor), AIR
    along = moving_self_noise(edges(flight), *listening, "heavy", "square")
    for name in ("pressure_side", "suction_side", "bluntness", "tip"):
        ratio = np.asarray(getattr(at_rest, name)) / np.asarray(getattr(along, name))
        assert np.all(np.abs(10.0 * np.log10(ratio)) < 0.02), name


def test_far_away_the_level_falls_with_the_square_of_the_distance():
    near, far = (heard(observer=k * 200.0 * OBSERVER).total for k in (1.0, 2.0))
    assert_allclose(near / far, 4.0, rtol=2e-3)

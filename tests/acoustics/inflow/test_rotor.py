"""A rotor in turbulence is its strips, one by one, over the turn."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.rotor import StripFlow
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.inflow.plate import inflow_noise
from propmdao.acoustics.inflow.rotor import rotor_inflow_noise
from propmdao.acoustics.kinematics.observers import arc
from propmdao.records.air import Air, Turbulence
from propmdao.records.states import RotorState

C = 340.0
AIR = Air(density=1.2, sound_speed=C)
BANDS = third_octave_centers(200.0, 10e3)[::3]
EDDIES = Turbulence(0.5, 0.05)
OBSERVERS = arc(1.5, [-45.0, 10.0])
RADIUS = np.array([0.06, 0.1, 0.135])


@pytest.fixture(scope="module")
def strips() -> StripFlow:
    pitch = np.arctan2(0.02, RADIUS)
    chord_direction = np.stack([0 * RADIUS, -np.cos(pitch), -np.sin(pitch)], axis=-1)
    span_direction = np.tile([1.0, 0.0, 0.0], (3, 1))
    values = 0.03 - 0.1 * RADIUS, np.full(3, 0.035), 440.0 * RADIUS, *np.zeros((3, 3))
    position = np.stack([RADIUS, 0 * RADIUS, 0 * RADIUS], axis=-1)
    arrays = map(jnp.asarray, (position, chord_direction, span_direction))
    return StripFlow(*arrays, Section(*map(jnp.asarray, values)))


def hear(strips, n_blades=2, omega=440.0, flight=(0.0, 0.0), n_azimuths=24, observers=OBSERVERS):
    state = RotorState(omega, flight[0], AIR, flight[1])
    heard = rotor_inflow_noise(strips, n_blades, state, EDDIES, observers, BANDS, n_azimuths)
    return np.asarray(heard)


def by_hand(strips, omega, flight, observer, n_azimuths):
    """Sum over strips and azimuths of one blade in a frame at rest, with loops, fixed points."""
    total = np.zeros(BANDS.size)
    flight = flight[0] * np.array([np.sin(flight[1]), 0.0, np.cos(flight[1])])
    plate = jax.jit(inflow_noise)
    for psi in 2 * np.pi * np.arange(n_azimuths) / n_azimuths:
        turn = np.array([[np.cos(psi), -np.sin(psi), 0], [np.sin(psi), np.cos(psi), 0], [0, 0, 1]])
        for i, position in enumerate(np.asarray(strips.position) @ turn.T):
            delay = 0.0
            for _ in range(50):
                ray = observer + flight * delay - position
                delay = np.linalg.norm(ray) / C
            toward = ray / np.linalg.norm(ray)
            moving = np.cross([0, 0, omega], position) + flight
            approach = 1 - toward @ moving / C
            stretch = approach / (1 - toward @ flight / C)
            chord, span = turn @ strips.chord_direction[i], turn @ strips.span_direction[i]
            sight = ray @ chord, ray @ span, ray @ np.cross(chord, span)
            strip = jax.tree.map(lambda q, i=i: q[i], strips.section)
            power = plate(BANDS * stretch, strip, EDDIES, sight, approach, AIR)
            total += np.asarray(power) * stretch / n_azimuths
    return total


@pytest.mark.parametrize("flight", [(0.0, 0.0), (25.0, 1.2)])
def test_sum_over_strips_and_azimuths(strips, flight):
    got = hear(strips, n_blades=1, flight=flight, observers=OBSERVERS[:1], n_azimuths=4)
    expected = by_hand(strips, 440.0, flight, OBSERVERS[0], 4)
    np.testing.assert_allclose(got[0], expected, rtol=1e-9)


def test_blades_add_and_azimuths_are_enough(strips):
    two = hear(strips)
    np.testing.assert_allclose(hear(strips, n_blades=4), 2 * two, rtol=1e-12)
    error = 10 * np.log10(two[0] / hear(strips, n_azimuths=96)[0])
    assert np.abs(error).max() < 0.1


def test_slowly_turning_rotor_has_the_energy_of_its_airfoils_at_rest_around_the_turn(strips):
    """No Doppler, no convection: sum over all bands is that of fixed airfoils at each azimuth."""
    slow = dataclasses.replace(strips.section, speed=jnp.full(3, 8.0))
    strips = dataclasses.replace(strips, section=slow)
    turned = hear(strips, n_blades=1, omega=1e-6, n_azimuths=8)[0].sum()
    plate, fixed = jax.jit(inflow_noise), 0.0
    for psi in 2 * np.pi * np.arange(8) / 8:
        turn = np.array([[np.cos(psi), -np.sin(psi), 0], [np.sin(psi), np.cos(psi), 0], [0, 0, 1]])
        for i in range(3):
            ray = OBSERVERS[0] - turn @ strips.position[i]
            chord, span = turn @ strips.chord_direction[i], turn @ strips.span_direction[i]
            sight = ray @ chord, ray @ span, ray @ np.cross(chord, span)
            strip = jax.tree.map(lambda q, i=i: q[i], slow)
            fixed += np.sum(plate(BANDS, strip, EDDIES, sight, 1.0, AIR)) / 8
    assert turned == pytest.approx(float(fixed), rel=1e-6)


def test_loudest_on_the_axis_and_quiet_in_the_plane(strips):
    axis, plane = (hear(strips, observers=arc(3.0, [angle]))[0].sum() for angle in (-90.0, 0.0))
    assert 10 * np.log10(axis / plane) > 6.0


def test_derivative_through_the_rotor(strips):
    def loudness(intensity, length, omega):
        state = RotorState(omega, 25.0, AIR, 1.2)
        eddies = Turbulence(intensity, length)
        heard = rotor_inflow_noise(strips, 2, state, eddies, OBSERVERS[:1], BANDS, 8)
        return jnp.sum(jnp.log(heard))

    at = np.array([0.5, 0.05, 440.0])
    value = jax.jit(lambda q: loudness(*q))
    slopes = jax.jit(jax.grad(lambda q: loudness(*q)))(at)
    for i, step in enumerate(1e-6 * at):
        change = np.eye(3)[i] * step
        difference = (float(value(at + change)) - float(value(at - change))) / (2 * step)
        assert float(slopes[i]) == pytest.approx(difference, rel=1e-4)

"""A rotor is its strips, one by one, over the turn."""

from __future__ import annotations

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.boundary_layer import boundary_layer
from propmdao.acoustics.broadband.directivity import moving_radiation
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise, tip_section
from propmdao.acoustics.broadband.self_noise import third_octave_centers, trailing_edge_noise
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.decibels import level_db
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

C, NU = 340.0, 1.5e-5
AIR = Air(density=1.0, sound_speed=C, dynamic_viscosity=NU)
BANDS = third_octave_centers(315, 20e3)
OBSERVERS = arc(1.5, [-45.0, 10.0])


@partial(compiled, static_argnames=("n_blades", "options"), optimisation=0)
def heard_with(options, strips, n_blades, omega, flight, observers):
    state = RotorState(omega, flight[0], AIR, flight[1])
    return rotor_self_noise(strips, n_blades, state, observers, BANDS, **dict(options))


def hear(strips, n_blades=2, omega=440.0, flight=(0.0, 0.0), observers=OBSERVERS, **options):
    return heard_with(tuple(options.items()), strips, n_blades, omega, flight, observers)


def around(strips, n_azimuths):
    """Strips that the air meets faster and at smaller angles on one side of the turn."""
    psi = 2 * np.pi * np.arange(n_azimuths)[:, None] / n_azimuths
    s = strips.section
    section = dataclasses.replace(
        s,
        speed=s.speed * (1 - 0.4 * np.sin(psi)),
        angle_of_attack=s.angle_of_attack * (1 + 0.7 * np.sin(psi) - 0.2 * np.cos(2 * psi)),
    )
    return dataclasses.replace(strips, section=section)


def by_hand(strips, omega, flight, observer, n_azimuths):
    """Sum of one blade's trailing edges in a frame at rest, with loops and a fixed point."""
    total = np.zeros(BANDS.size)
    s = strips.section
    flight = flight[0] * np.array([np.sin(flight[1]), 0.0, np.cos(flight[1])])
    for k in range(n_azimuths):
        psi = 2 * np.pi * k / n_azimuths
        turn = np.array([[np.cos(psi), -np.sin(psi), 0], [np.sin(psi), np.cos(psi), 0], [0, 0, 1]])
        for i in range(len(strips.position)):
            y = turn @ strips.position[i]
            delay = 0.0
            for _ in range(50):
                r = observer + flight * delay - y
                delay = np.linalg.norm(r) / C
            toward = r / np.linalg.norm(r)
            moving = np.cross([0, 0, omega], y) + flight
            stretch = (1 - toward @ moving / C) / (1 - toward @ flight / C)
            e_c, e_s = turn @ strips.chord_direction[i], turn @ strips.span_direction[i]
            strip = jax.tree.map(lambda q, i=i, k=k: q[k, i] if q.ndim == 2 else q[i], s)
            layer = boundary_layer(strip.chord, strip.speed, strip.angle_of_attack, NU)
            approach = 1 - toward @ moving / C
            sight = moving_radiation(r @ e_c, r @ e_s, r @ np.cross(e_c, e_s), approach)
            edge = trailing_edge_noise(BANDS * stretch, strip, layer, sight, AIR)
            total += np.asarray(sum(edge)) * stretch / n_azimuths
    return total


@pytest.mark.parametrize("flight", [(0.0, 0.0), (25.0, 0.0), (25.0, 1.2), (40.0, 2.0)])
def test_sum_over_strips_and_azimuths(strips, flight):
    """In hover, axial flight and at incidences, where the flow changes over the turn."""
    strips = around(strips, 4) if flight[1] else strips
    got = hear(strips, n_blades=1, flight=flight, observers=OBSERVERS[:1], n_azimuths=4)
    expected = by_hand(strips, 440.0, flight, OBSERVERS[0], 4)
    np.testing.assert_allclose((got.total - got.tip)[0], expected, rtol=1e-9)


def test_blades_add(strips):
    np.testing.assert_allclose(hear(strips, 4).total, 2 * hear(strips, 2).total, rtol=1e-12)


def test_default_number_of_azimuths_is_enough(strips):
    # Away from the rotor plane; see the note of rotor_self_noise on the chord line.
    below = arc(1.5, [-45.0, -20.0])
    coarse, fine = (level_db(hear(strips, n_azimuths=n, observers=below).total) for n in (24, 96))
    np.testing.assert_allclose(coarse, fine, atol=0.1)


def test_flow_may_change_over_the_turn(strips):
    every = dataclasses.replace(
        strips, section=jax.tree.map(lambda q: jnp.tile(q, (8, 1)), strips.section)
    )
    one, all_azimuths = (hear(s, n_azimuths=8) for s in (strips, every))
    for a, b in zip(jax.tree.leaves(one), jax.tree.leaves(all_azimuths), strict=True):
        np.testing.assert_allclose(a, b, rtol=1e-12)


def test_own_boundary_layer_is_the_default(strips):
    s = strips.section
    layer = boundary_layer(s.chord, s.speed, s.angle_of_attack, NU)
    np.testing.assert_allclose(
        hear(strips).total, hear(dataclasses.replace(strips, layer=layer)).total, rtol=1e-12
    )


def test_symmetric_rotor_is_heard_alike_all_around(strips):
    r, z = OBSERVERS[0, 0], OBSERVERS[0, 2]
    around = [[r * np.cos(a), r * np.sin(a), z] for a in 2 * np.pi * np.array([0, 3, 7]) / 24]
    heard = hear(strips, observers=np.array(around)).total
    np.testing.assert_allclose(heard, heard[:1].repeat(3, axis=0), rtol=1e-9)


def test_tip_vortex_knows_the_section_at_096_of_the_radius(strips):
    # Angles that rise linearly to the tip, on two meshes: the same section, the same noise.
    def blade(n):
        edges = np.linspace(0.2, 1.0, n + 1)
        r = 0.15 * (edges[1:] + edges[:-1]) / 2
        fixed = jax.tree.map(lambda q: jnp.broadcast_to(q[-1], n), strips.section)
        section = dataclasses.replace(
            fixed, span=jnp.full(n, 0.15 * 0.8 / n), angle_of_attack=jnp.asarray(r / 1.5)
        )
        directions = (
            jnp.tile(q[-1], (n, 1)) for q in (strips.chord_direction, strips.span_direction)
        )
        return StripFlow(jnp.stack([r, 0 * r, 0 * r], axis=1), *directions, section)

    blades = [blade(n) for n in (40, 160)]
    for each in blades:
        assert float(tip_section(each).angle_of_attack) == pytest.approx(0.096, rel=1e-12)
    coarse, fine = (level_db(hear(each).tip) for each in blades)
    np.testing.assert_allclose(coarse, fine, atol=0.2)  # that the last strip's middle moves


def test_tip_vortex_of_flow_that_changes_over_the_turn(strips):
    every = jax.tree.map(lambda q: jnp.tile(q, (8, 1)), strips.section)
    got = tip_section(dataclasses.replace(strips, section=every)).angle_of_attack
    np.testing.assert_allclose(got, jnp.tile(tip_section(strips).angle_of_attack, 8), rtol=1e-12)


@pytest.fixture(scope="module")
def loudness(strips):
    """Level by sections that change over the turn, rotation and flight, and its derivatives."""

    def loudness(section, omega, flight):
        heard = hear(dataclasses.replace(strips, section=section), omega=omega, flight=flight)
        return jnp.sum(level_db(heard.total))

    return compiled(jax.value_and_grad(loudness, argnums=(0, 1, 2)), optimisation=0)


def test_standstill_is_silent_and_differentiable(strips, loudness):
    section = around(strips, 24).section
    still = dataclasses.replace(section, speed=jnp.zeros((24, 6)))
    value, slopes = loudness(still, 0.0, (0.0, 0.0))
    assert float(value) < -195 * BANDS.size * len(OBSERVERS)
    assert all(np.isfinite(slope).all() for slope in jax.tree.leaves(slopes))


def test_derivative_through_the_rotor(strips, loudness):
    """At an incidence, with flow that changes over the turn."""
    strips = around(strips, 24)

    def at_angles(angle, omega, incidence):
        section = dataclasses.replace(strips.section, angle_of_attack=angle)
        value, (by_section, by_omega, (_, by_incidence)) = loudness(
            section, omega, (25.0, incidence)
        )
        return value, (by_section.angle_of_attack, by_omega, by_incidence)

    angle, step = strips.section.angle_of_attack, jnp.linspace(1.0, 2.0, 6)
    at = angle, 440.0, 1.2
    slopes = at_angles(*at)[1]
    ways = ((1e-6 * step, 0.0, 0.0), 1e-4), ((0.0, 0.01, 0.0), 1e-3), ((0.0, 0.0, 1e-5), 1e-4)
    for way, tolerance in ways:
        forward, back = (
            at_angles(*(q + s * d for q, d in zip(at, way, strict=True)))[0] for s in (1, -1)
        )
        product = sum(jnp.sum(slope * d) for slope, d in zip(slopes, way, strict=True))
        assert float(product) == pytest.approx(0.5 * float(forward - back), rel=tolerance)

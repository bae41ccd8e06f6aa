"""A wing that is set going at once, and one that flies into a gust: Wagner and Kuessner.

H. Wagner, Z. angew. Math. Mech. 5, 1925: of the final circulation about a flat plate the lift has
half at once and all in the end, with Jones' approximation (NACA Report 681, 1940)

    phi(s) = 1 - 0.165 exp(-0.0455 s) - 0.335 exp(-0.3 s)

after s half chords of travel. Of the lift in a gust with a sharp edge there is none at first,
with Sears' approximation (J. Aeronaut. Sci. 8, 1941) to the function of H. G. Kuessner (1936)

    psi(s) = 1 - 0.5 exp(-0.13 s) - 0.5 exp(-s).

The march of a rotor is that of a wing with a straight wake.
"""

import dataclasses
from functools import partial

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.marching.step import Past, marched_lattice, step_loads
from propmdao.aerodynamics.solutions.period.lattice import period_lattice
from propmdao.aerodynamics.solutions.period.onset import PeriodOnset
from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.sheets import Sheets, WakeParts, fewer_filaments
from propmdao.geometry.lattice import lattice_chord_fraction
from propmdao.records.air import Air
from propmdao.records.wake_law import WakeGrid
from propmdao.runtime.compilation import compiled

SPEED, DENSITY, CHORD, UPWASH = 10.0, 1.2, 1.0, 0.1
SPAN, NC, NS = 400.0, 8, 11
MIDDLE = NS // 2
LENGTH = 20.0  # of the wake, in chords


def wagner(s):
    """Share of the final lift after s half chords."""
    return 1.0 - 0.165 * np.exp(-0.0455 * s) - 0.335 * np.exp(-0.3 * s)


def kuessner(s):
    """Share of the final lift after s half chords in a gust."""
    s = np.maximum(s, 0.0)
    return 1.0 - 0.5 * np.exp(-0.13 * s) - 0.5 * np.exp(-s)


@partial(compiled, optimisation=0)
def lattice_of(wing):
    return marched_lattice(period_lattice(wing))


def lift_after(half_chords_per_step, n_steps, gust_edge=None):
    """Lift per span in the middle of a long wing at each step, over the final one.

    The wing is set going at once, or it flies into a gust whose edge has the width given in
    half chords and reaches the leading edge with its middle at the first step.
    """
    eta = -np.cos(np.linspace(0.0, np.pi, NS + 1))
    # Leading to trailing edge along -z, span along x: the suction side looks to -y.
    z = -CHORD * lattice_chord_fraction(NC)[:, None] + 0.0 * eta
    nodes = jnp.asarray(np.stack([0.5 * SPAN * eta + 0.0 * z, 0.0 * z, z], axis=-1))
    lattice = lattice_of(RotorGeometry(nodes, 1.0, 1))
    # Ages in chords of travel: fine at the trailing edge.
    ages = jnp.asarray(wake_azimuths(WakeGrid(1.0, 0.36, 1.2, 18.0))) * LENGTH / (2.0 * np.pi)
    edge = lattice.period.lattice.rings.corner[-1]
    behind = CHORD * ages[:, None] * jnp.array([0.0, 0.0, -1.0])
    core = jnp.full((1, ages.size - 1), 1e-6)
    sheets = Sheets((edge[:, None, None, :] + behind)[None], core, core)
    dt = half_chords_per_step * 0.5 * CHORD / SPEED
    delay = shedding_delay(lattice.period.last_panel, CHORD * ages[1])
    lag = (CHORD * middles(ages) + delay[:, None]) / (SPEED * dt)
    velocity = jnp.zeros((1, 3, lattice.period.lattice.points.shape[0]))
    onset = PeriodOnset(
        velocity=velocity.at[:, 2].set(-SPEED).at[:, 1].set(-UPWASH),
        relative_speed=jnp.full((1, NS), SPEED),
        attached=jnp.ones((1, NS)),
        motion_angle=jnp.zeros((1, NS)),
        turning_share=jnp.ones(NS),
    )
    n_young = min(int((np.asarray(middles(ages)) * CHORD < 2.0 * SPEED * dt).sum()) + 1, ages.size)
    chosen, to_strips = fewer_filaments(edge, NS // 2 + 1)
    parts = WakeParts(jnp.asarray(chosen), jnp.asarray(to_strips), SPAN, n_young, n_young + 10)
    n_lags = int(LENGTH * CHORD / (SPEED * dt)) + 8
    medium = dt, Air(density=DENSITY), None

    behind_nose = -2.0 / CHORD * lattice.period.lattice.points[:, 2]

    def onset_at(number):
        if gust_edge is None:
            return onset
        inside = (number * half_chords_per_step - behind_nose) / gust_edge + 0.5
        upwash = -UPWASH * jnp.clip(inside, 0.0, 1.0)
        return dataclasses.replace(onset, velocity=onset.velocity.at[:, 1].set(upwash))

    @partial(compiled, optimisation=0)
    def step(past, number):
        loads = step_loads(lattice, sheets, parts, lag, onset_at(number), past, medium)
        strips = jnp.concatenate([loads.circulation[None, :, -NS:], past.strips[:-1]])
        segments = loads.force[0, : NC * NS]
        rings = loads.force[0, -NS - NC * NS : -NS]
        normal = -(segments + rings)[:, 1].reshape(NC, NS)[:, MIDDLE].sum()
        return Past(strips, jnp.stack([loads.circulation, past.rings[0]])), normal

    past = Past(jnp.zeros((n_lags, 1, NS)), jnp.zeros((2, 1, NC * NS)))
    begun = step(past, 0.0)[0].rings[0]
    past = Past(past.strips, jnp.stack([begun, begun]))
    lift = []
    for number in range(n_steps):
        past, normal = step(past, number)
        lift.append(float(normal))
    width = float(nodes[0, MIDDLE + 1, 0] - nodes[0, MIDDLE, 0])
    final = 2.0 * np.pi * UPWASH / SPEED * 0.5 * DENSITY * SPEED**2 * CHORD * width
    return np.array(lift) / final


def test_lift_of_a_wing_that_is_set_going_is_wagners():
    step, n_steps = 0.5, 30
    # Circulation appears over the step before the first: half a step ago.
    s = step * (np.arange(n_steps) + 0.5)
    found = lift_after(step, n_steps)
    # From the fifth step on: before, a step is a large part of the travel.
    np.testing.assert_allclose(found[4:], wagner(s)[4:], rtol=0.02)


def test_lift_of_a_wing_that_flies_into_a_gust_is_kuessners():
    step, n_steps, edge = 0.25, 48, 0.5
    found = lift_after(step, n_steps, edge)
    # The edge is as wide as two panels, and the function that of its mean.
    s = step * np.arange(n_steps)[:, None] + edge * np.linspace(-0.5, 0.5, 101)
    expected = kuessner(s).mean(axis=1)
    # While it crosses the chord the lift jumps from panel to panel, and the rate of the circulation
    # reaches back two steps.
    crossing = s[:, 0] < 2.0 + 2.0 * step
    np.testing.assert_allclose(found[~crossing], expected[~crossing], rtol=0.02)
    np.testing.assert_allclose(found[crossing], expected[crossing], atol=0.15)

"""Scans of the A-weighted total over random directions: no steps, no kinks that can be seen."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.section_layers import layer_of_sections
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.weighting import level_dba
from propmdao.records.air import Air
from propmdao.records.loads import EdgeSide
from propmdao.records.states import RotorState

BANDS, N = third_octave_centers(200, 16e3), 6
STATE = RotorState(440.0, 0.0, Air())
RADII = np.linspace(0.03, 0.135, N)
AHEAD, OUT = np.tile([0.0, -0.95, -0.3122], (N, 1)), np.tile([1.0, 0.0, 0.0], (N, 1))


def total(values):
    """A-weighted level [dBA] of strips whose sections are ``values``, (10, N) around 0."""
    chord = 0.025 * jnp.exp(0.2 * values[0])
    section = Section(
        chord=chord,
        span=jnp.full(N, 0.02),
        speed=440 * RADII * jnp.exp(0.1 * values[1]),
        angle_of_attack=jnp.radians(4.0 + 3.0 * values[2]),
        trailing_edge_thickness=2e-4 * jnp.exp(0.3 * values[3]),
        trailing_edge_angle=0.2 + 0.05 * values[4],
    )
    upper, lower = (
        EdgeSide(
            0.004 * jnp.exp(0.3 * a), 2.6 * jnp.exp(0.3 * b), 0.8 + 0.15 * jnp.tanh(b - a), 0.95
        )
        for a, b in (values[5:7], values[7:9])
    )
    layer = layer_of_sections(chord, section.angle_of_attack, upper, lower)
    position = jnp.stack([jnp.asarray(RADII), 0.01 * values[9], jnp.zeros(N)], axis=1)
    flow = StripFlow(position, jnp.asarray(AHEAD), jnp.asarray(OUT), section, layer)
    heard = rotor_self_noise(flow, 2, STATE, arc(1.9, [-40.0]), BANDS, n_azimuths=4)
    return level_dba(BANDS, heard.total)[0]


@pytest.fixture(scope="module")
def scan():
    """``scan(seed, n)``: levels at n points of a line through the range of the sections."""
    levels = jax.jit(lambda points: jax.lax.map(total, points))

    def scan(seed, n):
        ends = np.random.default_rng(seed).uniform(-1.0, 1.0, (2, 10, N))
        t = np.linspace(0.0, 1.0, n)[:, None, None]
        return np.asarray(levels(jnp.asarray(ends[0] + t * (ends[1] - ends[0]))))

    return scan


@pytest.mark.parametrize("seed", range(4))
def test_the_total_has_no_steps_and_no_kinks(scan, seed):
    # The largest second difference falls with the square of the step where the slope is continuous,
    # with the step at a kink, and not at all where there is a step.
    fine = scan(seed, 1601)
    assert np.ptp(fine) > 0.5
    largest = [np.abs(np.diff(fine[::every], 2)).max() for every in (8, 4, 2, 1)]
    power = np.log2(np.divide(largest[:-1], largest[1:]))
    assert np.all(power > 1.5)

"""Time of a rotor's self-noise: 24 strips, 24 azimuths, 30 bands; and of all sound on a sphere.

An observer hears 17,000 of these. Six mechanisms each take a power of ten and 20 to 40 operations
for a level, 4 million together: 0.5 ms at 8 a nanosecond, 5 ms for nine observers. Measured on a
busy machine, in 27 bands: 11 ms for nine, the reverse derivative 64 ms. What belongs to the strips
alone is worked out once, ahead of the observers.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import pytest

import propmdao as pm
from propmdao.acoustics.broadband.rotor import StripFlow, rotor_self_noise
from propmdao.acoustics.broadband.section import Section
from propmdao.acoustics.broadband.self_noise import third_octave_centers
from propmdao.acoustics.kinematics.observers import arc, sphere
from propmdao.records.air import Air
from propmdao.records.states import RotorState

BANDS = third_octave_centers(100, 80e3)


@pytest.fixture(scope="module", params=[1, 9, 400], ids="observers-{}".format)
def case(request):
    """Return (strips, observers): what the noise is differentiated by in a design."""
    r = np.linspace(0.02, 0.138, 24)
    beta = np.arctan2(0.025, r)
    chord = 0.03 - 0.1 * r
    chord_direction = np.stack([0 * r, -np.cos(beta), -np.sin(beta)], axis=-1)
    section = Section(
        chord=jnp.asarray(chord),
        span=jnp.full(24, 0.005),
        speed=jnp.asarray(440 * r),
        angle_of_attack=jnp.linspace(0.2, 0.05, 24),
        trailing_edge_thickness=jnp.full(24, 2e-4),
        trailing_edge_angle=jnp.full(24, 0.2),
    )
    strips = StripFlow(
        position=jnp.asarray(np.stack([r, 0 * r, 0 * r], axis=-1)),
        chord_direction=jnp.asarray(chord_direction),
        span_direction=jnp.asarray(np.tile([1.0, 0.0, 0.0], (24, 1))),
        section=section,
    )
    elevation_deg = [-45.0] if request.param == 1 else np.linspace(-45.0, 45.0, request.param)
    return strips, jnp.asarray(arc(1.905, elevation_deg))


def hear(strips, observers):
    return rotor_self_noise(strips, 2, RotorState(440.0, 0.0, Air()), observers, BANDS).total


def timed(benchmark, function, *arguments):
    compiled = jax.jit(function).lower(*arguments).compile()
    benchmark(lambda: jax.block_until_ready(compiled(*arguments)))


def test_rotor_self_noise(benchmark, case):
    timed(benchmark, hear, *case)


def test_reverse_derivative(benchmark, case):
    timed(benchmark, jax.grad(lambda *values: jnp.sum(jnp.log(hear(*values)))), *case)


def test_sphere_of_400_observers(processor_time, record_property):
    """Loads, tones and broadband noise on 20 elevations and 20 azimuths: 1 s is wanted."""
    places = sphere(2.0, np.linspace(-85.0, 85.0, 20), np.arange(20) * 18.0)
    propeller = pm.load_propeller("apcsf_11x4.7")

    def analysis():
        found = pm.analyze(propeller, rpm=4200.0, broadband=True, observers=places)
        return found.tones.total, found.broadband.total

    seconds = processor_time(analysis)
    record_property("processor_s", seconds)
    print(f"sphere of 400 observers: {seconds:.2f} s of the processor")

"""Cost of blade elements, alone and in a batch, against the lattice.

The aim on two cores, after compilation: 0.2 ms a point in batches. An element is evaluated some ten
times until its inflow angle is found, 24 of them at a point; an evaluation is a look-up in the
polars and some fifty operations, about 100 ns, which makes 24 us a point on one core: the floor.
"""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np

import propmdao as pm
from propmdao.aerodynamics.solutions import axial, blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.records.states import RotorState

N_POINTS, FLOOR_S = 1000, 24e-6


def test_blade_elements(benchmark, slow_flyer_case, processor_time):
    """A point, a point of a batch, and the lattice at the same point."""
    state = RotorState(440.0, 4.0, pm.Air())
    one = slow_flyer_case(state, pm.Fidelity().wake).in_floats()
    speeds = jnp.asarray(np.linspace(0.0, 10.0, N_POINTS))

    @jax.jit
    def batch(case: RotorCase, speeds: jax.Array) -> jax.Array:
        def thrust(speed: jax.Array) -> jax.Array:
            state = dataclasses.replace(case.state, speed=speed)
            return blade_element.solve(dataclasses.replace(case, state=state)).thrust

        return jax.vmap(thrust)(speeds)

    alone = processor_time(lambda: blade_element.solve(one))
    lattice = processor_time(lambda: axial.solve(one))
    of_batch = processor_time(lambda: batch(one, speeds)) / N_POINTS
    benchmark.extra_info["processor_ms_alone"] = 1e3 * alone
    benchmark.extra_info["processor_ms_of_a_batch"] = 1e3 * of_batch
    benchmark.extra_info["processor_ms_lattice"] = 1e3 * lattice
    benchmark.extra_info["floor_s"] = N_POINTS * FLOOR_S
    benchmark.pedantic(lambda: jax.block_until_ready(batch(one, speeds)), rounds=3)

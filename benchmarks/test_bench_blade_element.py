"""Cost of blade elements, alone and in a batch, against the lattice.

The aim on two cores, after compilation: 0.2 ms a point in batches. An element is evaluated some ten
times until its inflow angle is found, 24 of them at a point; an evaluation is a look-up in the
polars and some fifty operations, about 100 ns, which makes 24 us a point on one core: the floor
that the table says.
"""

from __future__ import annotations

import dataclasses
import time

import jax
import jax.numpy as jnp
import numpy as np

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial, blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.records.states import RotorState

PROPELLER, FIDELITY = pm.load_propeller("apcsf_11x4.7"), pm.Fidelity()
N_POINTS, FLOOR_S = 1000, 24e-6


def case() -> RotorCase:
    """Return the slow flyer in slow flight, held to its polars."""
    blade = Blade.from_propeller(PROPELLER)
    span = lattice_interpolation(PROPELLER.r_over_R, FIDELITY.n_spanwise)
    middle = strip_interpolation(PROPELLER.r_over_R, FIDELITY.n_spanwise)
    nodes = lattice_nodes(blade, span, FIDELITY.n_chordwise)
    rotor = RotorGeometry(nodes, 0.5 * PROPELLER.diameter, PROPELLER.n_blades)
    state = RotorState(440.0, 4.0, pm.Air())
    return RotorCase(rotor, state, viscous_sections(polars_for(PROPELLER), blade, middle))


def processor_time(function) -> float:
    """Least time of the processor that a function takes once it is compiled [s]."""
    times = []
    for _ in range(6):
        start = time.process_time()
        jax.block_until_ready(function())
        times.append(time.process_time() - start)
    return min(times[1:])


def test_blade_elements(benchmark):
    """A point, a point of a batch, and the lattice at the same point."""
    one = case().in_floats()
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
    benchmark.extra_info["over_the_floor"] = of_batch / FLOOR_S
    benchmark.pedantic(lambda: jax.block_until_ready(batch(one, speeds)), rounds=3)

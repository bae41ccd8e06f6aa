"""Cost of flight at an incidence: the periodic lattice, and the adjoint against it.

The aims, on two cores and after compilation, with 8 x 24 panels, 36 azimuths and two blades: 1 s,
three analyses for the adjoint, 4 GiB. The processor's time is in ``extra_info`` as well: where
other processes share the machine, it is nearer to what a quiet one would take.
"""

from __future__ import annotations

import resource

import jax
import jax.numpy as jnp
import pytest

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeLaw

PROPELLER, FIDELITY = pm.load_propeller("apcsf_11x4.7"), pm.Fidelity()
STATE = RotorState(rotation_speed=440.0, speed=8.0, air=pm.Air(), incidence=jnp.radians(80.0))
ROUNDS = 3


@pytest.fixture(scope="module")
def nodes() -> jax.Array:
    span = lattice_interpolation(PROPELLER.r_over_R, FIDELITY.n_spanwise)
    return lattice_nodes(Blade.from_propeller(PROPELLER), span, FIDELITY.n_chordwise)


def solved(nodes: jax.Array) -> jax.Array:
    """Thrust and torque of the slow flyer at 80 deg, at the default resolution."""
    middle = strip_interpolation(PROPELLER.r_over_R, FIDELITY.n_spanwise)
    sections = viscous_sections(polars_for(PROPELLER), Blade.from_propeller(PROPELLER), middle)
    rotor = RotorGeometry(nodes, 0.5 * PROPELLER.diameter, PROPELLER.n_blades)
    wake = wake_transport(WakeLaw(), FIDELITY.period_wake)
    loads = periodic.solve(RotorCase(rotor, STATE, sections, wake, FIDELITY.n_azimuths))
    return jnp.stack([loads.thrust, loads.torque])


def test_periodic_lattice(benchmark, nodes, processor_time):
    """Loads at a rotation speed, and the adjoint of thrust and torque by all nodes."""
    solve = jax.jit(solved)

    @jax.jit
    def gradient(nodes: jax.Array) -> tuple[jax.Array, jax.Array]:
        value, pull = jax.vjp(solved, nodes)
        return value, jax.vmap(pull)(jnp.eye(2))[0]

    analysis, both = (processor_time(lambda f=f: f(nodes)) for f in (solve, gradient))
    benchmark.extra_info["analysis_processor_s"] = analysis
    benchmark.extra_info["analyses_with_adjoint"] = both / analysis
    benchmark.extra_info["peak_memory_gib"] = (
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    )
    benchmark.pedantic(lambda: jax.block_until_ready(solve(nodes)), rounds=ROUNDS)

"""Throughput of a population of blades: one by one, in one compiled loop, all at once.

The candidates of a differential evolution: blade to trimmed loads to tones. All at once is what an
accelerator asks for: run this once where there is one, JAX takes it by itself. On two cores the
processes of the driver's `n_workers` are what helps (`test_bench_workers.py`).
"""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.formulation1a import tones
from propmdao.acoustics.levels import oaspl_db
from propmdao.acoustics.observers import arc
from propmdao.aerodynamics.polars import polars_for
from propmdao.aerodynamics.section_laws import viscous_sections
from propmdao.aerodynamics.strips import strip_radii
from propmdao.aerodynamics.trim import rotation_bounds, solve_trimmed
from propmdao.fidelity import Fidelity
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.geometry.meshes import blade_meshes, mesh_radii
from propmdao.geometry.surface import surface_panels
from propmdao.propeller import load_propeller

PROPELLER = load_propeller("apcsf_11x4.7")
RADIUS, SPEED, DENSITY, SOUND, THRUST = 0.1397, 8.0, 1.225, 340.294, 1.2


@jax.jit
def evaluate(beta: jax.Array) -> jax.Array:
    """Torque [N m] and overall level [dB] of a blade with angles `beta` at the stations [rad]."""
    fidelity, stations = Fidelity(), PROPELLER.r_over_R
    blade = dataclasses.replace(Blade.from_propeller(PROPELLER), beta=beta)
    radii = mesh_radii(stations, fidelity.n_spanwise, fidelity.n_surface_span)
    lattice, surface = blade_meshes(blade, radii, fidelity.n_chordwise, fidelity.n_contour)
    middle = span_interpolation(stations, strip_radii(stations[0], fidelity.n_spanwise))
    sections = viscous_sections(polars_for(PROPELLER), blade, middle, SOUND)
    bounds = rotation_bounds(RADIUS, SPEED)
    omega, _, solution = solve_trimmed(
        lattice, 2, RADIUS, SPEED, DENSITY, THRUST, *bounds, sections
    )
    heard = tones(
        surface_panels(surface), solution.point_loads, 2, omega, SPEED, DENSITY, SOUND,
        arc(1.905, np.array([-45.0])), fidelity.n_harmonics,
    )  # fmt: skip
    return jnp.append(solution.torque, oaspl_db(heard.total))


WAYS = {
    "one_by_one": lambda population: jnp.stack([evaluate(beta) for beta in population]),
    "loop": jax.jit(lambda population: jax.lax.map(evaluate, population)),
    "all_at_once": jax.jit(jax.vmap(evaluate)),
}


@pytest.mark.parametrize("size", [8, 64])
@pytest.mark.parametrize("way", WAYS)
def test_population(benchmark, way, size):
    """Evaluate blades with angles up to two degrees from the propeller's."""
    rng = np.random.default_rng(1)
    twists = np.radians(rng.uniform(-2.0, 2.0, (size, 1)))
    population = jnp.asarray(Blade.from_propeller(PROPELLER).beta + twists)

    def run() -> None:
        assert np.isfinite(jax.block_until_ready(WAYS[way](population))).all()

    benchmark.extra_info["device"] = jax.devices()[0].device_kind
    benchmark.pedantic(run, rounds=3, warmup_rounds=1)
    benchmark.extra_info["blades_per_second"] = size / benchmark.stats.stats.min

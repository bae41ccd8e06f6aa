"""What an analysis costs: whole, parts, the kernel against its floor, and from a cold start.

The targets, on two cores and after compilation: 0.2 s with one microphone, 0.5 s with nine, half of
that wished for; `propmdao analyze` 15 s from a cold process, 5 s with compiled code kept.
"""

from __future__ import annotations

import os
import subprocess
import sys

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions.axial import WAKE_AGES, solve_steady
from propmdao.aerodynamics.trim import solve_rotation_speed
from propmdao.aerodynamics.vortices.biot_savart import filament_velocities
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.records.fidelity import Fidelity

SLOW_FLYER = load_propeller("apcsf_11x4.7")
NINE = [(1.905, float(elevation)) for elevation in np.linspace(-90.0, 90.0, 9)]
RADIUS, SPEED, DENSITY, THRUST, OMEGA = 0.1397, 8.0, 1.225, 1.2, 422.0


@pytest.fixture(scope="module")
def nodes():
    fidelity = Fidelity()
    stations = SLOW_FLYER.r_over_R
    span = lattice_interpolation(stations, fidelity.n_spanwise)
    return lattice_nodes(Blade.from_propeller(SLOW_FLYER), span, fidelity.n_chordwise)


@pytest.fixture(scope="module", params=["viscous", "inviscid"])
def sections(request):
    """Return what the lattice is held to; the aim for viscous flow is twice the time at most."""
    if request.param == "inviscid":
        return None
    stations = SLOW_FLYER.r_over_R
    middle = strip_interpolation(stations, Fidelity().n_spanwise)
    return viscous_sections(polars_for(SLOW_FLYER), Blade.from_propeller(SLOW_FLYER), middle, 340.0)


@pytest.mark.parametrize("broadband", [False, True], ids=["tones", "broadband"])
@pytest.mark.parametrize("viscous", [True, False], ids=["viscous", "inviscid"])
@pytest.mark.parametrize("observers", [NINE[2:3], NINE], ids=["one", "nine"])
def test_full_evaluation(benchmark, observers, viscous, broadband):
    """Geometry, trim, loads, tones on 65 x 80 panels, levels: what a user waits for."""
    options = {"viscous": viscous, "broadband": broadband, "observers": observers}

    def evaluate():
        analyze(SLOW_FLYER, thrust=THRUST, speed=SPEED, **options).to_dict()

    benchmark.pedantic(evaluate, rounds=10, warmup_rounds=2)


def test_steady_lattice(benchmark, nodes, sections):
    """Loads at a rotation speed, with their wake."""

    def solve():
        jax.block_until_ready(solve_steady(nodes, 2, RADIUS, OMEGA, SPEED, DENSITY, sections))

    benchmark.pedantic(solve, rounds=10, warmup_rounds=2)


def test_gradient(benchmark, nodes, sections):
    """Loads, and the adjoint of thrust and torque by all nodes and polars.

    The aim is four times `test_steady_lattice`.
    """

    @jax.jit
    def differentiate(nodes, sections):
        def loads(nodes, sections):
            solution = solve_steady(nodes, 2, RADIUS, OMEGA, SPEED, DENSITY, sections)
            return jnp.stack([solution.thrust, solution.torque])

        _, pull = jax.vjp(loads, nodes, sections)
        return jax.vmap(pull)(jnp.eye(2))

    benchmark.pedantic(
        lambda: jax.block_until_ready(differentiate(nodes, sections)), rounds=10, warmup_rounds=2
    )


def test_trim(benchmark, nodes, sections):
    """Rotation speed for a thrust."""
    required = SPEED, DENSITY, THRUST, 366.0, 576.0

    def solve():
        jax.block_until_ready(solve_rotation_speed(nodes, 2, RADIUS, *required, sections))

    benchmark.pedantic(solve, rounds=10, warmup_rounds=2)


def test_wake_kernel(benchmark):
    """Velocities of 2.25 million pairs of segments and points, as in one lattice solution.

    The floor is 1.2 ns a pair, 2.7 ms: C on an idle two-core machine with AVX-512.
    """
    rng = np.random.default_rng(0)
    points = jnp.asarray(rng.normal(size=(584, 3)))
    wake = jnp.asarray(rng.normal(size=(25, 2, WAKE_AGES.size, 3)))
    core = jnp.full(WAKE_AGES.size - 1, 1e-2)
    kernel = jax.jit(filament_velocities)
    benchmark.extra_info["pairs"] = 584 * 25 * 2 * (WAKE_AGES.size - 1)
    benchmark.pedantic(
        lambda: jax.block_until_ready(kernel(points, wake, core)), rounds=20, warmup_rounds=2
    )


@pytest.mark.parametrize("cache", ["cold", "warm"])
def test_command_line(benchmark, tmp_path, cache):
    """`propmdao analyze` as a process of its own, without and with compiled code kept."""
    command = [
        sys.executable,
        "-m",
        "propmdao",
        "analyze",
        "apcsf_11x4.7",
        "--thrust",
        "1.2",
    ]
    command += ["--speed", "8", "--arc", "1.905", "-45", "0", "--json"]
    rounds = 0

    def folder() -> tuple[tuple[str], dict[str, str]]:
        nonlocal rounds
        rounds += cache == "cold"
        return (str(tmp_path / f"cache{rounds}"),), {}

    def run(where: str) -> None:
        environment = os.environ | {"XDG_CACHE_HOME": where}
        subprocess.run(command, check=True, capture_output=True, env=environment)

    if cache == "warm":
        run(str(tmp_path / "cache0"))
    benchmark.pedantic(run, setup=folder, rounds=3)

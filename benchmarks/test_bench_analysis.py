"""Cost of an analysis: whole, parts, the kernel against its floor, and from a cold start.

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

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.trim import Bounds, solve_for_thrust
from propmdao.aerodynamics.vortices.biot_savart import filament_velocities
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.records.states import RotorState

SLOW_FLYER = pm.load_propeller("apcsf_11x4.7")
NINE = pm.arc(1.905, np.linspace(-90.0, 90.0, 9))
THRUST, STATE = 1.2, RotorState(rotation_speed=422.0, speed=8.0, air=pm.Air())


@pytest.fixture(scope="module")
def nodes():
    fidelity = pm.Fidelity()
    stations = SLOW_FLYER.r_over_R
    span = lattice_interpolation(stations, fidelity.n_spanwise)
    return lattice_nodes(Blade.from_propeller(SLOW_FLYER), span, fidelity.n_chordwise)


@pytest.fixture(scope="module", params=["viscous", "inviscid"])
def sections(request):
    """Return what the lattice is held to; the aim for viscous flow is twice the time at most."""
    if request.param == "inviscid":
        return None
    stations = SLOW_FLYER.r_over_R
    middle = strip_interpolation(stations, pm.Fidelity().n_spanwise)
    return viscous_sections(polars_for(SLOW_FLYER), Blade.from_propeller(SLOW_FLYER), middle)


def case_of(nodes, sections):
    """Return the slow flyer on a lattice; without sections in inviscid flow."""
    rotor = RotorGeometry(nodes, 0.5 * SLOW_FLYER.diameter, SLOW_FLYER.n_blades)
    return RotorCase(rotor, STATE, sections)


@pytest.mark.parametrize("broadband", [False, True], ids=["tones", "broadband"])
@pytest.mark.parametrize("viscous", [True, False], ids=["viscous", "inviscid"])
@pytest.mark.parametrize("observers", [NINE[2:3], NINE], ids=["one", "nine"])
def test_full_evaluation(benchmark, observers, viscous, broadband):
    """Geometry, trim, loads, tones on 65 x 80 panels, levels: what a user waits for."""
    options = {"viscous": viscous, "broadband": broadband, "observers": observers}

    def evaluate():
        pm.analyze(SLOW_FLYER, thrust=THRUST, speed=STATE.speed, **options).to_dict()

    benchmark.pedantic(evaluate, rounds=10, warmup_rounds=2)


def test_steady_lattice(benchmark, nodes, sections):
    """Loads at a rotation speed, with their wake."""
    case = case_of(nodes, sections)

    def solve():
        jax.block_until_ready(axial.solve(case))

    benchmark.pedantic(solve, rounds=10, warmup_rounds=2)


def test_gradient(benchmark, nodes, sections):
    """Loads, and the adjoint of thrust and torque by all nodes and polars.

    The aim is four times `test_steady_lattice`.
    """

    @jax.jit
    def differentiate(nodes, sections):
        def loads(nodes, sections):
            solution = axial.solve(case_of(nodes, sections))
            return jnp.stack([solution.thrust, solution.torque])

        _, pull = jax.vjp(loads, nodes, sections)
        return jax.vmap(pull)(jnp.eye(2))

    benchmark.pedantic(
        lambda: jax.block_until_ready(differentiate(nodes, sections)), rounds=10, warmup_rounds=2
    )


def test_trim(benchmark, nodes, sections):
    """Rotation speed for a thrust."""
    case, bounds = case_of(nodes, sections), Bounds(366.0, 576.0)

    def solve():
        jax.block_until_ready(solve_for_thrust(axial, case, THRUST, bounds))

    benchmark.pedantic(solve, rounds=10, warmup_rounds=2)


def test_wake_kernel(benchmark):
    """Velocities of 2.25 million pairs of segments and points, as in one lattice solution.

    The reference kernel does as many in C, on one core.
    """
    rng, n_nodes = np.random.default_rng(0), wake_transport().ages.size
    points = jnp.asarray(rng.normal(size=(584, 3)))
    start = jnp.asarray(rng.normal(size=(25, 2 * (n_nodes - 1), 3)))
    core = jnp.full(start.shape[1], 1e-2)
    kernel = jax.jit(filament_velocities)
    benchmark.pedantic(
        lambda: jax.block_until_ready(kernel(points, start, start + 0.1, core)),
        rounds=20,
        warmup_rounds=2,
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

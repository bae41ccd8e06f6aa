"""Fixtures of the benchmarks: the models that workers build, a rotor to solve, the clock."""

from __future__ import annotations

import importlib
import time
from collections.abc import Callable
from pathlib import Path

import jax
import pytest

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes, strip_interpolation
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw


@pytest.fixture(scope="session")
def models():
    """The module worker_models; workers find it by the path that they inherit."""
    with pytest.MonkeyPatch.context() as patch:
        patch.syspath_prepend(Path(__file__).parent)
        yield importlib.import_module("worker_models")


@pytest.fixture(scope="session")
def slow_flyer_case() -> Callable[[RotorState, WakeGrid], RotorCase]:
    """The slow flyer at the default resolution, held to its polars, in a state."""

    def slow_flyer_case(state: RotorState, grid: WakeGrid) -> RotorCase:
        propeller, fidelity = pm.load_propeller("apcsf_11x4.7"), pm.Fidelity()
        blade, stations = Blade.from_propeller(propeller), propeller.r_over_R
        span = lattice_interpolation(stations, fidelity.n_spanwise)
        nodes = lattice_nodes(blade, span, fidelity.n_chordwise)
        middle = strip_interpolation(stations, fidelity.n_spanwise)
        return RotorCase(
            RotorGeometry(nodes, 0.5 * propeller.diameter, propeller.n_blades),
            state,
            viscous_sections(polars_for(propeller), blade, middle),
            wake_transport(WakeLaw(), grid),
        )

    return slow_flyer_case


@pytest.fixture(scope="session")
def processor_time() -> Callable[[Callable[[], object]], float]:
    """Least time of the processor that a function takes once it is compiled [s]."""

    def processor_time(function: Callable[[], object]) -> float:
        jax.block_until_ready(function())
        times = []
        for _ in range(3):
            start = time.process_time()
            jax.block_until_ready(function())
            times.append(time.process_time() - start)
        return min(times)

    return processor_time

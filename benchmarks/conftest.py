"""Fixtures of the benchmarks: the models that workers build, a rotor to solve, the clock.

And what the JSON of a run says beside its times: the machine and how busy it was, versions, the
time of the reference kernel (`reference_kernel.c`), and ratios to it and to ``floor_s``, the floor
that a benchmark puts into its ``extra_info`` [s].
"""

from __future__ import annotations

import importlib.metadata
import os
import platform
import sys
import tempfile
import time
from collections.abc import Callable
from pathlib import Path
from typing import Any

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
from propmdao.runtime.side_by_side import n_cores

sys.path.insert(0, str(Path(__file__).parent))  # workers inherit it
import worker_models
from reference_kernel import reference_seconds

VERSIONS = ("jax", "jaxlib", "numpy", "scipy", "openmdao")


def pytest_benchmark_update_json(config, benchmarks, output_json: dict[str, Any]) -> None:
    """Add what times are to be compared with."""
    with tempfile.TemporaryDirectory() as folder:
        reference = reference_seconds(Path(folder))
    processor = output_json["machine_info"].get("cpu", {}).get("brand_raw", platform.machine())
    output_json["machine_info"] = {}  # it names the machine
    output_json["propmdao"] = {
        "processor": processor,
        "cores": n_cores(),
        "device": jax.devices()[0].device_kind,
        "system": platform.system(),
        "processes waiting": round(os.getloadavg()[0], 1) if hasattr(os, "getloadavg") else None,
        "python": platform.python_version(),
        "propmdao": pm.__version__,
        **{name: importlib.metadata.version(name) for name in VERSIONS},
        "reference_kernel_s": reference,
    }
    for benchmark in output_json["benchmarks"]:
        median, said = benchmark["stats"]["median"], benchmark["extra_info"]
        if reference is not None:
            said["over_reference"] = median / reference
        if "floor_s" in said:
            said["over_floor"] = median / said["floor_s"]


@pytest.fixture(scope="session")
def models():
    """The module worker_models, which workers import, too."""
    return worker_models


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

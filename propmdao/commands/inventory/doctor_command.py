"""Command line: ``propmdao doctor``."""

from __future__ import annotations

import argparse
import importlib.util
import os
import platform
import time
from pathlib import Path
from typing import Any

from propmdao.commands.options import add_command
from propmdao.commands.output.json_output import print_json
from propmdao.commands.output.results_folder import versions

DESCRIPTION = """\
What this installation has: versions, processor cores and accelerators, caches, extras; and whether
a small analysis runs. Put its output into a report of a fault.
"""
EXAMPLES = """\
examples:
  propmdao doctor
  propmdao doctor --json

Exit status: 0, or 2 with one line on stderr when the analysis does not run.
"""
#: Modules of each extra.
EXTRAS = {
    "plots": ("matplotlib",),
    "polars": ("neuralfoil",),
    "report": ("jinja2", "plotly"),
    "bench": ("starlette", "uvicorn", "websockets"),
    "parquet": ("pyarrow",),
    "doe": ("pydoe",),
    "parallel": ("distributed", "mpi4py"),
    "mission": ("dymos",),
    "completion": ("shtab",),
    "cad": ("OCP",),
}


def add_doctor(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands, "doctor", _doctor, "what this installation has, and whether it works",
        DESCRIPTION, EXAMPLES,
    )  # fmt: skip
    command.add_argument("--json", action="store_true", help="print JSON instead of lines")


def _doctor(options: argparse.Namespace) -> None:
    import jax

    from propmdao.runtime.caches import cache_folder

    started = time.perf_counter()
    check = _check()
    compiled = jax.config.jax_compilation_cache_dir  # type: ignore[attr-defined]
    installation = {
        "versions": versions(),
        "platform": platform.platform(),
        "processor cores": len(os.sched_getaffinity(0))
        if hasattr(os, "sched_getaffinity")
        else os.cpu_count(),
        "devices": [f"{device.platform}: {device.device_kind}" for device in jax.devices()],
        "compiled code": _folder(compiled),
        "polars": _folder(cache_folder("polars")),
        "extras": {
            name: all(importlib.util.find_spec(module) for module in modules)
            for name, modules in EXTRAS.items()
        },
        "check": {**check, "seconds": round(time.perf_counter() - started, 2)},
    }
    if options.json:
        print_json(installation)
        return
    from propmdao.commands.inventory.inventory_report import print_installation

    print_installation(installation)


def _check() -> dict[str, Any]:
    """Analyse a propeller of the catalogue on coarse meshes."""
    from propmdao.analysis.single_point import analyze
    from propmdao.formats.propellers import load_propeller
    from propmdao.records.fidelity import Fidelity

    coarse = Fidelity(2, 4, 5, 4, 2)
    propeller = load_propeller("apcsf_11x4.7")
    analysis = analyze(propeller, rpm=4200.0, observers=[[0.0, 1.9, -1.0]], fidelity=coarse)
    if not analysis.loads.converged:
        raise ValueError("the small analysis does not converge")
    return {"propeller": propeller.name, "rpm": 4200.0, "thrust": float(analysis.loads.thrust)}


def _folder(path: str | Path | None) -> dict[str, Any]:
    """Where a cache is and how much is in it."""
    if path is None:
        return {"folder": None, "files": 0, "megabytes": 0.0}
    files = [file for file in Path(path).rglob("*") if file.is_file()]
    size = sum(file.stat().st_size for file in files)
    return {"folder": str(path), "files": len(files), "megabytes": round(size / 1e6, 1)}

"""Throughput of a population of blades by the number that one compiled call has, and of a sweep.

``python benchmarks/population.py`` prints it for the devices that JAX finds, an accelerator where
there is one; ``--at-once 1 8 64 256`` chooses the batches, ``--points 256`` the points of a blade.
The benchmark `test_bench_population.py` keeps the same numbers.
"""

from __future__ import annotations

import argparse
import json
import time
from typing import Any

import jax
import numpy as np
import openmdao.api as om
import worker_models

import propmdao as pm
from propmdao.analysis.sweeping.batches import analyze_each
from propmdao.components.drivers.evaluation.design_batches import DesignBatches


class Population:
    """Blades with angles up to two degrees from those of the low-noise design, ready to run.

    Parameters
    ----------
    problem : om.Problem
        `worker_models.low_noise`, set up.
    at_once : int
        Blades that one call has; 1: one run of the model after the other.
    """

    def __init__(self, problem: om.Problem, at_once: int) -> None:
        problem.final_setup()
        self.problem, self.at_once = problem, at_once
        self.batches = DesignBatches(problem.model, at_once) if at_once > 1 else None

    @property
    def bytes_per_blade(self) -> int | None:
        """Memory on all devices that a blade takes, by the compiled code [B]."""
        if self.batches is None:
            return None
        return self.batches.memory * jax.local_device_count() // self.at_once

    def starts(self, n_blades: int, seed: int) -> list[np.ndarray]:
        """Outputs of the model before the runs of so many blades."""
        outputs = self.problem.model.get_nonlinear_vectors()[1]
        beta, rng = self.problem.get_val("beta_cp").copy(), np.random.default_rng(seed)
        starts = []
        for twist in np.radians(rng.uniform(-2.0, 2.0, n_blades)):
            self.problem.set_val("beta_cp", beta + twist)
            starts.append(outputs.asarray(copy=True))
        self.problem.set_val("beta_cp", beta)
        return starts

    def run(self, starts: list[np.ndarray]) -> None:
        """Trim, loads and tones of all blades."""
        if self.batches is not None:
            assert not any(run.ended_early for run in self.batches.run(starts))
            return
        outputs = self.problem.model.get_nonlinear_vectors()[1]
        for start in starts:
            outputs.set_val(start)
            self.problem.model.run_solve_nonlinear()


def throughput(at_once: int) -> dict[str, Any]:
    """Blades a second in calls of so many, after compilation, and what compiling took."""
    began = time.perf_counter()
    population = Population(worker_models.low_noise(), at_once)
    n_blades = max(at_once, 16)
    population.run(population.starts(at_once, 0))
    compiled = time.perf_counter()
    starts = population.starts(n_blades, 1)
    again = time.perf_counter()
    population.run(starts)
    seconds, size = time.perf_counter() - again, population.bytes_per_blade
    return {
        "at_once": at_once,
        "blades_per_second": round(n_blades / seconds, 2),
        "mib_per_blade": None if size is None else round(size / 2**20, 1),
        "first_call_s": round(compiled - began, 1),
    }


def swept(n_points: int) -> dict[str, Any]:
    """Points a second of one blade at rotation speeds, by the lattice without noise."""
    propeller = pm.load_propeller("apcsf_11x4.7")

    def seconds(shift: float) -> float:
        rpm = np.linspace(3000.0, 6000.0, n_points) + shift
        began = time.perf_counter()
        for outcome in analyze_each(propeller, [{"rpm": float(value)} for value in rpm]):
            outcome.said()
        return time.perf_counter() - began

    first, again = seconds(0.0), seconds(1.0)
    return {
        "points": n_points,
        "points_per_second": round(n_points / again, 2),
        "first_call_s": round(first, 1),
    }


def main() -> None:
    """Print a line for each batch and one for the points, as JSON."""
    parser = argparse.ArgumentParser(description=__doc__.split("\n\n")[0])
    parser.add_argument("--at-once", type=int, nargs="+", default=[1, 8, 64], metavar="N")
    parser.add_argument("--points", type=int, default=64, metavar="N")
    options = parser.parse_args()
    devices = {"device": jax.devices()[0].device_kind, "devices": jax.local_device_count()}
    print(json.dumps(devices | swept(options.points)), flush=True)
    for at_once in options.at_once:
        print(json.dumps(devices | throughput(at_once)), flush=True)


if __name__ == "__main__":
    main()

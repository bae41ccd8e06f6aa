"""Throughput of a population of blades: one after the other, and several in one compiled call.

The candidates of a differential evolution, blade to trimmed loads to tones, by the driver's option
`designs_at_once`. It is what an accelerator asks for: run this once where there is one, JAX takes
it by itself. On two cores 8 at once were 1.3 times as fast as one after the other (7.1 and 5.3 a
second), 64 slower (4.6), for they leave the caches; two processes (`n_workers`) are faster than any
of them (`test_bench_workers.py`). A blade takes 20 MB.
"""

from __future__ import annotations

import resource

import jax
import numpy as np
import pytest

from propmdao.components.drivers.evaluation.design_batches import DesignBatches

N_DESIGNS = 64


@pytest.fixture(scope="module")
def problem(models):
    """The low-noise design of `worker_models`, ready to run."""
    prob = models.low_noise()
    prob.final_setup()
    return prob


@pytest.mark.parametrize("at_once", [1, 8, 64])
def test_population(benchmark, problem, at_once):
    """Blades with angles up to two degrees from the propeller's, as many as are run at once."""
    outputs = problem.model.get_nonlinear_vectors()[1]
    beta, rng = problem.get_val("beta_cp").copy(), np.random.default_rng(1)

    def population() -> tuple[tuple[list], dict]:
        starts = []
        for twist in np.radians(rng.uniform(-2.0, 2.0, N_DESIGNS)):
            problem.set_val("beta_cp", beta + twist)
            starts.append(outputs.asarray(copy=True))
        return (starts,), {}

    def run(starts: list) -> None:
        if at_once > 1:
            runs = DesignBatches(problem.model, at_once).run(starts)
            assert not any(run.ended_early for run in runs)
            return
        for start in starts:
            outputs.set_val(start)
            problem.model.run_solve_nonlinear()

    benchmark.pedantic(run, setup=population, rounds=2, warmup_rounds=1)
    benchmark.extra_info["device"] = jax.devices()[0].device_kind
    benchmark.extra_info["blades_per_second"] = N_DESIGNS / benchmark.stats.stats.min
    benchmark.extra_info["peak_memory_gib"] = (
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    )

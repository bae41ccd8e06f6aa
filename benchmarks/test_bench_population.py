"""Throughput of a population of blades: one after the other, and several in one compiled call.

The candidates of a differential evolution, blade to trimmed loads to tones, by the driver's
option `designs_at_once`. It is what an accelerator asks for: where there is one JAX takes it by
itself, and `python benchmarks/population.py` prints the same without pytest. On two cores 8 at once
are no faster than one after the other, and 16 slower, for they leave the caches; two processes
(`n_workers`) are faster than any of them (`test_bench_workers.py`).
"""

from __future__ import annotations

import jax
import pytest
from population import Population

N_BLADES = 16


@pytest.mark.parametrize("at_once", [1, 8, 16])
def test_population(benchmark, models, at_once):
    """As many blades as 16, as many in a call as are run at once."""
    population, seeds = Population(models.low_noise(), at_once), iter(range(100))

    def starts() -> tuple[tuple[list], dict]:
        return (population.starts(N_BLADES, next(seeds)),), {}

    benchmark.pedantic(population.run, setup=starts, rounds=2, warmup_rounds=1)
    benchmark.extra_info["device"] = jax.devices()[0].device_kind
    if benchmark.stats:  # none where it is run without being timed
        benchmark.extra_info["blades_per_second"] = N_BLADES / benchmark.stats.stats.min
    if (size := population.bytes_per_blade) is not None:
        benchmark.extra_info["blade_bytes"] = size

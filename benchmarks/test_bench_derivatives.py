"""Cost of exact derivatives: an adjoint gradient against the analysis it belongs to.

The aim: objective and two constraints by 30 variables in no more than three analyses, in one run,
with no more than 2 GiB of memory. The ratio is in the benchmark's ``extra_info``.
"""

from __future__ import annotations

import resource
import time
from collections.abc import Callable
from itertools import count

import numpy as np
import openmdao.api as om
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import PropellerGroup
from propmdao.formats.propellers import load_propeller

RESPONSES = ["oaspl_db", "torque", "rpm"]
DISTRIBUTIONS = (
    "chord_over_R",
    "beta",
    "sweep_over_R",
    "thickness_over_chord",
    "camber_over_chord",
)
ROUNDS = 8


@pytest.fixture(scope="module")
def problem() -> om.Problem:
    """Thesis' propeller at 1.2 N and 8 m/s, one observer, thirty control points."""
    propeller = load_propeller("apcsf_11x4.7")
    points = np.linspace(propeller.r_over_R[0], 1.0, 6)
    prob = om.Problem(reports=False)
    prob.model.add_subsystem(
        "propeller",
        PropellerGroup(
            propeller=propeller,
            observers=arc(1.905, np.array([-45.0])),
            design_distributions=dict.fromkeys(DISTRIBUTIONS, points),
            control="values",
        ),
        promotes=["*"],
    )
    prob.setup(mode="rev")
    prob.set_val("speed", 8.0)
    return prob


def test_gradient_of_a_design(benchmark, problem):
    """Totals of the three responses, each after an analysis at a new design."""
    wrt = [f"{name}_cp" for name in DISTRIBUTIONS]
    thrusts = (1.2 + 0.001 * i for i in count())

    def analyse() -> None:
        # what has not changed is not computed again, so every run gets another thrust
        problem.set_val("thrust_required", next(thrusts))
        problem.run_model()

    def differentiate() -> None:
        totals = problem.compute_totals(of=RESPONSES, wrt=wrt)
        assert sum(block.shape[1] for block in totals.values()) == 30 * len(RESPONSES)

    analyse()
    differentiate()
    analysis, gradient = [], []
    for _ in range(ROUNDS):
        analysis.append(_seconds(analyse))
        gradient.append(_seconds(differentiate))
    benchmark.extra_info["analyses"] = min(gradient) / min(analysis)
    benchmark.extra_info["analysis_s"] = min(analysis)
    benchmark.extra_info["wanted_s"] = 3.0 * min(analysis)
    benchmark.extra_info["peak_memory_gib"] = (
        resource.getrusage(resource.RUSAGE_SELF).ru_maxrss / 2**20
    )
    benchmark.pedantic(differentiate, setup=analyse, rounds=ROUNDS)


def _seconds(function: Callable[[], None]) -> float:
    start = time.perf_counter()
    function()
    return time.perf_counter() - start

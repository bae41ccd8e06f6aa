"""Cost of many operating points of one blade: a sweep, a range of `analyze`, the nodes of a group.

The aims on two cores, after compilation: a sweep of 60 points of rpm and speed without noise 0.5 s.
The floor of a point is that of a steady solve on one core, half of it where there are two.
"""

from __future__ import annotations

import itertools
import time
from collections.abc import Callable

import numpy as np
import openmdao.api as om
import pytest

import propmdao as pm
from propmdao.analysis.results import Analysis
from propmdao.analysis.sweeping.batches import analyze_each
from propmdao.analysis.sweeping.points import grid
from propmdao.analysis.sweeping.sweeps import sweep
from propmdao.components import PropellerGroup

SLOW_FLYER = pm.load_propeller("apcsf_11x4.7")
RPM, SPEEDS = np.linspace(3000.0, 6000.0, 10).tolist(), np.linspace(0.0, 10.0, 6).tolist()
NODES = 16


@pytest.fixture
def with_processor_time(benchmark) -> Callable[[Callable[[], object], int], None]:
    """Benchmark a function, and say what of the processor it takes [s]."""

    def with_processor_time(function: Callable[[], object], rounds: int) -> None:
        taken = []

        def timed() -> None:
            start = time.process_time()
            function()
            taken.append(time.process_time() - start)

        benchmark.pedantic(timed, rounds=rounds, warmup_rounds=1)
        benchmark.extra_info["processor_s"] = min(taken)

    return with_processor_time


@pytest.mark.parametrize("blade_element", [False, True], ids=["lattice", "elements"])
def test_sweep_of_60_points(with_processor_time, tmp_path, blade_element):
    """Ten rotation speeds at six flight speeds, without noise, with the table."""
    number = itertools.count()

    def swept() -> None:
        path = tmp_path / f"{next(number)}.csv"
        new, failures = sweep(
            SLOW_FLYER, grid({"rpm": RPM, "speed": SPEEDS}), path, blade_element=blade_element
        )
        assert (new, failures) == (60, [])

    with_processor_time(swept, 3)


@pytest.mark.parametrize("observers", [0, 9])
def test_analyses_at_16_rotation_speeds(with_processor_time, observers):
    """What `propmdao analyze --rpm 3000:6000:200` does after it has started."""
    places = pm.arc(1.905, np.linspace(-90.0, 90.0, 9))[:observers]

    def analysed() -> None:
        asked = [{"rpm": rpm, "observers": places} for rpm in np.linspace(3000.0, 6000.0, NODES)]
        for outcome in analyze_each(SLOW_FLYER, asked):
            assert isinstance(outcome.result, Analysis)
            outcome.result.to_dict()

    with_processor_time(analysed, 3)


@pytest.fixture(scope="module")
def mission() -> om.Problem:
    """The group at 16 speeds, and the energy that it takes to fly at all of them."""
    prob = om.Problem(reports=False)
    group = PropellerGroup(
        propeller=SLOW_FLYER,
        num_nodes=NODES,
        design_distributions={"beta": [0.15, 0.5, 1.0]},
        control="values",
    )
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    energy = om.ExecComp("energy = sum(shaft_power)", shaft_power={"shape": (NODES,)})
    prob.model.add_subsystem("energy", energy, promotes=["*"])
    prob.setup(mode="rev")
    prob.set_val("speed", np.linspace(0.0, 10.0, NODES))
    return prob


def test_nodes_of_a_group(with_processor_time, mission):
    """Trim and loads at all of them."""
    thrusts = (1.2 + 0.001 * i for i in itertools.count())

    def run() -> None:
        mission.set_val("thrust_required", next(thrusts))  # of another point nothing is known
        mission.run_model()

    with_processor_time(run, 3)


def test_gradient_over_nodes(with_processor_time, mission):
    """Energy over all of them by three blade angles and the thrusts, run and derivatives."""
    thrusts = (2.2 + 0.001 * i for i in itertools.count())

    def run() -> None:
        mission.set_val("thrust_required", next(thrusts))
        mission.run_model()
        mission.compute_totals(of=["energy"], wrt=["beta_cp", "thrust_required"])

    with_processor_time(run, 3)

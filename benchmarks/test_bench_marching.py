"""Cost of marching in time, prescribed and free, and of a step against the length of the wake.

The targets, on two cores and after compilation, for four revolutions of two blades at an incidence
with 8 x 24 panels: 2 s prescribed and 10 s free at 10 deg, 8 s prescribed at 3 deg.
"""

from __future__ import annotations

from collections.abc import Callable

import jax
import pytest

import propmdao as pm
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.flow import march_flow
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.stepping import advance, march_start
from propmdao.records.fidelity import Marching
from propmdao.records.wake_law import WakeGrid

POINT = pm.OperatingPoint(rpm=4000.0, speed=8.0, incidence_deg=70.0)


@pytest.fixture(scope="module")
def case_of(slow_flyer_case) -> Callable[[float], RotorCase]:
    """The slow flyer in flight, with so many turns of wake."""
    state = POINT.at(POINT.rotation_speed)
    return lambda turns: slow_flyer_case(state, WakeGrid(turns, 0.25, 1.25, 10.0))


@pytest.mark.parametrize(
    ("timestep_deg", "wake_motion"), [(10.0, "prescribed"), (3.0, "prescribed"), (10.0, "free")]
)
def test_four_revolutions(benchmark, case_of, timestep_deg, wake_motion):
    schedule = Marching(timestep_deg=timestep_deg, wake_motion=wake_motion)
    case = case_of(4.0)
    march(case, schedule)
    loads = benchmark.pedantic(march, (case, schedule), rounds=2)
    assert loads.thrust > 0.0


@pytest.mark.parametrize("turns", [2.0, 4.0, 8.0])
@pytest.mark.parametrize("wake_motion", ["prescribed", "free"])
def test_step_against_the_length_of_the_wake(benchmark, case_of, turns, wake_motion):
    schedule = Marching(timestep_deg=10.0, wake_motion=wake_motion)
    flow = march_flow(case_of(turns), schedule)
    state = march_start(flow, schedule)
    advance(flow, state, 0.0)
    totals = benchmark(lambda: jax.block_until_ready(advance(flow, state, 0.0))[2])
    assert totals.thrust > 0.0

"""Bounds of a march: where it diverged, and what helps."""

import dataclasses

import jax.numpy as jnp
import pytest

from propmdao.aerodynamics.solutions.marching.flow import march_flow
from propmdao.aerodynamics.solutions.marching.limits import MarchError, require_bounded
from propmdao.aerodynamics.solutions.marching.stepping import StepTotals
from propmdao.records.fidelity import Marching

SCHEDULE = Marching(timestep_deg=30.0, wake_motion="free")
SOUND = StepTotals(jnp.asarray(1.0), jnp.asarray(0.1), jnp.full((1, 5), 0.5), jnp.asarray(0.1))


@pytest.fixture(scope="module")
def flow(slow_flyer):
    return march_flow(slow_flyer.case(nodes=slow_flyer.nodes(2, 5)), SCHEDULE)


@pytest.mark.parametrize("wrong", [30.0, float("nan")])
def test_circulation_beyond_its_bound_stops_the_march_with_its_place(flow, wrong):
    lift = SOUND.lift.at[0, 2].set(wrong)
    with pytest.raises(MarchError) as stopped:
        require_bounded(flow, dataclasses.replace(SOUND, lift=lift), 13, SCHEDULE)
    r = float(flow.lattice.period.lattice.strips.r_over_R[2])
    assert str(stopped.value) == (
        f"the march diverged at step 14 of 48: circulation of blade 1 at r/R {r:.2f}, azimuth 30"
        f" deg, is that of a lift coefficient of {wrong:.3g}; try a smaller timestep_deg, a free"
        " wake of a larger core or fewer turns, or the prescribed wake"
    )


def test_a_wake_that_flies_apart_stops_the_march(flow):
    with pytest.raises(MarchError, match="its wake has flown apart; try a smaller timestep_deg"):
        require_bounded(flow, dataclasses.replace(SOUND, extent=jnp.asarray(2.0)), 0, SCHEDULE)


def test_a_sound_step_goes_on(flow):
    require_bounded(flow, SOUND, 0, SCHEDULE)

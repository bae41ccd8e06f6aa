"""Order in time of a march at an incidence: circulation and thrust over half the step."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.records.air import Air
from propmdao.records.fidelity import Marching
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw

STEPS_DEG = 30.0, 15.0, 7.5


def at_twelve_azimuths(case, step_deg):
    """Circulation of the strips and thrust of the fourth revolution, every 30 deg."""
    loads = march(case, Marching(revolutions=4, average=1, timestep_deg=step_deg))
    every = round(30.0 / step_deg)
    last = loads.thrust_history[-round(360.0 / step_deg) :]
    return np.asarray(loads.circulation[::every, -1]), np.asarray(last[::every])


@pytest.mark.slow
def test_half_the_time_step_leaves_a_quarter_of_the_error_or_less(slow_flyer):
    case = dataclasses.replace(
        slow_flyer.case(nodes=slow_flyer.nodes(2, 5)),
        state=RotorState(440.0, 8.0, Air(), jnp.radians(70.0)),
        wake=wake_transport(WakeLaw(), WakeGrid(2.0, 0.25, 1.25, 10.0)),
    )
    of_steps = [at_twelve_azimuths(case, step) for step in STEPS_DEG]

    def order(k):
        apart = [
            np.linalg.norm(coarse[k] - fine[k])
            for coarse, fine in zip(of_steps[:-1], of_steps[1:], strict=True)
        ]
        return np.log2(apart[0] / apart[1])

    # The history is read by cubics; the rate of the circulation is a difference of second order.
    assert order(0) > 3.0
    assert 1.6 < order(1) < 2.4

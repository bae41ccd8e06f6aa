"""The march: from its start, step by step, to the mean of its last revolutions.

In axial flight one blade is marched and the others are its copies; at an incidence all are. The
wake's nodes have ages that do not depend on the time step, fine near the trailing edge, and their
circulation is read between the steps (`wakes.lags`): so a coarse step costs accuracy in time alone.

A prescribed wake moves by the law of the steady solution, with the induced velocity that momentum
theory has for the mean thrust of the last revolution.
"""

from __future__ import annotations

import time

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.flow import march_flow
from propmdao.aerodynamics.solutions.marching.limits import (
    memory_needed,
    require_bounded,
    require_memory,
)
from propmdao.aerodynamics.solutions.marching.marched_loads import (
    MarchedLoads,
    MarchProgress,
    Progress,
    changes,
)
from propmdao.aerodynamics.solutions.marching.mean import mean_loads
from propmdao.aerodynamics.solutions.marching.step import StepLoads
from propmdao.aerodynamics.solutions.marching.stepping import advance, march_start
from propmdao.aerodynamics.solutions.marching.wake_places import resting_wake
from propmdao.records.fidelity import Marching


def march(
    case: RotorCase,
    schedule: Marching = Marching(),  # noqa: B008 - frozen
    progress: Progress | None = None,
    snapshots: int = 0,
) -> MarchedLoads:
    """March a rotor in time; call it outside ``jit``.

    Parameters
    ----------
    case : RotorCase
        The rotor and how it turns and flies; the ages of its wake are best those of
        `Fidelity.period_wake`.
    schedule : Marching
        Length of the march, time step, start and wake.
    progress : callable, optional
        Called after every step.
    snapshots : int
        Number of moments, equally spaced over the march and the last one among them, at which the
        wake is kept.

    Returns
    -------
    MarchedLoads
        Mean of the last revolutions, and how it got there.

    Raises
    ------
    ValueError
        If the rotor does not turn, or the march needs too much memory; `MarchError` if it diverges.
    """
    if not float(case.state.rotation_speed) > 0.0:
        raise ValueError("a rotor that does not turn cannot be marched: rpm must be above 0")
    steps_per_turn, n_steps = schedule.steps_per_turn, schedule.n_steps
    flow = march_flow(case, schedule)
    memory = memory_needed(flow, schedule, snapshots)
    require_memory(memory)
    state = march_start(flow, schedule)
    kept: list[StepLoads] = []
    thrust, torque = np.zeros((2, n_steps))
    moments: list[tuple[float, Array]] = []
    begun = time.monotonic()
    unit = _thrust_unit(flow.case)
    done = 0
    for step in range(n_steps):
        azimuth = 2.0 * np.pi * step / steps_per_turn
        state, loads, totals = advance(flow, state, azimuth)
        require_bounded(flow, totals, step, schedule)
        thrust[step], torque[step] = float(totals.thrust), float(totals.torque)
        kept = [*kept[-(schedule.average * steps_per_turn - 1) :], loads]
        done = step + 1
        if done * snapshots // n_steps > step * snapshots // n_steps:
            reached = 2.0 * np.pi * done / steps_per_turn
            moments.append((reached, resting_wake(flow, state, reached)))
        if progress is not None:
            left = (time.monotonic() - begun) / done * (n_steps - done) if done > 1 else np.nan
            progress(MarchProgress(done, n_steps, thrust[step] / unit, left, memory))
        turned = schedule.stop_when_settled and done % steps_per_turn == 0
        if turned and _settled(changes(thrust[:done], steps_per_turn), schedule):
            break
    change = changes(thrust[:done], steps_per_turn)
    settled = _settled(change, schedule)
    mean = mean_loads(flow.case, flow.lattice, _stacked(kept), steps_per_turn)
    wake = resting_wake(flow, state, 2.0 * np.pi * done / steps_per_turn)
    azimuths = np.array([azimuth for azimuth, _ in moments])
    nodes = jnp.stack([nodes for _, nodes in moments]) if moments else wake[None][:0]
    of_mean = {name: getattr(mean, name) for name in mean.__dataclass_fields__}
    of_mean["converged"] = mean.converged & settled
    return MarchedLoads(
        **of_mean,
        thrust_history=jnp.asarray(thrust[:done]),
        torque_history=jnp.asarray(torque[:done]),
        change=jnp.asarray(change),
        settled=jnp.asarray(settled),
        wake=wake,
        wake_age=jnp.asarray(flow.case.wake.ages),
        snapshots=nodes,
        snapshot_azimuth=jnp.asarray(azimuths),
        average=schedule.average,
    )


def _thrust_unit(case: RotorCase) -> float:
    """Thrust of a coefficient of 1, rho n^2 D^4 [N]."""
    turns = float(case.state.rotation_speed) / (2.0 * np.pi)
    return float(case.state.air.density) * turns**2 * (2.0 * float(case.rotor.radius)) ** 4


def _stacked(kept: list[StepLoads]) -> StepLoads:
    """Loads of blade 1 at the last steps, with a leading axis."""
    return jax.tree.map(lambda *of_steps: jnp.stack(of_steps), *kept)


def _settled(change: np.ndarray, schedule: Marching) -> bool:
    """Whether the revolutions of the mean are alike."""
    n = max(schedule.average - 1, 1)
    return change.size >= n and bool((change[-n:] <= schedule.tolerance).all())

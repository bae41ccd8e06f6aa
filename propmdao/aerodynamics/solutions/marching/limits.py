"""What a march may need and how far it may go: memory, and bounds beyond which it has diverged."""

from __future__ import annotations

import numpy as np

from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.flow import MarchFlow
from propmdao.aerodynamics.solutions.marching.stepping import StepTotals
from propmdao.records.fidelity import Marching

#: Memory that a march may need [bytes].
MOST_MEMORY = 4 * 2**30
# Lift coefficient with the speeds of rotation and flight that no section has, and displacement of
# the wake at which it would have moved as fast as the tips.
_MOST_LIFT, _MOST_EXTENT = 25.0, 1.0
_TEMPORARIES = 8  # blocks of segments x points that a kernel holds at once


class MarchError(ValueError):
    """A march has diverged; the message says where, in one line."""


def memory_needed(flow: MarchFlow, schedule: Marching, snapshots: int) -> int:
    """Memory of the arrays of a march.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    schedule : Marching
        How it is marched.
    snapshots : int
        Moments at which the wake is kept.

    Returns
    -------
    int
        Memory, to a factor of two [bytes].
    """
    case: RotorCase = flow.case
    n_blades, m = case.rotor.n_blades, flow.n_marched
    nc, ns = case.rotor.nodes.shape[0] - 1, case.rotor.nodes.shape[1] - 1
    n_panels, n_segments = nc * ns, nc * (2 * ns + 1)
    n_points, n_forces = n_panels + n_segments, n_segments + n_panels + ns
    n_nodes = np.asarray(case.wake.ages).size
    wake = n_blades * (ns + 1) * n_nodes
    lattice = (1 + n_blades) * 3 * n_panels * n_points + 4 * n_blades * n_panels**2
    history = np.asarray(case.wake.ages)[-1] / (2.0 * np.pi) * schedule.steps_per_turn * m * ns
    kept = schedule.average * schedule.steps_per_turn * (3 * n_forces + n_panels)
    blocks = _TEMPORARIES * n_blades * n_nodes * n_segments
    total = lattice + 4 * history + 2 * kept + m * 16 * wake + blocks + 3 * snapshots * wake
    if flow.free is not None:
        moving = m * flow.free.edge.shape[0] * flow.free.ages.size
        total += 24 * moving + _TEMPORARIES * n_blades * flow.free.ages.size**2
    return int(8 * total)


def require_memory(needed: int) -> None:
    """Refuse a march that needs more memory than there is for one.

    Parameters
    ----------
    needed : int
        Memory of the march [bytes].

    Raises
    ------
    ValueError
        If it is too much.
    """
    if needed > MOST_MEMORY:
        raise ValueError(
            f"the march needs {needed / 2**30:.2g} GiB, and {MOST_MEMORY / 2**30:g} GiB are the"
            " limit: give fewer turns of wake, larger steps, fewer panels or fewer snapshots"
        )


def require_bounded(flow: MarchFlow, totals: StepTotals, step: int, schedule: Marching) -> None:
    """Stop a march that has diverged.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    totals : StepTotals
        What the step says of the rotor.
    step : int
        Number of the step, from 0.
    schedule : Marching
        How it is marched.

    Raises
    ------
    MarchError
        If circulation or wake are beyond their bounds, or no numbers.
    """
    lift, extent = np.abs(np.asarray(totals.lift)), float(totals.extent)
    if np.all(lift < _MOST_LIFT) and extent < _MOST_EXTENT and np.isfinite(float(totals.thrust)):
        return
    where = f"at step {step + 1} of {schedule.n_steps}"
    advice = "try a smaller timestep_deg"
    if schedule.wake_motion == "free":
        advice += ", a free wake of a larger core or fewer turns, or the prescribed wake"
    if extent < _MOST_EXTENT:
        blade, strip = np.unravel_index(np.nan_to_num(lift, nan=np.inf).argmax(), lift.shape)
        azimuth = (step * schedule.timestep_deg + 360.0 * blade / flow.case.rotor.n_blades) % 360.0
        r = float(flow.lattice.period.lattice.strips.r_over_R[strip])
        what = f"circulation of blade {blade + 1} at r/R {r:.2f}, azimuth {azimuth:.0f} deg,"
        raise MarchError(
            f"the march diverged {where}: {what} is that of a lift coefficient of"
            f" {lift[blade, strip]:.3g}; {advice}"
        )
    raise MarchError(f"the march diverged {where}: its wake has flown apart; {advice}")

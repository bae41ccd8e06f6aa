"""What a march has prepared before its first step, and what a step leaves to the next one."""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import LINE_POINTS
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.gusts import Gust, gust_of
from propmdao.aerodynamics.solutions.marching.step import MarchedLattice, Past, marched_lattice
from propmdao.aerodynamics.solutions.period.lattice import period_lattice
from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.free import FreeFilaments, FreeWakeState, free_filaments
from propmdao.aerodynamics.wakes.sheets import WakeParts, fewer_filaments
from propmdao.records.fidelity import Marching
from propmdao.records.pytrees import record, static
from propmdao.runtime.compilation import compiled

# Age from which on the wake has half as many filaments, but not fewer than so many: in hover it has
# passed two blades by then, closely. From 90 deg on the thrust there would be 3 % higher.
_FAR, _FEWEST = np.radians(450.0), 9


@record
class MarchFlow:
    """A case with the part of it that no step changes.

    Attributes
    ----------
    case : RotorCase
        Case that is marched, all numbers as floats.
    lattice : MarchedLattice
        Lattice of blade 1.
    timestep : float
        Time step [s].
    n_marched : int
        Blades that are marched: all, or one in axial flight.
    parts : WakeParts
        Parts of the wake.
    free : FreeFilaments or None
        Filaments of a free wake; None where it is prescribed.
    gust : Gust
        Gust that the rotor meets.
    """

    case: RotorCase
    lattice: MarchedLattice
    timestep: Array
    parts: WakeParts
    free: FreeFilaments | None
    gust: Gust
    n_marched: int = static()


@record
class MarchState:
    """What a step leaves to the next one.

    Attributes
    ----------
    past : Past
        Circulation at the steps before.
    thrust : (steps_per_turn,) array
        Thrust of all blades over the last revolution, the latest first [N].
    free : FreeWakeState or None
        Where a free wake is.
    """

    past: Past
    thrust: Array
    free: FreeWakeState | None


def march_flow(case: RotorCase, schedule: Marching) -> MarchFlow:
    """Prepare a case for a march; call it outside ``jit``.

    Parameters
    ----------
    case : RotorCase
        Case that is marched; it turns.
    schedule : Marching
        How it is marched.

    Returns
    -------
    MarchFlow
        The case with what no step changes.
    """
    case = case.in_floats()
    step = 2.0 * np.pi / schedule.steps_per_turn
    ages = np.asarray(case.wake.ages)
    axial_flight = float(case.state.edgewise_speed) == 0.0
    middle = np.asarray(middles(jnp.asarray(ages)))
    # The ring after the last one of less than two steps has a segment in common with it.
    n_young = min(int((middle < 2.0 * step).sum()) + 1, middle.size)
    timestep = jnp.asarray(step / case.state.rotation_speed)
    n_marched = 1 if axial_flight else case.rotor.n_blades
    lattice, free = _lattice(case), None
    edge = lattice.period.lattice.rings.corner[-1]
    chosen, to_strips = fewer_filaments(edge, max(edge.shape[0] // 2 + 1, _FEWEST))
    n_near = min(max(int((ages < _FAR).sum()), n_young), middle.size - 2)
    n_close = max(case.wake.n_near, n_young)
    is_read = lattice.period.n_chordwise > LINE_POINTS and n_close < n_near
    parts = WakeParts(
        jnp.asarray(chosen),
        jnp.asarray(to_strips),
        case.rotor.radius,
        n_young,
        n_near,
        n_close if is_read else None,
    )
    if schedule.wake_motion == "free":
        wanted = schedule.free_wake
        spacing = max(np.radians(wanted.step_deg), step)
        equal = spacing * np.arange(max(int(np.ceil(ages[-1] / spacing - 1e-9)), 3) + 1)
        core = wanted.core * case.rotor.radius
        free = free_filaments(edge, equal, wanted.turns, core, wanted.n_filaments)
    gust = gust_of(schedule)
    return MarchFlow(case, lattice, timestep, parts, free, gust, n_marched)


@compiled
def _lattice(case: RotorCase) -> MarchedLattice:
    return marched_lattice(period_lattice(case.rotor))

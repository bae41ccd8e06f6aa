"""The march: from its start, step by step, to the mean of its last revolutions.

In axial flight one blade is marched and the others are its copies; at an incidence all are. The
wake's nodes have ages that do not depend on the time step, fine near the trailing edge, and their
circulation is read between the steps (`wakes.lags`): so a coarse step costs accuracy in time alone.

A prescribed wake moves by the law of the steady solution, with the induced velocity that momentum
theory has for the mean thrust of the last revolution.
"""

from __future__ import annotations

import dataclasses
import time

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched_loads import (
    MarchedLoads,
    MarchProgress,
    Progress,
    changes,
)
from propmdao.aerodynamics.solutions.marching.mean import mean_loads
from propmdao.aerodynamics.solutions.marching.step import (
    MarchedLattice,
    Past,
    StepLoads,
    load_positions,
    marched_lattice,
    step_loads,
)
from propmdao.aerodynamics.solutions.period_lattice import period_lattice
from propmdao.aerodynamics.solutions.period_loads import tilted_onset
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.momentum import (
    lowest_induced_velocity,
    momentum_induced_velocity,
)
from propmdao.aerodynamics.wakes.sheets import Sheets
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.fidelity import Marching
from propmdao.records.pytrees import Scalar, record, static
from propmdao.runtime.compilation import compiled


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
    n_young : int
        Rings of the wake that may depend on the present, see `step_loads`.
    """

    case: RotorCase
    lattice: MarchedLattice
    timestep: Array
    n_marched: int = static()
    n_young: int = static()


@record
class MarchState:
    """What a step leaves to the next one.

    Attributes
    ----------
    past : Past
        Circulation at the steps before.
    thrust : (steps_per_turn,) array
        Thrust of all blades over the last revolution, the latest first [N].
    """

    past: Past
    thrust: Array

    @property
    def steps_per_turn(self) -> int:
        """Time steps of a revolution."""
        return self.thrust.shape[0]


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
        If the rotor does not turn.
    """
    if not float(case.state.rotation_speed) > 0.0:
        raise ValueError("a rotor that does not turn cannot be marched: rpm must be above 0")
    if schedule.wake == "free":
        raise ValueError("a free wake cannot be marched yet: wake must be prescribed")
    steps_per_turn, n_steps = schedule.steps_per_turn, schedule.n_steps
    flow = _flow(case, schedule)
    state = _start(flow, schedule)
    kept: list[StepLoads] = []
    thrust, torque = np.zeros((2, n_steps))
    moments: list[tuple[float, Array]] = []
    begun = time.monotonic()
    done = 0
    for step in range(n_steps):
        azimuth = 2.0 * np.pi * step / steps_per_turn
        state, loads, thrust[step], torque[step] = _advance(flow, state, azimuth)
        kept = [*kept[-(int(schedule.average) * steps_per_turn - 1) :], loads]
        done = step + 1
        if done * snapshots // n_steps > step * snapshots // n_steps:
            moments.append((azimuth, _resting_wake(flow, state, azimuth)))
        if progress is not None:
            left = (time.monotonic() - begun) / done * (n_steps - done) if done > 1 else np.nan
            progress(MarchProgress(done, n_steps, float(thrust[step]), left, 0))
        turned = schedule.stop_when_settled and done % steps_per_turn == 0
        if turned and _settled(changes(thrust[:done], steps_per_turn), schedule):
            break
    change = changes(thrust[:done], steps_per_turn)
    settled = _settled(change, schedule)
    mean = mean_loads(flow.case, flow.lattice, _stacked(kept), steps_per_turn)
    wake = _resting_wake(flow, state, 2.0 * np.pi * (done - 1) / steps_per_turn)
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
        snapshots=nodes,
        snapshot_azimuth=jnp.asarray(azimuths),
    )


def _stacked(kept: list[StepLoads]) -> StepLoads:
    """Loads of blade 1 at the last steps, with a leading axis."""
    return jax.tree.map(lambda *of_steps: jnp.stack(of_steps), *kept)


def _settled(change: np.ndarray, schedule: Marching) -> bool:
    """Whether the revolutions of the mean are alike."""
    n = max(int(schedule.average) - 1, 1)
    return change.size >= n and bool((change[-n:] <= schedule.tolerance).all())


def _flow(case: RotorCase, schedule: Marching) -> MarchFlow:
    """Prepare a case for a march."""
    case = case.in_floats()
    step = 2.0 * np.pi / schedule.steps_per_turn
    axial_flight = float(case.state.edgewise_speed) == 0.0
    middle = np.asarray(middles(jnp.asarray(case.wake.ages)))
    # The ring after the last one of less than two steps has a segment in common with it.
    n_young = min(int((middle < 2.0 * step).sum()) + 1, middle.size)
    timestep = jnp.asarray(step / case.state.rotation_speed)
    n_marched = 1 if axial_flight else case.rotor.n_blades
    return MarchFlow(case, _lattice(case), timestep, n_marched, n_young)


@compiled
def _lattice(case: RotorCase) -> MarchedLattice:
    return marched_lattice(period_lattice(case.rotor))


def _start(flow: MarchFlow, schedule: Marching) -> MarchState:
    """What there is before the first step: the steady solution in axial flight, or no wake."""
    state = flow.case.state
    ahead = dataclasses.replace(
        state, speed=jnp.maximum(state.axial_speed, 0.0), incidence=jnp.asarray(0.0)
    )
    steady = axial.solve(dataclasses.replace(flow.case, state=ahead))
    n, m = schedule.steps_per_turn, flow.n_marched
    ages = np.asarray(flow.case.wake.ages)
    n_lags = int(np.ceil(ages[-1] * n / (2.0 * np.pi))) + 4
    rings = jnp.broadcast_to(steady.circulation.ravel(), (2, m, steady.circulation.size))
    strips = jnp.broadcast_to(steady.circulation[-1], (n_lags, m, steady.circulation.shape[1]))
    begun = MarchState(Past(strips, rings), jnp.full(n, steady.thrust))
    if schedule.start == "steady":
        return begun
    none = dataclasses.replace(begun, past=Past(jnp.zeros_like(strips), rings))
    # The blow with which circulation appears is no force of any time: its rate begins at 0.
    first = _advance(flow, none, 0.0)[0].past.rings[0]
    return dataclasses.replace(none, past=Past(none.past.strips, jnp.stack([first, first])))


@compiled
def _advance(
    flow: MarchFlow, state: MarchState, azimuth: Scalar
) -> tuple[MarchState, StepLoads, Array, Array]:
    """Take a step: the state after it, loads of blade 1, thrust and torque of all blades."""
    case, period = flow.case, flow.lattice.period
    rotor, rotor_state = case.rotor, case.state
    w = _induced_velocity(case, state.thrust)
    azimuths = _azimuths(flow, azimuth)
    onset = tilted_onset(period.lattice, rotor_state, w, azimuths)
    ages, omega = jnp.asarray(case.wake.ages), rotor_state.rotation_speed
    turning = omega * period.lattice.strips.radius
    speed = jnp.hypot(turning, rotor_state.axial_speed + w)
    delay = shedding_delay(period.last_panel, speed * ages[1] / omega) / speed
    lag = (middles(ages) / omega + delay[:, None]) / flow.timestep
    medium = flow.timestep, rotor_state.air, case.sections
    loads = step_loads(
        flow.lattice, _sheets(flow, w, azimuths), lag, flow.n_young, onset, state.past, medium
    )
    ns = onset.relative_speed.shape[1]
    past = Past(
        jnp.concatenate([loads.circulation[None, :, -ns:], state.past.strips[:-1]]),
        jnp.stack([loads.circulation, state.past.rings[0]]),
    )
    copies = rotor.n_blades // flow.n_marched
    force = loads.force
    moment = jnp.cross(load_positions(flow.lattice), force)
    thrust, torque = copies * force[..., 2].sum(), -copies * moment[..., 2].sum()
    window = jnp.concatenate([thrust[None], state.thrust[:-1]])
    blade_1 = jax.tree.map(lambda of_blades: of_blades[0], loads)
    return MarchState(past, window), blade_1, thrust, torque


def _induced_velocity(case: RotorCase, thrust: Array) -> Array:
    """Induced velocity at the disk by the mean thrust of the last revolution."""
    state, radius = case.state, case.rotor.radius
    w = momentum_induced_velocity(thrust.mean(), state, radius)
    return jnp.maximum(w, lowest_induced_velocity(state, radius))


def _azimuths(flow: MarchFlow, azimuth: Scalar) -> Array:
    """Azimuths of the blades that are marched, (m,) [rad]."""
    return azimuth + jnp.asarray(flow.case.rotor.azimuths[: flow.n_marched])


def _sheets(flow: MarchFlow, w: Array, azimuths: Array) -> Sheets:
    """Wake of all blades, seen from each blade that is marched."""
    case, state = flow.case, flow.case.state
    ages, m = jnp.asarray(case.wake.ages), azimuths.size
    edge = flow.lattice.period.lattice.rings.corner[-1]
    helix = helical_wake(edge, case.wake, case.rotor, state, w)
    nodes = helix + sideways_drift(ages, azimuths, state)[:, None, None]

    def core(at: Array) -> Array:
        viscosity, initial = state.air.kinematic_viscosity, BOUND_CORE * case.rotor.radius
        radius = core_radius(at, state.rotation_speed, viscosity, initial)
        return jnp.broadcast_to(radius, (m, radius.size))

    return Sheets(nodes, core(middles(ages)), core(ages[:-1]))


@compiled
def _resting_wake(flow: MarchFlow, state: MarchState, azimuth: Scalar) -> Array:
    """Nodes of the wake of all blades in axes that do not turn, (n_blades, n_filaments, ...)."""
    w = _induced_velocity(flow.case, state.thrust)
    nodes = _sheets(flow, w, _azimuths(flow, azimuth)[:1]).nodes[0]
    cos, sin = jnp.cos(azimuth), jnp.sin(azimuth)
    x, y, z = jnp.moveaxis(nodes, -1, 0)
    return jnp.stack([cos * x - sin * y, sin * x + cos * y, z], axis=-1).swapaxes(0, 1)

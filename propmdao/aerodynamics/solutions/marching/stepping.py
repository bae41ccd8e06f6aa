"""From one time step to the next: what a march has prepared, what it remembers, how it goes on."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import (
    BOUND_CORE,
    ring_segments,
    segment_circulation,
    turned,
)
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.step import (
    MarchedLattice,
    Past,
    StepLoads,
    marched_lattice,
    seen_from_each,
    step_loads,
)
from propmdao.aerodynamics.solutions.period.lattice import period_lattice
from propmdao.aerodynamics.solutions.period.onset import tilted_onset
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.free import (
    FreeFilaments,
    FreeWakeState,
    free_filaments,
    induced_at_nodes,
    lattice_displacement,
    law_displacement,
    moved,
    placed,
    spun,
)
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.momentum import (
    lowest_induced_velocity,
    momentum_induced_velocity,
)
from propmdao.aerodynamics.wakes.sheets import Sheets, WakeParts, fewer_filaments
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.fidelity import Marching
from propmdao.records.pytrees import Scalar, record, static
from propmdao.runtime.compilation import compiled

# Azimuth by which the circulation of a wake may be older than its nodes: the last panels are short.
_LONGEST_DELAY = np.radians(20.0)
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
    """

    case: RotorCase
    lattice: MarchedLattice
    timestep: Array
    parts: WakeParts
    free: FreeFilaments | None
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


@record
class StepTotals:
    """What a step says of the whole rotor.

    Attributes
    ----------
    thrust, torque : float
        Thrust and torque of all blades [N], [N m].
    lift : (m, ns) array
        Lift coefficients of the sections, with the speeds of rotation and flight.
    extent : float
        Largest displacement of a free wake's nodes by what is induced, over the way of a blade's
        tip since they were shed and a radius more; 0 of a prescribed wake.
    """

    thrust: Array
    torque: Array
    lift: Array
    extent: Array


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
    parts = WakeParts(
        jnp.asarray(chosen), jnp.asarray(to_strips), case.rotor.radius, n_young, n_near
    )
    if schedule.wake_motion == "free":
        wanted = schedule.free_wake
        spacing = max(np.radians(wanted.step_deg), step)
        equal = spacing * np.arange(max(int(np.ceil(ages[-1] / spacing - 1e-9)), 3) + 1)
        core = wanted.core * case.rotor.radius
        free = free_filaments(edge, equal, wanted.turns, core, wanted.n_filaments)
    return MarchFlow(case, lattice, timestep, parts, free, n_marched)


@compiled
def _lattice(case: RotorCase) -> MarchedLattice:
    return marched_lattice(period_lattice(case.rotor))


def march_start(flow: MarchFlow, schedule: Marching) -> MarchState:
    """What there is before the first step: the steady solution in axial flight, or no wake.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    schedule : Marching
        How it is marched.

    Returns
    -------
    MarchState
        State before the first step.
    """
    state = flow.case.state
    # Edgewise flight leaves some axial speed by rounding, and hover has momentum theory of its own.
    tip_speed = state.rotation_speed * flow.case.rotor.radius
    speed = jnp.where(state.axial_speed > 1e-9 * tip_speed, state.axial_speed, 0.0)
    ahead = dataclasses.replace(state, speed=speed, incidence=jnp.asarray(0.0))
    steady = axial.solve(dataclasses.replace(flow.case, state=ahead))
    n, m = schedule.steps_per_turn, flow.n_marched
    ages = np.asarray(flow.case.wake.ages)
    n_lags = int(np.ceil((ages[-1] + _LONGEST_DELAY) * n / (2.0 * np.pi))) + 4
    rings = jnp.broadcast_to(steady.circulation.ravel(), (2, m, steady.circulation.size))
    strips = jnp.broadcast_to(steady.circulation[-1], (n_lags, m, steady.circulation.shape[1]))
    free = None if flow.free is None else _wake_by_law(flow, steady.induced_velocity)
    begun = MarchState(Past(strips, rings), jnp.full(n, steady.thrust), free)
    if schedule.start == "steady":
        return begun
    none = dataclasses.replace(begun, past=Past(jnp.zeros_like(strips), rings))
    # The blow with which circulation appears is no force of any time: its rate begins at 0.
    first = advance(flow, none, 0.0)[0].past.rings[0]
    return dataclasses.replace(none, past=Past(none.past.strips, jnp.stack([first, first])))


@compiled
def _wake_by_law(flow: MarchFlow, w: Array) -> FreeWakeState:
    """Free wake where the prescribed one is."""
    assert flow.free is not None
    shape = flow.n_marched, *flow.free.edge.shape[:1], flow.free.ages.size, 3
    there = jnp.broadcast_to(_law(flow, w), shape)
    spacing = flow.free.ages[1] / flow.case.state.rotation_speed
    rate = jnp.diff(there, axis=2, append=2.0 * there[:, :, -1:] - there[:, :, -2:-1]) / spacing
    return FreeWakeState(there, rate)


def _law(flow: MarchFlow, w: Array) -> Array:
    """Displacement of the free filaments by the prescribed law."""
    assert flow.free is not None
    case, free = flow.case, flow.free
    transport = dataclasses.replace(case.wake, ages=free.ages)
    helix = helical_wake(free.edge, transport, case.rotor, case.state, w)[:, 0]
    return law_displacement(free, helix, case.state)


@compiled
def advance(
    flow: MarchFlow, state: MarchState, azimuth: Scalar
) -> tuple[MarchState, StepLoads, StepTotals]:
    """Take a step.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    state : MarchState
        State after the step before.
    azimuth : float
        Azimuth of blade 1 [rad].

    Returns
    -------
    state, loads, totals : MarchState, StepLoads, StepTotals
        State after the step, loads of blade 1 and of the rotor at the step.
    """
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
        flow.lattice,
        _sheets(flow, state.free, w, azimuths),
        flow.parts,
        lag,
        onset,
        state.past,
        medium,
    )
    ns = onset.relative_speed.shape[1]
    past = Past(
        jnp.concatenate([loads.circulation[None, :, -ns:], state.past.strips[:-1]]),
        jnp.stack([loads.circulation, state.past.rings[0]]),
    )
    copies = rotor.n_blades // flow.n_marched
    force = loads.force
    moment = jnp.cross(period.load_positions, force)
    thrust, torque = copies * force[..., 2].sum(), -copies * moment[..., 2].sum()
    window = jnp.concatenate([thrust[None], state.thrust[:-1]])
    free, extent = None, jnp.asarray(0.0)
    if flow.free is not None:
        assert state.free is not None
        free = _moved_wake(flow, state.free, loads.circulation, past.strips, w, azimuths[0])
        reach = rotor.radius * (1.0 + flow.free.ages)
        extent = (jnp.linalg.norm(free.displacement, axis=-1) / reach).max()
    lift = (
        2.0
        * loads.circulation[:, -ns:]
        / (jnp.hypot(turning, rotor_state.speed) * period.lattice.strips.chord)
    )
    blade_1 = jax.tree.map(lambda of_blades: of_blades[0], loads)
    return MarchState(past, window, free), blade_1, StepTotals(thrust, torque, lift, extent)


def _moved_wake(
    flow: MarchFlow,
    wake: FreeWakeState,
    circulation: Array,
    strips: Array,
    w: Array,
    azimuth: Array,
) -> FreeWakeState:
    """Free wake after a step, moved by what blades and wake induce at its beginning."""
    assert flow.free is not None
    case, free, rings = flow.case, flow.free, flow.lattice.period.lattice.rings
    state, n_blades = case.state, case.rotor.n_blades
    nc, ns = rings.corner.shape[0] - 1, rings.corner.shape[1] - 1

    def of_all(marched: Array) -> Array:
        return seen_from_each(marched, n_blades)[0]

    nodes = placed(free.edge, of_all(wake.displacement), free.ages, azimuth, state)
    start, end = (turned(ends, case.rotor.azimuths).reshape(-1, 3) for ends in ring_segments(rings))
    strength = jax.vmap(segment_circulation)(of_all(circulation).reshape(n_blades, nc, ns))
    bound = start, end, strength.ravel()
    of_strips = of_all(strips.swapaxes(0, 1)).swapaxes(0, 1)
    lag = middles(free.ages) / state.rotation_speed / flow.timestep
    velocity = induced_at_nodes(free, nodes, of_strips, lag, bound, state, flow.n_marched)
    step = state.rotation_speed * flow.timestep
    return moved(free, wake, velocity, _law(flow, w), (step, flow.timestep))


def _induced_velocity(case: RotorCase, thrust: Array) -> Array:
    """Induced velocity at the disk by the mean thrust of the last revolution."""
    state, radius = case.state, case.rotor.radius
    w = momentum_induced_velocity(thrust.mean(), state, radius)
    return jnp.maximum(w, lowest_induced_velocity(state, radius))


def _azimuths(flow: MarchFlow, azimuth: Scalar) -> Array:
    """Azimuths of the blades that are marched, (m,) [rad]."""
    return azimuth + jnp.asarray(flow.case.rotor.azimuths[: flow.n_marched])


def _sheets(flow: MarchFlow, free: FreeWakeState | None, w: Array, azimuths: Array) -> Sheets:
    """Wake of all blades, seen from each blade that is marched."""
    case, rotor_state = flow.case, flow.case.state
    ages, m = jnp.asarray(case.wake.ages), azimuths.size
    edge = flow.lattice.period.lattice.rings.corner[-1]
    if flow.free is None:
        helix = helical_wake(edge, case.wake, case.rotor, rotor_state, w)
        nodes = helix + sideways_drift(ages, azimuths, rotor_state)[:, None, None]
    else:
        assert free is not None
        displacement = lattice_displacement(flow.free, free, ages)
        nodes = jax.vmap(lambda seen, azimuth: placed(edge, seen, ages, azimuth, rotor_state))(
            seen_from_each(displacement, case.rotor.n_blades), azimuths
        )

    def core(at: Array) -> Array:
        radius = core_radius(at, rotor_state, BOUND_CORE * case.rotor.radius)
        return jnp.broadcast_to(radius, (m, radius.size))

    return Sheets(nodes, core(middles(ages)), core(ages[:-1]))


@compiled
def resting_wake(flow: MarchFlow, state: MarchState, azimuth: Scalar) -> Array:
    """Nodes of the wake of all blades in axes that do not turn.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    state : MarchState
        State at the moment wanted.
    azimuth : float
        Azimuth of blade 1 then [rad].

    Returns
    -------
    (n_blades, n_filaments, n_nodes, 3) array
        Nodes of the lattice's filaments [m].
    """
    w = _induced_velocity(flow.case, state.thrust)
    nodes = _sheets(flow, state.free, w, _azimuths(flow, azimuth)).nodes[0]
    return spun(nodes, jnp.asarray(azimuth)).swapaxes(0, 1)

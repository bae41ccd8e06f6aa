"""Where the wake of a march is: by its law, or moved by the local velocity from step to step."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import (
    BOUND_CORE,
    ring_segments,
    segment_circulation,
    spun,
    turned,
)
from propmdao.aerodynamics.solutions.marching.flow import MarchFlow, MarchState
from propmdao.aerodynamics.solutions.marching.gusts import downstream, mean_of_turn
from propmdao.aerodynamics.solutions.marching.step import seen_from_each
from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.free import (
    FreeWakeState,
    induced_at_nodes,
    lattice_displacement,
    law_displacement,
    moved,
    placed,
)
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.momentum import (
    lowest_induced_velocity,
    momentum_induced_velocity,
)
from propmdao.aerodynamics.wakes.sheets import Sheets, aged_sheets
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.pytrees import Scalar
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled


def disk_velocity(flow: MarchFlow, thrust: Array, azimuth: Scalar) -> Array:
    """Induced velocity at the disk by the mean thrust of the last revolution.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    thrust : (steps_per_turn,) array
        Thrust of all blades over the last revolution [N].
    azimuth : float
        Azimuth of blade 1, turns counted [rad].

    Returns
    -------
    float
        Induced velocity by momentum theory, with the gust's mean over the revolution [m/s].
    """
    radius = flow.case.rotor.radius
    state = mean_of_turn(flow.gust, flow.case.state, azimuth)
    w = momentum_induced_velocity(thrust.mean(), state, radius)
    return jnp.maximum(w, lowest_induced_velocity(state, radius))


def azimuths_of_marched(flow: MarchFlow, azimuth: Scalar) -> Array:
    """Azimuths of the blades that are marched, (m,) [rad], by that of blade 1."""
    return azimuth + jnp.asarray(flow.case.rotor.azimuths[: flow.n_marched])


def sheets_at(flow: MarchFlow, free: FreeWakeState | None, w: Array, azimuth: Scalar) -> Sheets:
    """Wake of all blades, seen from each blade that is marched.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    free : FreeWakeState or None
        Where a free wake is.
    w : float
        Induced velocity at the disk [m/s].
    azimuth : float
        Azimuth of blade 1, turns counted [rad].

    Returns
    -------
    Sheets
        The wake, with a leading axis of the blades.
    """
    case, rotor_state = flow.case, flow.case.state
    ages, azimuths = jnp.asarray(case.wake.ages), azimuths_of_marched(flow, azimuth)
    distance = downstream(flow.gust, rotor_state, ages, azimuth)
    edge = flow.lattice.period.lattice.rings.corner[-1]
    if flow.free is None:
        mean = mean_of_turn(flow.gust, rotor_state, azimuth)
        helix = helical_wake(edge, case.wake, case.rotor, mean, w)
        # The law's stream is that of the mean; what was shed before a gust has not its whole way.
        helix = helix.at[..., 2].add(mean.axial_speed * ages / mean.rotation_speed - distance)
        nodes = helix + sideways_drift(ages, azimuths, rotor_state)[:, None, None]
    else:
        assert free is not None
        displacement = lattice_displacement(flow.free, free, ages)
        nodes = jax.vmap(lambda seen, at: placed(edge, seen, (ages, distance), at, rotor_state))(
            seen_from_each(displacement, case.rotor.n_blades), azimuths
        )
    core = BOUND_CORE * case.rotor.radius
    return jax.vmap(lambda seen: aged_sheets(seen, ages, rotor_state, core))(nodes)


@compiled
def wake_by_law(flow: MarchFlow, w: Array) -> FreeWakeState:
    """Free wake where the prescribed one is; its velocity, not known yet, is 0.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    w : float
        Induced velocity at the disk [m/s].

    Returns
    -------
    FreeWakeState
        Where the wake is.
    """
    assert flow.free is not None
    shape = flow.n_marched, *flow.free.edge.shape[:1], flow.free.ages.size, 3
    there = jnp.broadcast_to(_law(flow, flow.case.state, w), shape)
    return FreeWakeState(there, jnp.zeros(shape))


def _law(flow: MarchFlow, state: RotorState, w: Array) -> Array:
    """Displacement of the free filaments by the prescribed law."""
    assert flow.free is not None
    case, free = flow.case, flow.free
    transport = dataclasses.replace(case.wake, ages=free.ages)
    helix = helical_wake(free.edge, transport, case.rotor, state, w)[:, 0]
    return law_displacement(free, helix, state)


def moved_wake(
    flow: MarchFlow,
    wake: FreeWakeState,
    circulation: Array,
    strips: Array,
    w: Array,
    azimuth: Scalar,
) -> FreeWakeState:
    """Free wake after a step, moved by what blades and wake induce at its beginning.

    Parameters
    ----------
    flow : MarchFlow
        Case with what no step changes.
    wake : FreeWakeState
        Where it is.
    circulation : (m, n_panels) array
        Circulation of the rings [m^2/s].
    strips : (n_lags, m, ns) array
        Circulation of the strips at present, a step ago and so on [m^2/s].
    w : float
        Induced velocity at the disk [m/s].
    azimuth : float
        Azimuth of blade 1, turns counted [rad].

    Returns
    -------
    FreeWakeState
        Where it is after the step.
    """
    assert flow.free is not None
    case, free, rings = flow.case, flow.free, flow.lattice.period.lattice.rings
    state, n_blades = case.state, case.rotor.n_blades
    nc, ns = rings.corner.shape[0] - 1, rings.corner.shape[1] - 1

    def of_all(marched: Array) -> Array:
        return seen_from_each(marched, n_blades)[0]

    distance = downstream(flow.gust, state, free.ages, azimuth)
    shed = free.ages, distance
    nodes = placed(free.edge, of_all(wake.displacement), shed, jnp.asarray(azimuth), state)
    start, end = (turned(ends, case.rotor.azimuths).reshape(-1, 3) for ends in ring_segments(rings))
    strength = jax.vmap(segment_circulation)(of_all(circulation).reshape(n_blades, nc, ns))
    bound = start, end, strength.ravel()
    of_strips = of_all(strips.swapaxes(0, 1)).swapaxes(0, 1)
    lag = middles(free.ages) / state.rotation_speed / flow.timestep
    velocity = induced_at_nodes(free, nodes, of_strips, lag, bound, state, flow.n_marched)
    step = state.rotation_speed * flow.timestep
    by_law = _law(flow, mean_of_turn(flow.gust, state, azimuth), w)
    return moved(free, wake, velocity, by_law, (step, flow.timestep))


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
    w = disk_velocity(flow, state.thrust, azimuth)
    nodes = sheets_at(flow, state.free, w, azimuth).nodes[0]
    return spun(nodes, jnp.asarray(azimuth)).swapaxes(0, 1)

"""From one time step to the next: how a march begins, and how it goes on."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.marching.flow import MarchFlow, MarchState
from propmdao.aerodynamics.solutions.marching.gusts import in_gust
from propmdao.aerodynamics.solutions.marching.step import Past, StepLoads, step_loads
from propmdao.aerodynamics.solutions.marching.wake_places import (
    azimuths_of_marched,
    disk_velocity,
    moved_wake,
    sheets_at,
    wake_by_law,
)
from propmdao.aerodynamics.solutions.period.onset import tilted_onset
from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.records.fidelity import Marching
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime.compilation import compiled

# Azimuth by which the circulation of a wake may be older than its nodes: the last panels are short.
_LONGEST_DELAY = np.radians(20.0)


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
    free = None if flow.free is None else wake_by_law(flow, steady.induced_velocity)
    impulsive = schedule.start == "impulsive"
    past = Past(jnp.zeros_like(strips) if impulsive else strips, rings)
    begun = MarchState(past, jnp.full(n, steady.thrust), free)
    if free is None and not impulsive:
        return begun
    first = advance(flow, begun, 0.0)[0]
    if impulsive:
        # The blow with which circulation appears is no force of any time: its rate begins at 0.
        circulation = first.past.rings[0]
        past = Past(past.strips, jnp.stack([circulation, circulation]))
    if free is not None:
        # What moves from now on has no velocity before: with that of the law, or with none, the
        # first step would leave an error of first order.
        assert first.free is not None
        free = dataclasses.replace(free, velocity=first.free.velocity)
    return dataclasses.replace(begun, past=past, free=free)


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
        Azimuth of blade 1, turns counted [rad].

    Returns
    -------
    state, loads, totals : MarchState, StepLoads, StepTotals
        State after the step, loads of blade 1 and of the rotor at the step.
    """
    case, period = flow.case, flow.lattice.period
    rotor, rotor_state = case.rotor, case.state
    w = disk_velocity(flow, state.thrust, azimuth)
    met = in_gust(rotor_state, flow.gust.speed_at(azimuth))
    onset = tilted_onset(period.lattice, met, w, azimuths_of_marched(flow, azimuth))
    ages, omega = jnp.asarray(case.wake.ages), rotor_state.rotation_speed
    turning = omega * period.lattice.strips.radius
    speed = jnp.hypot(turning, met.axial_speed + w)
    delay = shedding_delay(period.last_panel, speed * ages[1] / omega) / speed
    lag = (middles(ages) / omega + delay[:, None]) / flow.timestep
    medium = flow.timestep, rotor_state.air, case.sections
    loads = step_loads(
        flow.lattice,
        sheets_at(flow, state.free, w, azimuth),
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
        free = moved_wake(flow, state.free, loads.circulation, past.strips, w, azimuth)
        reach = rotor.radius * (1.0 + flow.free.ages)
        extent = (jnp.linalg.norm(free.displacement, axis=-1) / reach).max()
    lift = (
        2.0
        * loads.circulation[:, -ns:]
        / (jnp.hypot(turning, rotor_state.speed) * period.lattice.strips.chord)
    )
    blade_1 = jax.tree.map(lambda of_blades: of_blades[0], loads)
    return MarchState(past, window, free), blade_1, StepTotals(thrust, torque, lift, extent)

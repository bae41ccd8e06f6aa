"""Periodic lattice: loads of a rotor whose shaft stands at an angle to the flight.

Around a turn the air meets the blade ever differently, and every turn is like the one before. So
the circulation of all azimuths is one problem (`period.loads`), in a wake that the free stream and
the induced velocity w carry (`wakes.skewed`); w follows from the mean thrust by Glauert's momentum
theory of the tilted disk, as in axial flight. Without incidence this is the steady solution.

`solve` is the solution at a rotation speed. `flow_at`, `rough`, `evaluate` and `solution` are what
a trim needs of it (`propmdao.aerodynamics.trim.Solver`).
"""

from __future__ import annotations

import dataclasses
from functools import partial

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import spun
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.elements import rough
from propmdao.aerodynamics.solutions.period.flow import (
    TiltedFlow,
    flow_at,
    induced_velocity,
    loads_at,
    mean_thrust,
)
from propmdao.aerodynamics.solutions.period.guess import bracket, coarse_root, momentum_less
from propmdao.aerodynamics.solutions.period.loads import PeriodBladeLoads
from propmdao.aerodynamics.solutions.period.onset import azimuths_of, tilted_onset
from propmdao.aerodynamics.solutions.point_sums import strip_loads
from propmdao.aerodynamics.solutions.result import (
    TiltedLoads,
    sections_agree,
    unless_still,
)
from propmdao.aerodynamics.solutions.roots import at_root, decreasing_root, empty
from propmdao.aerodynamics.wakes.momentum import within_momentum_theory
from propmdao.records.loads import PeriodicLoads
from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled

__all__ = [
    "TiltedFlow",
    "evaluate",
    "flow_at",
    "induced_velocity",
    "loads_at",
    "mean_thrust",
    "rough",
    "solution",
    "solve",
    "tilted_loads",
]

_TOLERANCE = 1.0e-7  # relative, in the induced velocity: 1e-8 of the loads, by a straight line


_Params = tuple[TiltedFlow, Array]  # with the thrust guessed


@compiled
def solve(case: RotorCase, thrust_guess: Scalar = 0.0) -> TiltedLoads:
    """Solve the periodic lattice with its own wake.

    Parameters
    ----------
    case : RotorCase
        The rotor and how it turns and flies; a rotation speed of 0 gives zero loads.
    thrust_guess : float
        Guess of the mean thrust of all blades [N]: it saves work and does not change the result. 0
        is no guess.

    Returns
    -------
    TiltedLoads
        Loads, exactly differentiable in every argument but the guess.
    """
    turning, moving = case.never_still()
    flow = flow_at(moving)

    def evaluate(params: _Params, w: Array) -> PeriodBladeLoads:
        return loads_at(params[0], w)

    def again(params: _Params, w: Array, known: PeriodBladeLoads) -> PeriodBladeLoads:
        return loads_at(params[0], w, known.recambering)

    def residual(params: _Params, w: Array, loads: PeriodBladeLoads) -> Array:
        return momentum_less(params[0], w, loads)

    def search(params: _Params) -> tuple[Array, PeriodBladeLoads, None]:
        flow, thrust_guess = params

        def trial(w: Array, last: PeriodBladeLoads) -> tuple[Array, PeriodBladeLoads]:
            loads = again(params, w, last)
            return residual(params, w, loads), loads

        low, high = bracket(flow)
        known = coarse_root(flow, thrust_guess)
        none = empty(partial(evaluate, params), known.root)
        guess = known.holding(dataclasses.replace(none, recambering=known.results))
        w, loads = decreasing_root(trial, low, high, guess, _TOLERANCE, straight=True)
        return w, loads, None

    params = (flow, jnp.asarray(thrust_guess, float))
    w, loads, _ = at_root(search, evaluate, residual, params, again)
    return unless_still(turning, tilted_loads(flow, w, loads))


def evaluate(
    flow: TiltedFlow, thrust_required: Scalar, rotation_speed: Scalar
) -> tuple[Array, PeriodBladeLoads]:
    """Thrust at a rotation speed, in the wake that the thrust required transports.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    thrust_required : float
        Mean thrust of all blades [N].
    rotation_speed : float
        Rotation speed of the trial [rad/s].

    Returns
    -------
    thrust, loads : float, PeriodBladeLoads
        Mean thrust of all blades [N], loads of blade 1.
    """
    flow = flow.turning(rotation_speed)
    loads = loads_at(flow, induced_velocity(flow, thrust_required))
    return mean_thrust(flow, loads), loads


def solution(
    flow: TiltedFlow, thrust_required: Scalar, rotation_speed: Scalar, loads: PeriodBladeLoads
) -> TiltedLoads:
    """Loads of the rotor from those of a blade that `evaluate` returned.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    thrust_required : float
        Mean thrust of all blades [N].
    rotation_speed : float
        Rotation speed at which the thrust is the one required [rad/s].
    loads : PeriodBladeLoads
        Loads of blade 1 at that rotation speed.

    Returns
    -------
    TiltedLoads
        Loads of all blades.
    """
    flow = flow.turning(rotation_speed)
    return tilted_loads(flow, induced_velocity(flow, thrust_required), loads)


def tilted_loads(
    flow: TiltedFlow, induced_velocity_at_disk: Array, loads: PeriodBladeLoads
) -> TiltedLoads:
    """Loads of the rotor from those of a blade.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    induced_velocity_at_disk : float
        Induced velocity that transported the wake [m/s].
    loads : PeriodBladeLoads
        Loads of blade 1 in that wake.

    Returns
    -------
    TiltedLoads
        Loads of all blades.
    """
    rotor, state = flow.case.rotor, flow.case.state
    w, thrust = induced_velocity_at_disk, mean_thrust(flow, loads)
    psi = jnp.asarray(azimuths_of(loads.circulation.shape[0]))
    # In the axes that do not turn.
    force, moment = spun(loads.hub_force, psi), spun(loads.hub_moment, psi)
    hub_force, hub_moment = (rotor.n_blades * of_blade.mean(axis=0) for of_blade in (force, moment))
    tip_speed = state.rotation_speed * rotor.radius
    agrees = jnp.abs(induced_velocity(flow, thrust) - w) < 1.0e-6 * tip_speed
    within = within_momentum_theory(thrust, state, rotor.radius)
    onset = tilted_onset(flow.lattice.lattice, state, w, psi)
    strip_thrust, strip_torque = strip_loads(
        loads.position, loads.force.mean(axis=0), *loads.circulation.shape[1:]
    )
    return TiltedLoads(
        thrust=thrust,
        torque=-hub_moment[2],
        hub_force=hub_force,
        hub_moment=hub_moment,
        blade_force=force,
        blade_moment=moment,
        strip_thrust=strip_thrust,
        strip_torque=strip_torque,
        induced_velocity=w,
        circulation=loads.circulation,
        point_loads=PeriodicLoads(loads.position, -loads.force),
        strips=flow.lattice.lattice.strips,
        sections=loads.sections,
        attached=onset.attached,
        converged=agrees & within & sections_agree(loads.sections),
    )

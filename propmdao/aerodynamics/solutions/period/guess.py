"""Where the search for the induced velocity of a period begins: the solution of a coarse lattice.

Work goes with the square of the azimuths and with the nodes of the wake. Every third of both, and
half of the chordwise panels, take a twentieth of the work; their induced velocity is within a per
cent of the solution's, and the slope of their residual within a few. That saves three trials.
"""

from __future__ import annotations

import dataclasses
from functools import partial
from typing import NamedTuple

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.solutions.period.flow import (
    TiltedFlow,
    flow_at,
    induced_velocity,
    loads_at,
    mean_thrust,
)
from propmdao.aerodynamics.solutions.period.loads import PeriodBladeLoads
from propmdao.aerodynamics.solutions.result import sections_agree
from propmdao.aerodynamics.solutions.roots import Guess, decreasing_root, empty
from propmdao.aerodynamics.wakes.momentum import lowest_induced_velocity
from propmdao.records.pytrees import Scalar

_COARSE_TOLERANCE = 1.0e-4  # relative, in the induced velocity
_GUESS = 0.05  # of the tip speed
_LEAST_AZIMUTHS = 12
# Slope of the residual: about -1, for w moves the wake alone, and a wake that leaves faster takes
# less of the thrust away.
_STEEPEST, _FLATTEST = -10.0, -0.5


def momentum_less(flow: TiltedFlow, w: Scalar, loads: PeriodBladeLoads) -> Array:
    """Induced velocity of momentum theory less the one in whose wake the loads are.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    w : float
        Induced velocity at the disk [m/s].
    loads : PeriodBladeLoads
        Loads in its wake.

    Returns
    -------
    float
        What is missing, 0 at the solution [m/s].
    """
    return induced_velocity(flow, mean_thrust(flow, loads)) - w


def bracket(flow: TiltedFlow) -> tuple[Array, Scalar]:
    """Induced velocities between which that of the rotor lies [m/s]."""
    state, radius = flow.case.state, flow.case.rotor.radius
    return lowest_induced_velocity(state, radius), state.rotation_speed * radius


def coarse_root(flow: TiltedFlow, thrust_guess: Array) -> Guess[Array]:
    """Solution of a coarse lattice, as a guess of that of the fine one.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    thrust_guess : float
        Guess of the mean thrust of all blades [N]; 0 is no guess.

    Returns
    -------
    Guess
        Induced velocity [m/s], slope of its residual, and the recambering at the azimuths of the
        fine lattice, (n_azimuths, ns) [rad].
    """
    coarse = _coarsened(flow)
    guess = induced_velocity(flow, jnp.where(thrust_guess == 0.0, _hovering(flow), thrust_guess))

    def trial(w: Array, last: _Trial) -> tuple[Array, _Trial]:
        loads = loads_at(coarse, w, last.loads.recambering)
        missing = momentum_less(coarse, w, loads)
        slope = (missing - last.missing) / (w - last.w)
        return missing, _Trial(loads, w, missing, slope)

    zero = jnp.zeros(())
    start = _Trial(empty(partial(loads_at, coarse), guess), zero, zero, zero)
    low, high = bracket(coarse)
    w, end = decreasing_root(
        trial, low, high, Guess(guess, start), _COARSE_TOLERANCE, straight=True
    )
    between = jnp.asarray(_between_azimuths(coarse.n_azimuths, flow.n_azimuths))
    settled = sections_agree(end.loads.sections)
    recambering = jnp.where(settled, between @ end.loads.recambering, 0.0)
    return Guess(w, recambering, jnp.clip(end.slope, _STEEPEST, _FLATTEST))


class _Trial(NamedTuple):
    """Trial of the coarse search."""

    loads: PeriodBladeLoads
    w: Array
    missing: Array
    slope: Array  # through this trial and the one before


def _coarsened(flow: TiltedFlow) -> TiltedFlow:
    """The same flow with every third azimuth and wake node, and half of the chordwise panels."""
    case, rotor = flow.case, flow.case.rotor
    ages, n_chordwise = jnp.asarray(case.wake.ages), rotor.nodes.shape[0] - 1
    every = 2 if n_chordwise % 2 == 0 and n_chordwise > 2 else 1
    return flow_at(
        dataclasses.replace(
            case,
            rotor=dataclasses.replace(rotor, nodes=rotor.nodes[::every]),
            wake=dataclasses.replace(case.wake, ages=jnp.append(ages[:-1:3], ages[-1])),
            n_azimuths=max(-(-flow.n_azimuths // 3), min(_LEAST_AZIMUTHS, flow.n_azimuths)),
        )
    )


def _between_azimuths(n_given: int, n: int) -> np.ndarray:
    """Matrix from values at equally spaced azimuths to values in between, around the turn."""
    place = np.arange(n) * n_given / n
    return np.array(
        [np.interp(place, np.arange(n_given + 1), [*x, x[0]]) for x in np.eye(n_given)]
    ).T


def _hovering(flow: TiltedFlow) -> Array:
    """Thrust [N] of a hovering rotor whose induced velocity is `_GUESS` of the tip speed."""
    state, rotor = flow.case.state, flow.case.rotor
    w = _GUESS * state.rotation_speed * rotor.radius
    return 2.0 * state.air.density * jnp.asarray(rotor.disk_area) * w**2

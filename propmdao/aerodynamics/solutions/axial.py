"""Steady lattice in the rotating frame: loads of a rotor in axial flight.

The wake is carried by the free stream and by the induced velocity w, w follows from the thrust by
momentum theory, and the thrust from the lattice in that wake: one scalar equation,
w = momentum(thrust(w)), whatever the flight speed; hover is V = 0.

`solve` is the solution at a rotation speed. `flow_at`, `rough`, `evaluate` and `solution` are what
a trim needs of it (`propmdao.aerodynamics.trim.Solver`).
"""

from __future__ import annotations

from functools import partial
from typing import NamedTuple

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.lattice.steady_wake import steady_wake
from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.elements import axial_rough as rough
from propmdao.aerodynamics.solutions.elements import rough_thrust
from propmdao.aerodynamics.solutions.lattice_loads import (
    BladeInfluence,
    LatticeGeometry,
    LatticeLoads,
    axial_onset,
    blade_influence_of,
    lattice_geometry,
    loads_with_wake,
)
from propmdao.aerodynamics.solutions.point_sums import strip_loads
from propmdao.aerodynamics.solutions.result import (
    RotorLoads,
    sections_agree,
    unless_still,
)
from propmdao.aerodynamics.solutions.roots import Guess, at_root, decreasing_root, empty
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.momentum import (
    axial_induced_velocity,
    lowest_induced_velocity,
    within_momentum_theory,
)
from propmdao.records.loads import PointLoads
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime.compilation import compiled

__all__ = [
    "AxialFlow",
    "evaluate",
    "flow_at",
    "induced_velocity",
    "loads_at",
    "rotor_loads",
    "rough",
    "solution",
    "solve",
]

_TOLERANCE = 1.0e-12  # relative, in the induced velocity
_ROUGH_TOLERANCE = 1.0e-3
_GUESS = 0.05  # of the tip speed
_STEEPEST, _FLATTEST = -5.0, -1.0  # slopes that a guess may have


@record
class AxialFlow:
    """A case with the part of its lattice that no operating point changes.

    Attributes
    ----------
    case : RotorCase
        Case to solve; its rotation speed is not 0.
    lattice : LatticeGeometry
        Lattice of blade 1.
    blades : BladeInfluence
        What the rings of all blades induce on it.
    """

    case: RotorCase
    lattice: LatticeGeometry
    blades: BladeInfluence

    @property
    def strips(self) -> Strips:
        """Sections of blade 1."""
        return self.lattice.strips

    def turning(self, rotation_speed: Scalar) -> AxialFlow:
        """The same flow at another rotation speed [rad/s]."""
        return AxialFlow(self.case.turning(rotation_speed), self.lattice, self.blades)


_Params = tuple[AxialFlow, Array]  # with the thrust guessed


def flow_at(case: RotorCase) -> AxialFlow:
    """Prepare a case by the part of its lattice that no operating point changes.

    Parameters
    ----------
    case : RotorCase
        Case to solve.

    Returns
    -------
    AxialFlow
        The case with its lattice, all numbers as floats.
    """
    case = case.in_floats()
    lattice = lattice_geometry(case.rotor)
    return AxialFlow(case, lattice, blade_influence_of(lattice, case.rotor))


def induced_velocity(flow: AxialFlow, thrust: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    flow : AxialFlow
        Case with its lattice.
    thrust : float
        Thrust of all blades [N].

    Returns
    -------
    float
        Induced velocity [m/s].
    """
    return axial_induced_velocity(thrust, flow.case.state, flow.case.rotor.radius)


@compiled
def loads_at(flow: AxialFlow, induced_velocity: Scalar) -> LatticeLoads:
    """Loads of blade 1 in the wake that a given induced velocity transports.

    Parameters
    ----------
    flow : AxialFlow
        Case with its lattice.
    induced_velocity : float
        Induced velocity at the disk [m/s].

    Returns
    -------
    LatticeLoads
        Loads of blade 1.
    """
    case, lattice = flow.case, flow.lattice
    rotor, state = case.rotor, case.state
    nodes = helical_wake(lattice.rings.corner[-1], case.wake, rotor, state, induced_velocity)
    core = core_radius(middles(jnp.asarray(case.wake.ages)), state, BOUND_CORE * rotor.radius)
    rings = case.wake.n_near, case.wake.n_turn
    wake = steady_wake(lattice.points, lattice.lines, nodes, core, rings)
    onset = axial_onset(lattice, state, induced_velocity)
    return loads_with_wake(lattice, flow.blades, wake, onset, state.air, case.sections)


@compiled
def solve(case: RotorCase, thrust_guess: Scalar = 0.0) -> RotorLoads:
    """Solve the steady lattice with its own wake.

    Parameters
    ----------
    case : RotorCase
        The rotor and how it turns and flies; a rotation speed of 0 gives zero loads.
    thrust_guess : float
        Guess of the thrust of all blades [N], known for example after a trim: it saves half of the
        work and does not change the result. 0 is no guess.

    Returns
    -------
    RotorLoads
        Loads, exactly differentiable in every argument but the guess.
    """
    turning, moving = case.never_still()
    flow = flow_at(moving)
    n_blades = case.rotor.n_blades

    def evaluate(params: _Params, w: Array) -> LatticeLoads:
        return loads_at(params[0], w)

    def residual(params: _Params, w: Array, loads: LatticeLoads) -> Array:
        return induced_velocity(params[0], n_blades * loads.thrust) - w

    def search(params: _Params) -> tuple[Array, LatticeLoads, None]:
        flow, thrust_guess = params
        state = flow.case.state
        low = lowest_induced_velocity(state, flow.case.rotor.radius)
        high = state.rotation_speed * flow.case.rotor.radius
        rough = _rough_root(flow, thrust_guess, low, high)

        def trial(w: Array, _: LatticeLoads) -> tuple[Array, LatticeLoads]:
            loads = evaluate(params, w)
            return residual(params, w, loads), loads

        guess = rough.holding(empty(partial(evaluate, params), rough.root))
        w, loads = decreasing_root(trial, low, high, guess, _TOLERANCE, straight=True)
        return w, loads, None

    params = (flow, jnp.asarray(thrust_guess, float))
    w, loads, _ = at_root(search, evaluate, residual, params)
    return unless_still(turning, rotor_loads(flow, w, loads))


class _RoughTrial(NamedTuple):
    """Trial of the rough search."""

    w: Array
    missing: Array
    slope: Array  # through this trial and the one before


def _rough_root(
    flow: AxialFlow, thrust_guess: Array, low: Scalar, high: Scalar
) -> Guess[_RoughTrial]:
    """Induced velocity of elements in uniform inflow, or of a thrust guessed, and the slope."""

    def trial(w: Array, last: _RoughTrial) -> tuple[Array, _RoughTrial]:
        missing = induced_velocity(flow, rough_thrust(flow.case, flow.strips, w)) - w
        return missing, _RoughTrial(w, missing, (missing - last.missing) / (w - last.w))

    tip_speed = flow.case.state.rotation_speed * flow.case.rotor.radius
    zero = jnp.zeros_like(tip_speed)
    guess = Guess(_GUESS * tip_speed, _RoughTrial(zero, zero, zero))
    w, end = decreasing_root(trial, low, high, guess, _ROUGH_TOLERANCE, straight=True)
    known = jnp.where(thrust_guess == 0.0, w, induced_velocity(flow, thrust_guess))
    return Guess(known, end, jnp.clip(end.slope, _STEEPEST, _FLATTEST))


def evaluate(
    flow: AxialFlow, thrust_required: Scalar, rotation_speed: Scalar
) -> tuple[Array, LatticeLoads]:
    """Thrust at a rotation speed, in the wake that the thrust required transports.

    A trial of a trim takes one lattice solution. At the rotation speed searched for, this wake is
    the solution's own. At any other the thrust is wrong, but it never lies on the wrong side of the
    thrust required.

    Parameters
    ----------
    flow : AxialFlow
        Case with its lattice.
    thrust_required : float
        Thrust of all blades [N].
    rotation_speed : float
        Rotation speed of the trial [rad/s].

    Returns
    -------
    thrust, loads : float, LatticeLoads
        Thrust of all blades [N], loads of blade 1.
    """
    flow = flow.turning(rotation_speed)
    loads = loads_at(flow, induced_velocity(flow, thrust_required))
    return flow.case.rotor.n_blades * loads.thrust, loads


def solution(
    flow: AxialFlow, thrust_required: Scalar, rotation_speed: Scalar, loads: LatticeLoads
) -> RotorLoads:
    """Loads of the rotor from those of a blade that `evaluate` returned.

    Parameters
    ----------
    flow : AxialFlow
        Case with its lattice.
    thrust_required : float
        Thrust of all blades [N].
    rotation_speed : float
        Rotation speed at which the thrust is the one required [rad/s].
    loads : LatticeLoads
        Loads of blade 1 at that rotation speed.

    Returns
    -------
    RotorLoads
        Loads of all blades.
    """
    flow = flow.turning(rotation_speed)
    return rotor_loads(flow, induced_velocity(flow, thrust_required), loads)


def rotor_loads(
    flow: AxialFlow, induced_velocity_at_disk: Array, loads: LatticeLoads
) -> RotorLoads:
    """Loads of the rotor from those of a blade.

    Parameters
    ----------
    flow : AxialFlow
        Case with its lattice.
    induced_velocity_at_disk : float
        Induced velocity that transported the wake [m/s].
    loads : LatticeLoads
        Loads of blade 1 in that wake.

    Returns
    -------
    RotorLoads
        Loads of all blades; `converged` where momentum theory has the same induced velocity.
    """
    rotor, state = flow.case.rotor, flow.case.state
    n_blades, w = rotor.n_blades, induced_velocity_at_disk
    thrust = n_blades * loads.thrust
    tip_speed = state.rotation_speed * rotor.radius
    agrees = jnp.abs(induced_velocity(flow, thrust) - w) < 1.0e-6 * tip_speed
    within = within_momentum_theory(thrust, state, rotor.radius)
    strip_thrust, strip_torque = strip_loads(loads.position, loads.force, *loads.circulation.shape)
    return RotorLoads(
        thrust=thrust,
        torque=n_blades * loads.torque,
        induced_velocity=w,
        circulation=loads.circulation,
        strip_thrust=strip_thrust,
        strip_torque=strip_torque,
        point_loads=PointLoads(loads.position, -loads.force),
        strips=flow.lattice.strips,
        sections=loads.sections,
        converged=agrees & within & sections_agree(loads.sections),
    )

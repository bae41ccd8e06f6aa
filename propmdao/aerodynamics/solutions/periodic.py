"""Periodic lattice: loads of a rotor whose shaft stands at an angle to the flight.

Around a turn the air meets the blade ever differently, and every turn is like the one before. So
the circulation of all azimuths is one problem (`period_loads`), in a wake that the free stream and
the induced velocity w carry (`wakes.skewed`); w follows from the mean thrust by Glauert's momentum
theory of the tilted disk, as in axial flight. Without incidence this is the steady solution.

`solve` is the solution at a rotation speed. `flow_at`, `evaluate` and `solution` are what a trim
needs of it (`propmdao.aerodynamics.trim.Solver`).
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.period_lattice import (
    PeriodLattice,
    PeriodWake,
    period_lattice,
)
from propmdao.aerodynamics.solutions.period_loads import (
    PeriodBladeLoads,
    azimuths_of,
    period_loads,
    tilted_onset,
)
from propmdao.aerodynamics.solutions.point_sums import strip_loads
from propmdao.aerodynamics.solutions.result import (
    TiltedLoads,
    sections_agree,
    unless_still,
)
from propmdao.aerodynamics.solutions.roots import at_root, decreasing_root
from propmdao.aerodynamics.vortices.cores import core_radius, middles
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.momentum import (
    lowest_induced_velocity,
    momentum_induced_velocity,
    within_momentum_theory,
)
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.loads import PeriodicLoads
from propmdao.records.pytrees import Scalar, record
from propmdao.runtime.compilation import compiled

_TOLERANCE = 1.0e-8  # relative, in the induced velocity
_GUESS = 0.05  # of the tip speed


@record
class TiltedFlow:
    """A case with the part of its lattice that no operating point changes.

    Attributes
    ----------
    case : RotorCase
        Case to solve; its rotation speed is not 0.
    lattice : PeriodLattice
        Lattice of blade 1.
    """

    case: RotorCase
    lattice: PeriodLattice

    def turning(self, rotation_speed: Scalar) -> TiltedFlow:
        """The same flow at another rotation speed [rad/s]."""
        return TiltedFlow(self.case.turning(rotation_speed), self.lattice)

    @property
    def n_azimuths(self) -> int:
        """Azimuths of the period: at least those asked for, and a multiple of the blades."""
        return azimuths_for(self.case.n_azimuths, self.case.rotor.n_blades)


def azimuths_for(at_least: int, n_blades: int) -> int:
    """Azimuths of a period: at least so many, and a multiple of the blades."""
    return n_blades * -(-at_least // n_blades)


_Params = tuple[TiltedFlow, Array]  # with the thrust guessed


def flow_at(case: RotorCase) -> TiltedFlow:
    """Prepare a case by the part of its lattice that no operating point changes.

    Parameters
    ----------
    case : RotorCase
        Case to solve.

    Returns
    -------
    TiltedFlow
        The case with its lattice, all numbers as floats.
    """
    case = case.in_floats()
    return TiltedFlow(case, period_lattice(case.rotor))


def induced_velocity(flow: TiltedFlow, thrust: Scalar) -> Array:
    """Induced velocity at the disk by momentum theory.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    thrust : float
        Mean thrust of all blades [N].

    Returns
    -------
    float
        Induced velocity along the shaft [m/s].
    """
    return momentum_induced_velocity(thrust, flow.case.state, flow.case.rotor.radius)


def loads_at(flow: TiltedFlow, induced_velocity: Scalar) -> PeriodBladeLoads:
    """Loads of blade 1 in the wake that a given induced velocity transports.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    induced_velocity : float
        Induced velocity at the disk [m/s].

    Returns
    -------
    PeriodBladeLoads
        Loads of blade 1 at the azimuths.
    """
    case, lattice, n = flow.case, flow.lattice, flow.n_azimuths
    rotor, state = case.rotor, case.state
    edge, ages = lattice.lattice.rings.corner[-1], jnp.asarray(case.wake.ages)

    def core(at: Array) -> Array:
        viscosity, initial = state.air.kinematic_viscosity, BOUND_CORE * rotor.radius
        return core_radius(at, state.rotation_speed, viscosity, initial)

    azimuths = jnp.asarray(azimuths_of(n))
    onset = tilted_onset(lattice.lattice, state, induced_velocity, azimuths)
    step = onset.mean_speed * ages[1] / state.rotation_speed
    delay = shedding_delay(lattice.last_panel, step) / onset.mean_speed * state.rotation_speed
    wake = PeriodWake(
        nodes=helical_wake(edge, case.wake, rotor, state, induced_velocity),
        drift=sideways_drift(ages, azimuths, state),
        ages=ages,
        delay=delay,
        trailing_core=core(middles(ages)),
        shed_core=core(ages[:-1]),
    )
    return period_loads(lattice, wake, onset, state.rotation_speed, state.air, case.sections)


def mean_thrust(flow: TiltedFlow, loads: PeriodBladeLoads) -> Array:
    """Mean thrust of all blades from the loads of one [N]."""
    return flow.case.rotor.n_blades * loads.hub_force[:, 2].mean()


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
    rotation_speed = case.state.rotation_speed
    turning = jnp.asarray(rotation_speed > 0.0)
    # Where nothing turns, the flow of 1 rad/s stands in, for the shapes.
    flow = flow_at(case.turning(jnp.where(turning, rotation_speed, 1.0)))

    def evaluate(params: _Params, w: Array) -> PeriodBladeLoads:
        return loads_at(params[0], w)

    def residual(params: _Params, w: Array, loads: PeriodBladeLoads) -> Array:
        return induced_velocity(params[0], mean_thrust(params[0], loads)) - w

    def search(params: _Params) -> tuple[Array, PeriodBladeLoads, None]:
        flow, thrust_guess = params
        state = flow.case.state
        tip_speed = state.rotation_speed * flow.case.rotor.radius

        def trial(w: Array) -> tuple[Array, PeriodBladeLoads]:
            loads = evaluate(params, w)
            return residual(params, w, loads), loads

        w, loads = decreasing_root(
            trial,
            lowest_induced_velocity(state, flow.case.rotor.radius),
            tip_speed,
            induced_velocity(flow, jnp.where(thrust_guess == 0.0, _guess(flow), thrust_guess)),
            _TOLERANCE,
        )
        return w, loads, None

    params = (flow, jnp.asarray(thrust_guess, float))
    w, loads, _ = at_root(search, evaluate, residual, params)
    return unless_still(turning, tilted_loads(flow, w, loads))


def _guess(flow: TiltedFlow) -> Array:
    """Thrust [N] of a hovering rotor whose induced velocity is `_GUESS` of the tip speed."""
    state, rotor = flow.case.state, flow.case.rotor
    w = _GUESS * state.rotation_speed * rotor.radius
    return 2.0 * state.air.density * jnp.asarray(rotor.disk_area) * w**2


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

    def at_rest(vector: Array) -> Array:
        """Components in the axes that do not turn."""
        x, y, z = vector.T
        return jnp.stack(
            [x * jnp.cos(psi) - y * jnp.sin(psi), x * jnp.sin(psi) + y * jnp.cos(psi), z], axis=1
        )

    force, moment = at_rest(loads.hub_force), at_rest(loads.hub_moment)
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

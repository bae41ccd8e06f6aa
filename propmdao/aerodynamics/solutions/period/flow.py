"""A rotor at an incidence, and the loads of its blade in the wake of a known induced velocity."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.lattice.chord_lines import LINE_POINTS
from propmdao.aerodynamics.lattice.rings import BOUND_CORE
from propmdao.aerodynamics.lattice.strips import Strips
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.period.lattice import (
    PeriodLattice,
    period_lattice,
)
from propmdao.aerodynamics.solutions.period.loads import PeriodBladeLoads, period_loads
from propmdao.aerodynamics.solutions.period.onset import azimuths_of, tilted_onset
from propmdao.aerodynamics.solutions.period.wake import PeriodWake
from propmdao.aerodynamics.wakes.helical import helical_wake
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.momentum import momentum_induced_velocity
from propmdao.aerodynamics.wakes.sheets import aged_sheets
from propmdao.aerodynamics.wakes.skewed import sideways_drift
from propmdao.records.pytrees import Scalar, record


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

    @property
    def strips(self) -> Strips:
        """Sections of blade 1."""
        return self.lattice.lattice.strips

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


def loads_at(
    flow: TiltedFlow, induced_velocity: Scalar, start: Array | None = None
) -> PeriodBladeLoads:
    """Loads of blade 1 in the wake that a given induced velocity transports.

    Parameters
    ----------
    flow : TiltedFlow
        Case with its lattice.
    induced_velocity : float
        Induced velocity at the disk [m/s].
    start : (n_azimuths, ns) array, optional
        Recambering from which the search for it starts [rad]; by default none.

    Returns
    -------
    PeriodBladeLoads
        Loads of blade 1 at the azimuths.
    """
    case, lattice, n = flow.case, flow.lattice, flow.n_azimuths
    rotor, state = case.rotor, case.state
    edge, ages = lattice.lattice.rings.corner[-1], jnp.asarray(case.wake.ages)
    azimuths = jnp.asarray(azimuths_of(n))
    onset = tilted_onset(lattice.lattice, state, induced_velocity, azimuths)
    step = onset.mean_speed * ages[1] / state.rotation_speed
    delay = shedding_delay(lattice.last_panel, step) / onset.mean_speed * state.rotation_speed
    nodes = helical_wake(edge, case.wake, rotor, state, induced_velocity)
    wake = PeriodWake(
        sheets=aged_sheets(nodes, ages, state, BOUND_CORE * rotor.radius),
        drift=sideways_drift(ages, azimuths, state),
        ages=ages,
        delay=delay,
        n_near=case.wake.n_near if lattice.n_chordwise > LINE_POINTS else None,
        n_turn=case.wake.n_turn,
    )
    return period_loads(lattice, wake, onset, state.rotation_speed, state.air, case.sections, start)


def mean_thrust(flow: TiltedFlow, loads: PeriodBladeLoads) -> Array:
    """Mean thrust of all blades from the loads of one [N]."""
    return flow.case.rotor.n_blades * loads.hub_force[:, 2].mean()

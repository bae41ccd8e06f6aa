"""Loads of a turn, the mean of several: from steps of a march to loads that repeat every turn."""

from __future__ import annotations

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.step import (
    MarchedLattice,
    StepLoads,
)
from propmdao.aerodynamics.solutions.period.loads import PeriodBladeLoads, turn_derivative
from propmdao.aerodynamics.solutions.periodic import (
    TiltedFlow,
    induced_velocity,
    mean_thrust,
    tilted_loads,
)
from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.runtime.compilation import compiled


@partial(compiled, static_argnames=("steps_per_turn",))
def mean_loads(
    case: RotorCase, lattice: MarchedLattice, steps: StepLoads, steps_per_turn: int
) -> TiltedLoads:
    """Loads of the mean of some revolutions, which repeat every turn.

    Bernoulli's unsteady term is that of the mean circulation, differentiated by its Fourier series.

    Parameters
    ----------
    case : RotorCase
        Case that was marched.
    lattice : MarchedLattice
        Lattice of blade 1.
    steps : StepLoads
        Loads of blade 1 at the steps of whole revolutions, from azimuth 0, in place of blades.
    steps_per_turn : int
        Steps of a revolution.

    Returns
    -------
    TiltedLoads
        Loads at the azimuths of the steps; the residual of a section is its largest at an azimuth.
    """
    rings = case.rotor.nodes.shape[0] - 1, case.rotor.nodes.shape[1] - 1
    n_panels = rings[0] * rings[1]

    def by_turn(of_steps: Array) -> Array:
        return of_steps.reshape(-1, steps_per_turn, *of_steps.shape[1:])

    mean = jax.tree.map(lambda of_steps: by_turn(of_steps).mean(axis=0), steps)
    residual = by_turn(jnp.abs(steps.sections.residual)).max(axis=0)
    rate = case.state.rotation_speed * jnp.asarray(turn_derivative(steps_per_turn))
    unsteady = (rate @ mean.circulation)[..., None] * lattice.period.ring_area
    on_rings = slice(-rings[1] - n_panels, -rings[1])
    loads = PeriodBladeLoads(
        mean.circulation.reshape(-1, *rings),
        lattice.period.load_positions,
        mean.force.at[:, on_rings].set(case.state.air.density * unsteady),
        dataclasses.replace(mean.sections, residual=residual),
        mean.recambering,
    )
    flow = TiltedFlow(case, lattice.period)
    w = induced_velocity(flow, mean_thrust(flow, loads))
    return tilted_loads(flow, w, loads)

"""Vortex lattice and thrust required to rotation speed, torque and blade loads."""

from __future__ import annotations

from typing import Any

import jax
import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.known_root import trimmed_at
from propmdao.aerodynamics.trim import TrimError, steady_for_thrust
from propmdao.components.aerodynamics_comp import AerodynamicsComp, loads
from propmdao.components.jax_component import Arrays
from propmdao.components.section_inputs import with_inputs

_RAD_PER_S = np.pi / 30.0
_AIR_AND_THRUST = ("speed", "density", "thrust_required")
_loads = jax.jit(loads)


class TrimmedAerodynamicsComp(AerodynamicsComp):
    """Steady vortex lattice at the rotation speed that gives the thrust required.

    Converged from any blade inside the bounds. Rotation speed and loads come from one search, and
    their derivatives from one linearisation of the lattice.

    Inputs
    ------
    thrust_required : float
        Thrust of all blades, ``N``; of exactly 0 a propeller that stands still.
    lattice_nodes, speed, density, section_polars, sound_speed
        As `AerodynamicsComp` takes them.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``.
    thrust, torque, shaft_power, efficiency, J, CT, CQ, CP, circulation, load_position, \
load_force, section_speed, section_lift_coefficient
        Of `AerodynamicsComp`.

    Options
    -------
    rpm_bounds : (float, float)
        Lowest and highest rotation speed [rpm].
    num_nodes, loads, n_blades, radius, fidelity, polars, stall_delay
        As `AerodynamicsComp` takes them.

    Raises
    ------
    om.AnalysisError
        When the thrust is out of reach between the bounds, with the thrust at both, or the solution
        does not converge, with the reason and, where there are several, the node.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("rpm_bounds", types=tuple, desc="Lowest and highest rpm.")

    def setup(self) -> None:
        require_bounds(self.options["rpm_bounds"])
        super().setup()
        self.function, self.state, self.residual = _at_root, "rotation_speed", "missing_thrust"
        self.of_state = {"rpm": 1.0 / _RAD_PER_S}

    def _add_rotation_speed(self) -> None:
        self.add_point_input("thrust_required", val=1.0, units="N")
        self.add_point_output("rpm", val=np.sqrt(np.prod(self.options["rpm_bounds"])), units="rpm")

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def solve(self, inputs: Arrays) -> Any:
        radius, grid = self.constants
        low, high = (rpm * _RAD_PER_S for rpm in self.options["rpm_bounds"])
        speed, density, thrust = (inputs[name][0] for name in _AIR_AND_THRUST)
        try:
            omega, solution = steady_for_thrust(
                inputs["lattice_nodes"],
                self.options["n_blades"],
                radius,
                speed,
                density,
                thrust,
                (low, high),
                with_inputs(grid, inputs),
            )
        except TrimError as error:
            raise om.AnalysisError(str(error)) from error
        outputs = _loads(solution, omega / _RAD_PER_S, inputs, self.constants)
        return {**outputs, "rotation_speed": omega[None], "solution": solution}


def require_bounds(rpm_bounds: tuple[float, float]) -> None:
    """Refuse bounds that are none.

    Parameters
    ----------
    rpm_bounds : (float, float)
        Lowest and highest rotation speed [rpm].

    Raises
    ------
    ValueError
        Where they are not positive and rising.
    """
    low, high = rpm_bounds
    if not 0.0 < low < high:
        raise ValueError(f"rpm_bounds must be positive and rising; they are {low:g}, {high:g}")


def _at_root(inputs: Arrays, constants: Any, static: int) -> Arrays:
    radius, grid = constants
    omega = inputs["rotation_speed"][0]
    speed, density, thrust = (inputs[name][0] for name in _AIR_AND_THRUST)
    sections = with_inputs(grid, inputs)
    solution, missing = trimmed_at(
        omega, inputs["lattice_nodes"], static, radius, speed, density, thrust, sections
    )
    return {
        **loads(solution, omega / _RAD_PER_S, inputs, constants),
        "missing_thrust": missing[None],
    }

"""Vortex lattice and thrust required to rotation speed, torque and blade loads."""

from __future__ import annotations

from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.known_root import trimmed_at
from propmdao.aerodynamics.trim import (
    Bounds,
    TrimError,
    require_bounds,
    require_reached,
    solve_for_thrust,
)
from propmdao.components.aerodynamics_comp import AerodynamicsComp, loads_outputs
from propmdao.components.bases.array_function import Arrays
from propmdao.components.inputs.rotor_inputs import require_diameter, rotor_at
from propmdao.components.inputs.rpm_bounds import bounds_at, declare_bounds, given_bounds
from propmdao.records.units import RAD_PER_S


class TrimmedAerodynamicsComp(AerodynamicsComp):
    """Steady vortex lattice at the rotation speed that gives the thrust required.

    Converged from any blade inside the bounds. Rotation speed and loads come from one search, and
    their derivatives from one linearisation of the lattice.

    Inputs
    ------
    thrust_required : float
        Thrust of all blades, ``N``; of exactly 0 a propeller that stands still.
    lattice_nodes, diameter, speed, density, section_polars, sound_speed
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
    rpm_bounds : (float, float) or None
        Lowest and highest rotation speed [rpm]; None (default): where the tip of the diameter turns
        at 0.01 to 0.9 of the standard speed of sound.
    num_nodes, loads, n_blades, fidelity, polars, stall_delay
        As `AerodynamicsComp` takes them.

    Raises
    ------
    om.AnalysisError
        When the diameter is not positive, the thrust is out of reach between the bounds, with the
        thrust at both, or the solution does not converge, with the reason and, where there are
        several, the node.
    """

    def initialize(self) -> None:
        super().initialize()
        declare_bounds(self.options)

    def setup(self) -> None:
        super().setup()
        self.constants = self.constants, given_bounds(self.options)
        self.search, self.function = _trimmed, _at_root
        self.state, self.residual = "rotation_speed", "missing_thrust"
        self.state_outputs = {"rpm": 1.0 / RAD_PER_S}

    def _add_rotation_speed(self) -> None:
        self.add_point_input("thrust_required", val=1.0, units="N")
        self.add_point_output("rpm", val=4000.0, units="rpm")

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def check(self, inputs: Any, values: Any) -> None:
        require_diameter(inputs)
        case, thrust, bounds = _asked(inputs, self.constants, self.options["n_blades"])
        try:
            require_bounds(bounds, case.state.speed)
            require_reached(values["trimmed"], axial, case, thrust, bounds)
        except TrimError as error:
            raise om.AnalysisError(str(error)) from error
        super().check(inputs, values)


def _trimmed(inputs: Arrays, constants: Any, static: int) -> Arrays:
    case, thrust, bounds = _asked(inputs, constants, static)
    trimmed = solve_for_thrust(axial, case, thrust, bounds)
    state = case.state.turning(trimmed.rotation_speed)
    found = {
        "rotation_speed": trimmed.rotation_speed[None],
        "trimmed": trimmed,
        "loads": trimmed.loads,
    }
    return {**loads_outputs(trimmed.loads, state, inputs), **found}


def _asked(inputs: Arrays, constants: Any, n_blades: int) -> tuple[RotorCase, Any, Bounds]:
    """The rotor, the thrust required and where the rotation speed is looked for."""
    rotor_constants, given = constants
    bounds = bounds_at(inputs, given)
    case = rotor_at(inputs, rotor_constants, n_blades, bounds.low)
    return case, inputs["thrust_required"][0], bounds


def _at_root(inputs: Arrays, constants: Any, static: int) -> Arrays:
    omega = inputs["rotation_speed"][0]
    case = rotor_at(inputs, constants[0], static, omega)
    loads, missing = trimmed_at(omega, case, inputs["thrust_required"][0])
    return {**loads_outputs(loads, case.state, inputs), "missing_thrust": missing[None]}

"""Vortex lattice and thrust required to rotation speed, torque and blade loads."""

from __future__ import annotations

from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.solutions.known_root import trimmed_at
from propmdao.aerodynamics.trim import TrimError, require_reached, solve_for_thrust
from propmdao.components.bases.array_function import Arrays
from propmdao.components.inputs.rotor_inputs import RotorConstants, RotorKind, rotor_at
from propmdao.components.inputs.rpm_bounds import (
    bounds_at,
    checked_bounds_at,
    declare_bounds,
    fixed_bounds,
)
from propmdao.components.loads.aerodynamics_comp import AerodynamicsComp
from propmdao.components.loads.rotor_outputs import loads_outputs
from propmdao.records.units import RAD_PER_S


class TrimmedAerodynamicsComp(AerodynamicsComp):
    """Vortex lattice at the rotation speed that gives the thrust required, at an incidence too.

    Converged from any blade inside the bounds. Rotation speed and loads come from one search, and
    their derivatives from one linearisation of the lattice.

    Inputs
    ------
    thrust_required : float
        Thrust of all blades, ``N``; exactly 0 means a propeller that stands still.

    The other inputs are those of `AerodynamicsComp` without `rpm`.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``.

    The other outputs are those of `AerodynamicsComp`.

    Options
    -------
    rpm_bounds : (float, float) or None
        Lowest and highest rotation speed [rpm]; None (default): the tip turns at a hundredth of the
        standard speed of sound, and moves through the air at nine tenths of it.

    The other options are those of `AerodynamicsComp`.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, flight backwards or too fast to trim, the incidence
        beyond its range, diameter or a property of the air not positive, the thrust out of reach
        between the bounds, or the solution does not converge; the message has the reason, the
        thrust at both bounds and, with `num_nodes`, the node.
    ValueError
        If `rpm_bounds` are not positive and rising.
    """

    def initialize(self) -> None:
        super().initialize()
        declare_bounds(self.options)

    def setup(self) -> None:
        super().setup()
        self.search, self.function = _trimmed, _at_root
        self.state, self.residual = "rotation_speed", "missing_thrust"
        self.state_outputs = {"rpm": 1.0 / RAD_PER_S}

    def _search_constants(self, constants: RotorConstants) -> Any:
        return constants, fixed_bounds(self.options)

    def _add_rotation_speed(self) -> None:
        self.add_point_input("thrust_required", val=1.0, units="N")
        self.add_point_output("rpm", val=4000.0, units="rpm")

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def check(self, inputs: Any, values: Any) -> None:
        bounds = checked_bounds_at(inputs, fixed_bounds(self.options))
        case = rotor_at(inputs, self.constants_of(values), self.static, bounds.low)
        thrust = inputs["thrust_required"][0]
        try:
            require_reached(values["trimmed"], self.static.solver, case, thrust, bounds)
        except TrimError as error:
            raise om.AnalysisError(str(error)) from error
        super().check(inputs, values)


def _trimmed(inputs: Arrays, constants: Any, static: RotorKind) -> Arrays:
    rotor_constants, fixed = constants
    bounds = bounds_at(inputs, fixed)
    case = rotor_at(inputs, rotor_constants, static, bounds.low)
    trimmed = solve_for_thrust(static.solver, case, inputs["thrust_required"][0], bounds)
    state = case.state.turning(trimmed.rotation_speed)
    return {
        **loads_outputs(trimmed.loads, state, inputs),
        "rotation_speed": trimmed.rotation_speed[None],
        "trimmed": trimmed,
        "loads": trimmed.loads,
    }


def _at_root(inputs: Arrays, constants: RotorConstants, static: RotorKind) -> Arrays:
    omega = inputs["rotation_speed"][0]
    case = rotor_at(inputs, constants, static, omega)
    loads, missing = trimmed_at(static.solver, omega, case, inputs["thrust_required"][0])
    return {**loads_outputs(loads, case.state, inputs), "missing_thrust": missing[None]}

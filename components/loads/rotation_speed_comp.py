"""Rotation speed for a thrust by the rule of the thesis."""

from __future__ import annotations

from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.trim import rotation_speed_by_interpolation
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.inputs.rotor_inputs import (
    RotorKind,
    add_rotor_inputs,
    check_rotor_inputs,
    declare_rotor,
    rotor_at,
)
from propmdao.components.inputs.rpm_bounds import (
    bounds_at,
    checked_bounds_at,
    declare_bounds,
    fixed_bounds,
)
from propmdao.records.units import RAD_PER_S


class RotationSpeedComp(NodesComp):
    """Rotation speed at which the thrust, linear between two rotation speeds, is the required one.

    The rule of the thesis. Between bounds as near as its 4000 and 5000 rpm it misses the thrust
    required by some per cent, and it is there to show by how much; `TrimmedAerodynamicsComp` does
    not miss it. With `num_nodes` everything but the blade, `lattice_nodes`, `diameter`,
    `section_polars` and `section_thickness_over_chord`, has a leading axis of that many operating
    points.

    Inputs
    ------
    thrust_required : float
        Thrust of all blades, ``N``; exactly 0 means a propeller that stands still.

    The other inputs are those of `AerodynamicsComp` without `rpm` and `incidence`.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``.

    Options
    -------
    rpm_bounds : (float, float) or None
        The two rotation speeds at which the thrust is computed [rpm]; None (default): the bounds
        of `TrimmedAerodynamicsComp`, which are too far apart for this rule.

    The other options are those of `AerodynamicsComp` without `loads`, `tilted` and
    `blade_element`.

    Raises
    ------
    om.AnalysisError
        If an input is not finite, flight backwards or too fast to trim, diameter or a property of
        the air not positive, or the rotation speed not between the two; with `num_nodes` the
        message has the node.
    ValueError
        If `rpm_bounds` are not positive and rising.
    """

    def initialize(self) -> None:
        super().initialize()
        declare_rotor(self.options)
        declare_bounds(self.options)

    def setup(self) -> None:
        wake = self.options["fidelity"].wake
        self.constants = add_rotor_inputs(self, wake), fixed_bounds(self.options)
        self.add_point_input("thrust_required", val=1.0, units="N")
        self.add_point_output("rpm", val=4000.0, units="rpm")
        self.function = _interpolated
        self.static = RotorKind(self.options["n_blades"])

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def check_inputs(self, inputs: Arrays) -> None:
        super().check_inputs(inputs)
        check_rotor_inputs(inputs)

    def check(self, inputs: Any, values: Any) -> None:
        bounds = checked_bounds_at(inputs, fixed_bounds(self.options))
        low, high = float(bounds.low) / RAD_PER_S, float(bounds.high) / RAD_PER_S
        (rpm,) = values["rpm"]
        if not low <= rpm <= high:
            raise om.AnalysisError(
                f"thrust {inputs['thrust_required'][0]:g} N needs {rpm:g} rpm by linear "
                f"interpolation, outside {low:g}..{high:g} rpm"
            )


def _interpolated(inputs: Arrays, constants: Any, static: RotorKind) -> Arrays:
    rotor_constants, fixed = constants
    bounds = bounds_at(inputs, fixed)
    case = rotor_at(inputs, rotor_constants, static, bounds.low)
    omega = rotation_speed_by_interpolation(axial, case, inputs["thrust_required"][0], bounds)
    return {"rpm": omega[None] / RAD_PER_S}

"""Rotation speed for a thrust by the rule of the thesis."""

from __future__ import annotations

from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.trim import (
    TrimError,
    require_bounds,
    rotation_speed_by_interpolation,
)
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.inputs.rotor_inputs import (
    add_rotor_inputs,
    declare_rotor,
    require_diameter,
    rotor_at,
)
from propmdao.components.inputs.rpm_bounds import bounds_at, declare_bounds, given_bounds
from propmdao.records.units import RAD_PER_S


class RotationSpeedComp(NodesComp):
    """Rotation speed at which the thrust, linear between two rotation speeds, is the required one.

    The rule of the thesis. It misses the thrust required by some per cent and is there to show by
    how much; `TrimmedAerodynamicsComp` does not. With `num_nodes` everything but the blade,
    `lattice_nodes`, `diameter` and `section_polars`, has a leading axis of that many operating
    points.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``.
    diameter : float
        Of the propeller that the lattice is one of, ``m``.
    speed : float
        Axial flight speed, 0 is hover, ``m/s``.
    density : float
        Air density, ``kg/m**3``.
    thrust_required : float
        Thrust of all blades, ``N``; of exactly 0 a propeller that stands still.
    section_polars, sound_speed
        With option `polars`: as `AerodynamicsComp` takes them.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    n_blades : int
        Number of equally spaced blades.
    fidelity : Fidelity
        Numbers of panels.
    rpm_bounds : (float, float) or None
        The two rotation speeds at which the thrust is computed [rpm]; None: as
        `TrimmedAerodynamicsComp` has it.
    polars : SectionPolars or None
        Whose Reynolds numbers and angles `section_polars` has; None for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.

    Raises
    ------
    om.AnalysisError
        When the diameter is not positive, or the rotation speed not between the two, with the node
        where there are several.
    """

    def initialize(self) -> None:
        super().initialize()
        declare_rotor(self.options)
        declare_bounds(self.options)

    def setup(self) -> None:
        constants = add_rotor_inputs(self)
        self.add_point_input("thrust_required", val=1.0, units="N")
        self.add_point_output("rpm", val=4000.0, units="rpm")
        self.function = _interpolated
        self.static = self.options["n_blades"]
        self.constants = constants, given_bounds(self.options)

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def check(self, inputs: Any, values: Any) -> None:
        require_diameter(inputs)
        bounds = bounds_at(inputs, self.constants[1])
        try:
            require_bounds(bounds, inputs["speed"][0])
        except TrimError as error:
            raise om.AnalysisError(str(error)) from error
        low, high = float(bounds.low) / RAD_PER_S, float(bounds.high) / RAD_PER_S
        (rpm,) = values["rpm"]
        if not low <= rpm <= high:
            raise om.AnalysisError(
                f"thrust {inputs['thrust_required'][0]:g} N needs {rpm:g} rpm by linear "
                f"interpolation, outside {low:g}..{high:g} rpm"
            )


def _interpolated(inputs: Arrays, constants: Any, static: int) -> Arrays:
    rotor_constants, given = constants
    bounds = bounds_at(inputs, given)
    case = rotor_at(inputs, rotor_constants, static, bounds.low)
    omega = rotation_speed_by_interpolation(axial, case, inputs["thrust_required"][0], bounds)
    return {"rpm": omega[None] / RAD_PER_S}

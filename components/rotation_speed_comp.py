"""Rotation speed for a thrust by the rule of the thesis."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.polars import SectionPolars
from propmdao.aerodynamics.trim import rotation_speed_by_interpolation
from propmdao.components.jax_component import Arrays
from propmdao.components.operating_points import STATIC, OperatingPointsComp
from propmdao.components.section_inputs import add_section_inputs, section_grid, with_inputs
from propmdao.components.trimmed_aerodynamics_comp import require_bounds
from propmdao.fidelity import Fidelity

_RAD_PER_S = np.pi / 30.0


class RotationSpeedComp(OperatingPointsComp):
    """Rotation speed at which the thrust, linear between two rotation speeds, is the required one.

    The rule of the thesis. It misses the thrust required by some per cent and is there to show by
    how much; `TrimmedAerodynamicsComp` does not. With `num_nodes` everything but the blade,
    `lattice_nodes` and `section_polars`, has a leading axis of that many operating points.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``.
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
    radius : float
        Tip radius [m].
    fidelity : Fidelity
        Numbers of panels.
    rpm_bounds : (float, float)
        The two rotation speeds at which the thrust is computed [rpm].
    polars : SectionPolars or None
        Whose Reynolds numbers and angles `section_polars` has; None for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.

    Raises
    ------
    om.AnalysisError
        When the rotation speed is not between the two, with the node where there are several.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("n_blades", types=int, desc="Number of blades.")
        self.options.declare("radius", types=float, desc="Tip radius [m].")
        self.options.declare("fidelity", Fidelity(), types=Fidelity, desc="Numbers of panels.")
        self.options.declare("rpm_bounds", types=tuple, desc="Lowest and highest rpm.")
        self.options.declare("polars", None, types=SectionPolars, allow_none=True, desc="Or None.")
        self.options.declare("stall_delay", True, types=bool, desc="Of rotating sections.")

    def setup(self) -> None:
        require_bounds(self.options["rpm_bounds"])
        low, high = self.options["rpm_bounds"]
        fidelity = self.options["fidelity"]
        nodes = (fidelity.n_chordwise + 1, fidelity.n_spanwise + 1, 3)
        self.add_input("lattice_nodes", shape=nodes, units="m", tags=STATIC)
        self.add_point_input("speed", val=0.0, units="m/s")
        self.add_point_input("density", val=1.225, units="kg/m**3")
        self.add_point_input("thrust_required", val=1.0, units="N")
        polars, grid = self.options["polars"], None
        if polars is not None:
            add_section_inputs(self, polars, fidelity.n_spanwise)
            grid = section_grid(polars, self.options["stall_delay"])
        self.add_point_output("rpm", val=np.sqrt(low * high), units="rpm")
        bounds = jnp.array([self.options["radius"], low * _RAD_PER_S, high * _RAD_PER_S])
        self.function = _interpolated
        self.static = self.options["n_blades"]
        self.constants = bounds, grid

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["thrust_required"].any()

    def check(self, inputs: Any, values: Any) -> None:
        low, high = self.options["rpm_bounds"]
        (rpm,) = values["rpm"]
        if not low <= rpm <= high:
            raise om.AnalysisError(
                f"thrust {inputs['thrust_required'][0]:g} N needs {rpm:g} rpm by linear "
                f"interpolation, outside {low:g}..{high:g} rpm"
            )


def _interpolated(inputs: Arrays, constants: Any, static: int) -> Arrays:
    speed, density, thrust = (inputs[name][0] for name in ("speed", "density", "thrust_required"))
    (radius, low, high), grid = constants
    sections = with_inputs(grid, inputs)
    omega = rotation_speed_by_interpolation(
        inputs["lattice_nodes"], static, radius, speed, density, thrust, low, high, sections
    )
    return {"rpm": omega[None] / _RAD_PER_S}

"""Rotation speed at which a blade gives the thrust required."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.polars import SectionPolars
from propmdao.aerodynamics.trim import (
    TrimError,
    rotation_speed_by_interpolation,
    rotation_speed_for_thrust,
    solve_rotation_speed,
)
from propmdao.components.jax_component import Arrays, arrays, evaluate, reverse
from propmdao.components.section_inputs import add_section_inputs, section_grid, with_inputs
from propmdao.fidelity import Fidelity

METHODS = ("solve", "two_point")
_RAD_PER_S = np.pi / 30.0


class RotationSpeedComp(om.ExplicitComponent):
    """Trim to a thrust, converged from any blade inside the bounds.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``.
    speed : float
        Axial flight speed, 0 is hover, ``m/s``.
    density : float
        Air density, ``kg/m**3``.
    thrust_required : float
        Thrust of all blades, ``N``.
    section_polars, sound_speed
        With option `polars`: as `AerodynamicsComp` takes them.

    Outputs
    -------
    rpm : float
        Rotation speed, ``rpm``.

    Options
    -------
    n_blades : int
        Number of equally spaced blades.
    radius : float
        Tip radius [m].
    fidelity : Fidelity
        Numbers of panels.
    rpm_bounds : (float, float)
        Lowest and highest rotation speed [rpm].
    method : str
        ``"solve"``: the thrust is the required one. ``"two_point"``: the thrust is computed at the
        two bounds and taken as linear in between, the rule of the thesis; it misses the thrust
        required by some per cent and is there to show by how much.
    polars : SectionPolars or None
        Whose Reynolds numbers and angles `section_polars` has; None for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.

    Raises
    ------
    om.AnalysisError
        When the thrust is out of reach between the bounds, with the thrust at both.
    """

    def initialize(self) -> None:
        self.options.declare("n_blades", types=int, desc="Number of blades.")
        self.options.declare("radius", types=float, desc="Tip radius [m].")
        self.options.declare("fidelity", Fidelity(), types=Fidelity, desc="Numbers of panels.")
        self.options.declare("rpm_bounds", types=tuple, desc="Lowest and highest rpm.")
        self.options.declare("method", "solve", values=METHODS, desc="How the rpm is found.")
        self.options.declare("polars", None, types=SectionPolars, allow_none=True, desc="Or None.")
        self.options.declare("stall_delay", True, types=bool, desc="Of rotating sections.")

    def setup(self) -> None:
        low, high = self.options["rpm_bounds"]
        if not 0.0 < low < high:
            raise ValueError(f"rpm_bounds must be positive and rising; they are {low:g}, {high:g}")
        fidelity = self.options["fidelity"]
        nodes = (fidelity.n_chordwise + 1, fidelity.n_spanwise + 1, 3)
        self.add_input("lattice_nodes", shape=nodes, units="m")
        self.add_input("speed", val=0.0, units="m/s")
        self.add_input("density", val=1.225, units="kg/m**3")
        self.add_input("thrust_required", val=1.0, units="N")
        polars, grid = self.options["polars"], None
        if polars is not None:
            add_section_inputs(self, polars, fidelity.n_spanwise)
            grid = section_grid(polars, self.options["stall_delay"])
        self.add_output("rpm", val=np.sqrt(low * high), units="rpm")

        self.declare_partials("rpm", "*")
        bounds = jnp.array([self.options["radius"], low * _RAD_PER_S, high * _RAD_PER_S])
        self.constants = bounds, grid

    def compute(self, inputs: Any, outputs: Any) -> None:
        if self.options["method"] == "solve":
            outputs["rpm"] = self._solve(arrays(inputs)) / _RAD_PER_S
        else:
            outputs["rpm"] = self._interpolate(arrays(inputs))

    def compute_partials(self, inputs: Any, partials: Any) -> None:
        # One output: a single reverse product is the whole Jacobian, for any number of responses.
        function = _solved if self.options["method"] == "solve" else _interpolated
        at = self.options["n_blades"], self.constants, arrays(inputs)
        for name, gradient in reverse(function, *at, {"rpm": np.ones(1)}).items():
            partials["rpm", name] = gradient.reshape(1, -1)

    def _solve(self, inputs: Arrays) -> Any:
        *operating, low, high, sections = _arguments(
            inputs, self.constants, self.options["n_blades"]
        )
        nodes, n_blades, radius, speed, density, thrust = operating
        try:
            return rotation_speed_for_thrust(
                nodes, n_blades, radius, speed, density, thrust, (low, high), sections
            )
        except TrimError as error:
            raise om.AnalysisError(str(error)) from error

    def _interpolate(self, inputs: Arrays) -> Any:
        values = evaluate(_interpolated, self.options["n_blades"], self.constants, inputs)
        low, high = self.options["rpm_bounds"]
        (rpm,) = values["rpm"]
        if not low <= rpm <= high:
            raise om.AnalysisError(
                f"thrust {inputs['thrust_required'][0]:g} N needs {rpm:g} rpm by linear "
                f"interpolation, outside {low:g}..{high:g} rpm"
            )
        return rpm


def _arguments(inputs: Arrays, constants: Any, n_blades: int) -> tuple[Any, ...]:
    scalars = (inputs[name][0] for name in ("speed", "density", "thrust_required"))
    (radius, low, high), grid = constants
    sections = with_inputs(grid, inputs)
    return inputs["lattice_nodes"], n_blades, radius, *scalars, low, high, sections


def _solved(inputs: Arrays, constants: Any, static: int) -> Arrays:
    omega, _ = solve_rotation_speed(*_arguments(inputs, constants, static))
    return {"rpm": omega[None] / _RAD_PER_S}


def _interpolated(inputs: Arrays, constants: Any, static: int) -> Arrays:
    omega = rotation_speed_by_interpolation(*_arguments(inputs, constants, static))
    return {"rpm": omega[None] / _RAD_PER_S}

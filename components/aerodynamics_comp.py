"""Vortex lattice and operating point to thrust, torque and blade loads."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import numpy as np
import openmdao.api as om

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.polars import SectionPolars
from propmdao.aerodynamics.solution import failure
from propmdao.aerodynamics.steady import solve_steady
from propmdao.components.jax_component import Arrays, JaxComponent
from propmdao.components.section_inputs import add_section_inputs, section_grid, with_inputs
from propmdao.fidelity import Fidelity


def n_loads(fidelity: Fidelity) -> int:
    """Return the number of point forces on a blade: bound and chordwise segments, sections."""
    nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
    return nc * ns + nc * (ns + 1) + ns


class AerodynamicsComp(JaxComponent):
    """Steady vortex lattice with its helical wake, hover included.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``.
    rpm : float
        Rotation speed, ``rpm``; 0 gives zero loads.
    speed : float
        Axial flight speed, 0 is hover, ``m/s``.
    density : float
        Air density, ``kg/m**3``.
    thrust_guess : float
        Thrust where it is nearly known, as after a trim: half of the work, the same results;
        0 is no guess, ``N``.
    section_polars : (n_spanwise, 3, n_re, n_alpha) array
        With option `polars`: of `GeometryComp`.
    sound_speed : float
        With option `polars`: of the air, ``m/s``.

    Outputs
    -------
    thrust, torque, shaft_power : float
        Of all blades, ``N``, ``N*m``, ``W``.
    efficiency : float
        Thrust times speed over shaft power, 0 in hover.
    J, CT, CQ, CP : float
        Advance ratio V / (n D) and coefficients per rho n^2 D^4, rho n^2 D^5, rho n^3 D^5, with n
        in revolutions per second.
    circulation : (n_chordwise, n_spanwise) array
        Of the vortex rings of a blade, ``m**2/s``.
    load_position, load_force : (n_loads, 3) arrays
        Point forces of blade 1 ON THE FLUID, ``m``, ``N``; `n_loads` of the module counts them.
    section_speed : (n_spanwise,) array
        Speed of the air relative to the sections in the middle of the strips, ``m/s``.
    section_lift_coefficient : (n_spanwise,) array
        Their lift coefficients; without polars those of the lattice.

    Options
    -------
    n_blades : int
        Number of equally spaced blades.
    radius : float
        Tip radius [m].
    fidelity : Fidelity
        Numbers of panels.
    polars : SectionPolars or None
        Whose Reynolds numbers and angles `section_polars` has; None for inviscid flow.
    stall_delay : bool
        Whether rotation delays the stall of the sections.

    Raises
    ------
    om.AnalysisError
        When the solution does not converge, with the reason.
    """

    def initialize(self) -> None:
        self.options.declare("n_blades", types=int, desc="Number of blades.")
        self.options.declare("radius", types=float, desc="Tip radius [m].")
        self.options.declare("fidelity", Fidelity(), types=Fidelity, desc="Numbers of panels.")
        self.options.declare("polars", None, types=SectionPolars, allow_none=True, desc="Or None.")
        self.options.declare("stall_delay", True, types=bool, desc="Of rotating sections.")

    def setup(self) -> None:
        fidelity = self.options["fidelity"]
        nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
        self.add_input("lattice_nodes", shape=(nc + 1, ns + 1, 3), units="m")
        self.add_input("rpm", val=4000.0, units="rpm")
        self.add_input("speed", val=0.0, units="m/s")
        self.add_input("density", val=1.225, units="kg/m**3")
        self.add_input("thrust_guess", val=0.0, units="N", desc="Saves work; 0 is no guess.")
        self.add_output("thrust", units="N", desc="Of all blades.")
        self.add_output("torque", units="N*m", desc="Of all blades.")
        self.add_output("shaft_power", units="W", desc="Of all blades.")
        self.add_output("efficiency", desc="Thrust times speed over shaft power.")
        for name in ("J", "CT", "CQ", "CP"):
            self.add_output(name)
        self.add_output("circulation", shape=(nc, ns), units="m**2/s")
        self.add_output("load_position", shape=(n_loads(fidelity), 3), units="m")
        self.add_output(
            "load_force", shape=(n_loads(fidelity), 3), units="N", desc="Force on the fluid."
        )
        self.add_output("section_speed", shape=ns, units="m/s", desc="Relative to the air.")
        self.add_output("section_lift_coefficient", shape=ns, desc="In the middle of the strips.")
        polars, grid = self.options["polars"], None
        if polars is not None:
            add_section_inputs(self, polars, ns)
            grid = section_grid(polars, self.options["stall_delay"])
        self.function = _steady
        self.static = self.options["n_blades"]
        self.constants = jnp.asarray(self.options["radius"]), grid

    def check(self, inputs: Any, values: Any) -> None:
        reason = failure(values["solution"])
        if reason:
            raise om.AnalysisError(
                f"{reason}, at {inputs['rpm'][0]:g} rpm and {inputs['speed'][0]:g} m/s"
            )


def _steady(inputs: Arrays, constants: Any, static: int) -> Arrays:
    n_blades, (radius, grid) = static, constants
    rpm, speed, density, thrust_guess = (
        inputs[name][0] for name in ("rpm", "speed", "density", "thrust_guess")
    )
    omega = rpm * (np.pi / 30.0)
    solution = solve_steady(
        inputs["lattice_nodes"],
        n_blades,
        radius,
        omega,
        speed,
        density,
        with_inputs(grid, inputs),
        thrust_guess=thrust_guess,
    )
    of = coefficients(solution.thrust, solution.torque, omega, speed, density, 2.0 * radius)
    return {
        "thrust": solution.thrust[None],
        "torque": solution.torque[None],
        "shaft_power": (solution.torque * omega)[None],
        "efficiency": of.eta[None],
        "J": of.J[None],
        "CT": of.CT[None],
        "CQ": of.CQ[None],
        "CP": of.CP[None],
        "circulation": solution.circulation,
        "load_position": solution.point_loads.position,
        "load_force": solution.point_loads.force,
        "section_speed": solution.sections.relative_speed,
        "section_lift_coefficient": solution.sections.lift_coefficient,
        "solution": solution,
    }

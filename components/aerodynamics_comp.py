"""Vortex lattice and operating point to thrust, torque and blade loads."""

from __future__ import annotations

from typing import Any

import jax.numpy as jnp
import openmdao.api as om

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.known_root import steady_at
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads, failure
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.bases.root_component import RootComponent
from propmdao.components.inputs.rotor_inputs import (
    RotorConstants,
    add_rotor_inputs,
    check_rotor_inputs,
    declare_rotor,
    rotor_at,
)
from propmdao.records.fidelity import Fidelity
from propmdao.records.quantities import RESULTS
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

#: Outputs of every rotor, by their name in the table of quantities.
PERFORMANCE = tuple(name for name in RESULTS if name not in ("converged", "failure"))


def n_loads(fidelity: Fidelity) -> int:
    """Return the number of point forces on a blade: bound and chordwise segments, sections."""
    nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
    return nc * ns + nc * (ns + 1) + ns


class AerodynamicsComp(NodesComp, RootComponent):
    """Steady vortex lattice with its helical wake, hover included.

    With `num_nodes` everything but the blade, `lattice_nodes`, `diameter`, `section_polars` and
    `section_thickness_over_chord`, has a leading axis of that many operating points.

    Inputs
    ------
    lattice_nodes : (n_chordwise + 1, n_spanwise + 1, 3) array
        Corner points of the lattice of blade 1, ``m``.
    diameter : float
        Diameter from tip to tip, ``m``.
    rpm : float
        Rotation speed, ``rpm``; at exactly 0 every output is 0.
    speed : float
        Axial flight speed, 0 is hover, ``m/s``.
    density : float
        Density of the air, ``kg/m**3``.
    section_polars : (n_spanwise, 3, n_re, n_alpha) array
        Polars of the sections in the middle of the strips, as `GeometryComp` gives them; an input
        if there is the option `polars`.
    section_thickness_over_chord : (n_spanwise,) array
        Maximum thickness over chord there, 0 if nothing gives it: where the drag of shocks begins;
        an input if there is the option `polars`.
    sound_speed : float
        Speed of sound, ``m/s``; an input if there is the option `polars`.

    Outputs
    -------
    thrust, torque, shaft_power : float
        Thrust, shaft torque and shaft power of all blades, ``N``, ``N*m``, ``W``.
    efficiency : float
        Thrust times speed over shaft power, 0 in hover; below 0, down to -1, for a brake.
    figure_of_merit : float
        Ideal power of hover over shaft power; below 0, down to -1, for negative thrust.
    J, CT, CQ, CP : float
        Advance ratio V / (n D) and coefficients per rho n^2 D^4, rho n^2 D^5, rho n^3 D^5, with n
        in revolutions per second.
    circulation : (n_chordwise, n_spanwise) array
        Circulation of the vortex rings of a blade, ``m**2/s``.
    load_position, load_force : (n_loads, 3) arrays
        Point forces of blade 1 ON THE FLUID, ``m``, ``N``; `n_loads` of the module counts them.
    section_speed : (n_spanwise,) array
        Speed of the air relative to the sections in the middle of the strips, ``m/s``.
    section_lift_coefficient : (n_spanwise,) array
        Lift coefficients of the sections; without polars those of the lattice.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    loads : bool
        True (default): the loads along the blade, `circulation` and those below it, are outputs.
        Without them derivatives are cheap where many are asked for, as missions do.
    n_blades : int
        Number of equally spaced blades.
    fidelity : Fidelity
        Numbers of panels and wake nodes.
    polars : SectionPolars or None
        Polars that have the Reynolds numbers and angles of `section_polars`; None (default) for
        inviscid flow.
    stall_delay : bool
        True (default): rotation delays the stall of the sections.
    wake : WakeLaw
        Law by which the prescribed wake moves.

    Raises
    ------
    om.AnalysisError
        If an input or a result is not finite, rotation or flight backwards, diameter or a property
        of the air not positive, or the solution does not converge; the message has the reason and,
        with `num_nodes`, the node.
    """

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("loads", True, types=bool, desc="loads are outputs")
        declare_rotor(self.options)

    def setup(self) -> None:
        fidelity = self.options["fidelity"]
        nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
        self.constants = self.search_constants = add_rotor_inputs(self)
        self._add_rotation_speed()
        for name in PERFORMANCE:
            quantity = RESULTS[name]
            self.add_point_output(
                quantity.variable, units=quantity.unit or None, desc=quantity.meaning
            )
        if self.options["loads"]:
            self._add_loads(nc, ns, n_loads(fidelity))
        self.search, self.function = _steady, _at_root
        self.state, self.residual = "induced_velocity", "residual"
        self.static = self.options["n_blades"]

    def _add_rotation_speed(self) -> None:
        self.add_point_input("rpm", val=4000.0, units="rpm")

    def _add_loads(self, nc: int, ns: int, n: int) -> None:
        self.axes = {
            "circulation": ("chordwise panel", "strip"),
            "load_position": ("load",),
            "load_force": ("load",),
            "section_speed": ("strip",),
            "section_lift_coefficient": ("strip",),
        }
        self.add_point_output("circulation", shape=(nc, ns), units="m**2/s")
        self.add_point_output("load_position", shape=(n, 3), units="m")
        self.add_point_output("load_force", shape=(n, 3), units="N", desc="Force on the fluid.")
        self.add_point_output("section_speed", shape=(ns,), units="m/s", desc="Through the air.")
        self.add_point_output(
            "section_lift_coefficient", shape=(ns,), desc="In the middle of the strips."
        )

    def at_rest(self, inputs: Arrays) -> bool:
        return not inputs["rpm"].any()

    def check_inputs(self, inputs: Arrays) -> None:
        super().check_inputs(inputs)
        check_rotor_inputs(inputs)

    def check(self, inputs: Any, values: Any) -> None:
        self.require_numbers(inputs, values)
        reason = failure(values["loads"])
        if reason:
            raise om.AnalysisError(
                f"{reason}, at {values['rpm'][0]:g} rpm and {inputs['speed'][0]:g} m/s"
            )


def _steady(inputs: Arrays, constants: RotorConstants, static: int) -> Arrays:
    case = rotor_at(inputs, constants, static, inputs["rpm"][0] * RAD_PER_S)
    loads = axial.solve(case)
    return {
        **loads_outputs(loads, case.state, inputs),
        "induced_velocity": loads.induced_velocity[None],
        "loads": loads,
    }


def _at_root(inputs: Arrays, constants: RotorConstants, static: int) -> Arrays:
    case = rotor_at(inputs, constants, static, inputs["rpm"][0] * RAD_PER_S)
    loads, residual = steady_at(inputs["induced_velocity"][0], case)
    return {**loads_outputs(loads, case.state, inputs), "residual": residual[None]}


def loads_outputs(loads: RotorLoads | TiltedLoads, state: RotorState, inputs: Arrays) -> Arrays:
    """Outputs of the component.

    Parameters
    ----------
    loads : RotorLoads or TiltedLoads
        Loads of the rotor.
    state : RotorState
        How the rotor turns and flies.
    inputs : dict of arrays
        Inputs by name.

    Returns
    -------
    dict of arrays
        Outputs by name, and the rotation speed.
    """
    numbers = coefficients(loads.thrust, loads.torque, state, inputs["diameter"][0])
    return {
        "rpm": jnp.asarray(state.rotation_speed / RAD_PER_S)[None],
        "thrust": loads.thrust[None],
        "torque": loads.torque[None],
        "shaft_power": (loads.torque * state.rotation_speed)[None],
        "efficiency": numbers.eta[None],
        "figure_of_merit": numbers.figure_of_merit[None],
        "J": numbers.J[None],
        "CT": numbers.CT[None],
        "CQ": numbers.CQ[None],
        "CP": numbers.CP[None],
        "circulation": loads.circulation,
        "load_position": loads.point_loads.position,
        "load_force": loads.point_loads.force,
        "section_speed": loads.sections.relative_speed,
        "section_lift_coefficient": loads.sections.lift_coefficient,
    }

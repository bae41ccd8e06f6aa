"""Blade and operating point to thrust, torque and blade loads, by vortex lattice or elements."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping
from typing import Any

import openmdao.api as om

from propmdao.aerodynamics.calls import points_in_a_call
from propmdao.aerodynamics.solutions.known_root import solved_at
from propmdao.aerodynamics.solutions.period.flow import azimuths_for
from propmdao.aerodynamics.solutions.result import failure
from propmdao.aerodynamics.wakes.edgewise import (
    edgewise_advance_ratio,
    is_slow,
    longer,
    warn_if_fast,
)
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.components.bases.array_function import Arrays, evaluate
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.bases.root_component import RootComponent
from propmdao.components.inputs.model_options import declare_model
from propmdao.components.inputs.point_inputs import add_point_inputs, state_at
from propmdao.components.inputs.rotor_inputs import (
    RotorConstants,
    RotorKind,
    add_rotor_inputs,
    check_rotor_inputs,
    declare_rotor,
    declare_tilted,
    rotor_at,
)
from propmdao.components.loads.rotor_outputs import add_loads, add_performance, loads_outputs
from propmdao.records.units import RAD_PER_S


class AerodynamicsComp(NodesComp, RootComponent):
    """Vortex lattice with its helical wake, steady or, at an incidence, periodic; hover included.

    With `tilted` the shaft may stand at an angle to the flight: the loads change around the turn,
    and thrust, torque and what follows from them are means over it. The axes of the hub do not
    turn: +z is the shaft, in the direction of thrust, and flight is in the plane of +z and +x.

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
        Flight speed, 0 is hover, ``m/s``.
    incidence : float
        Angle between the shaft and the direction of flight, 0 is axial flight, 90 edgewise,
        ``deg``; an input with `tilted`.
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
    hub_force, hub_moment : (3,) arrays
        Mean force and moment of all blades on the hub, about the rotor's centre, in the axes of the
        hub, ``N``, ``N*m``; outputs with `tilted`.
    circulation : (n_chordwise, n_spanwise) array
        Circulation of the vortex rings of a blade, ``m**2/s``.
    load_position, load_force : (n_loads, 3) arrays
        Point forces of blade 1 ON THE FLUID, ``m``, ``N``; `n_loads` of the module counts them.
    section_speed : (n_spanwise,) array
        Speed of the air relative to the sections in the middle of the strips, ``m/s``.
    section_angle_of_attack, section_lift_coefficient : (n_spanwise,) arrays
        Angles of attack of the sections from their chord lines, ``rad``, and their lift
        coefficients; without polars those of the lattice.

    With `tilted` the last six, but `load_position`, have an axis of azimuths of blade 1 before
    those above: equally spaced from 0, where it points along +x, as many as `fidelity` has, rounded
    up to a multiple of the blades.

    Options
    -------
    num_nodes : int or None
        Number of operating points; None is a single one, with the shapes above.
    tilted : bool
        Flight at an incidence: the periodic lattice instead of the steady one. False by default: it
        takes some hundred times as long.
    loads : bool
        True (default): the loads along the blade, `circulation` and those below it, are outputs.
        Without them derivatives are cheap where many are asked for, as missions do.
    blade_element : bool
        Blade elements in annuli instead of the lattice: much faster, less accurate. `circulation`
        has one row then. False by default.
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
        If an input or a result is not finite, rotation or flight backwards, the incidence beyond
        its range, diameter or a property of the air not positive, or the solution does not
        converge; the message has the reason and, with `num_nodes`, the node.

    Warns
    -----
    FastEdgewiseWarning
        If the edgewise part of the flight is beyond 0.3 of the tip speed.
    """

    static: RotorKind

    def initialize(self) -> None:
        super().initialize()
        self.options.declare("loads", True, types=bool, desc="loads are outputs")
        declare_rotor(self.options)
        declare_tilted(self.options)
        declare_model(self.options, ["blade_element"])

    def setup(self) -> None:
        fidelity, tilted = self.options["fidelity"], self.options["tilted"]
        n_blades = self.options["n_blades"]
        n_azimuths = azimuths_for(fidelity.n_azimuths, n_blades) if tilted else None
        self.static = RotorKind(n_blades, n_azimuths, self.options["blade_element"])
        grid = fidelity.period_wake if tilted else fidelity.wake
        self.constants = add_rotor_inputs(self, grid)
        self.search_constants = self._search_constants(self.constants)
        self._in_slow_flight = dataclasses.replace(
            self.constants, wake=wake_transport(self.options["wake"], longer(grid))
        )
        self._add_rotation_speed()
        if tilted:
            add_point_inputs(self, ["incidence_deg"])
        add_performance(self, tilted)
        if self.options["loads"]:
            add_loads(self, fidelity, self.static)
        self.search, self.function = _steady, _at_root
        self.state, self.residual = "induced_velocity", "residual"

    def _add_rotation_speed(self) -> None:
        self.add_point_input("rpm", val=4000.0, units="rpm")

    def _search_constants(self, constants: RotorConstants) -> Any:
        """Constants of the search, from those of the function."""
        return constants

    def _has_tilted_wake(self) -> bool:
        """Whether there is a wake whose length depends on how fast the flight is."""
        return self.static.n_azimuths is not None and not self.static.blade_element

    def found_at(self, inputs: Arrays) -> Mapping[str, Any]:
        if not self._has_tilted_wake():
            return super().found_at(inputs)
        slow = "rpm" in inputs and is_slow(_advance_ratio(inputs, inputs["rpm"]))
        solution = self._found_in_a_wake(inputs, slow)
        if not slow and is_slow(_advance_ratio(inputs, solution["rpm"])):
            solution = self._found_in_a_wake(inputs, True)
        return solution

    def _found_in_a_wake(self, inputs: Arrays, slow: bool) -> Mapping[str, Any]:
        constants = self._in_slow_flight if slow else self.constants
        searched = self._search_constants(constants)
        return {**evaluate(self.search, self.static, searched, inputs), "constants": constants}

    def points_in_a_call(self) -> int:
        n, blade_element = self.n_points(), self.static.blade_element
        return min(n, points_in_a_call(n, blade_element)) if self.in_one_call() else 1

    def in_one_call(self) -> bool:
        return not self._has_tilted_wake()  # which is of its own length at each point

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
        if self.options["tilted"]:
            warn_if_fast(_advance_ratio(inputs, values["rpm"]), stacklevel=2)


def _advance_ratio(inputs: Arrays, rpm: Any) -> float:
    """Edgewise advance ratio at a rotation speed (1,)."""
    state = state_at(inputs, float(rpm[0]) * RAD_PER_S)
    return edgewise_advance_ratio(state, 0.5 * inputs["diameter"][0])


def _steady(inputs: Arrays, constants: RotorConstants, static: RotorKind) -> Arrays:
    case = rotor_at(inputs, constants, static, inputs["rpm"][0] * RAD_PER_S)
    loads = static.solver.solve(case)
    return {
        **loads_outputs(loads, case.state, inputs),
        "induced_velocity": loads.induced_velocity[None],
        "loads": loads,
    }


def _at_root(inputs: Arrays, constants: RotorConstants, static: RotorKind) -> Arrays:
    case = rotor_at(inputs, constants, static, inputs["rpm"][0] * RAD_PER_S)
    loads, residual = solved_at(static.solver, inputs["induced_velocity"][0], case)
    return {**loads_outputs(loads, case.state, inputs), "residual": residual[None]}

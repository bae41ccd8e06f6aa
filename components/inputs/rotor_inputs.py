"""Inputs of the components that find the loads: a blade, its sections and the air."""

from __future__ import annotations

import dataclasses
from typing import Any, NamedTuple

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.table import PolarTable
from propmdao.aerodynamics.solutions import axial, blade_element, periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.period import tilted_elements
from propmdao.aerodynamics.wakes.helical import WakeTransport, wake_transport
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.components.inputs.model_options import declare_model
from propmdao.components.inputs.point_inputs import (
    add_point_inputs,
    check_point_inputs,
    state_at,
)
from propmdao.records.pytrees import Scalar, record
from propmdao.records.wake_law import WakeGrid


class RotorKind(NamedTuple):
    """What the code of a rotor is compiled for.

    Attributes
    ----------
    n_blades : int
        Number of blades.
    n_azimuths : int or None
        Azimuths of a turn in flight at an incidence, a multiple of the blades; None in axial
        flight.
    blade_element : bool
        Whether blade elements take the place of the lattice.
    """

    n_blades: int
    n_azimuths: int | None = None
    blade_element: bool = False

    @property
    def solver(self) -> Any:
        """Module that solves for the loads, a `propmdao.aerodynamics.trim.Solver`."""
        if self.blade_element:
            return blade_element if self.n_azimuths is None else tilted_elements
        return axial if self.n_azimuths is None else periodic


@record
class RotorConstants:
    """Properties of a rotor that no input changes.

    Attributes
    ----------
    wake : WakeTransport
        Law of the wake, and the ages of its nodes.
    grid : PolarTable or None
        Angles and Reynolds numbers of the input `section_polars`, without values and thickness;
        None in inviscid flow.
    stall_delay : float
        1 if rotation delays stall, 0 for polars as in two dimensions.
    """

    wake: WakeTransport
    grid: PolarTable | None
    stall_delay: float


def declare_rotor(options: OptionsDictionary) -> None:
    """Declare the number of blades, and the options that `add_rotor_inputs` reads.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.
    """
    options.declare("n_blades", types=int, desc="number of equally spaced blades")
    declare_polars(options)
    declare_model(options, ["fidelity", "stall_delay", "wake"])


def declare_tilted(options: OptionsDictionary) -> None:
    """Declare whether the shaft may stand at an angle to the flight.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "tilted", False, types=bool, desc="flight at an incidence, with loads that change around"
    )


def declare_polars(options: OptionsDictionary) -> None:
    """Declare the polars of the sections.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "polars", None, types=SectionPolars, allow_none=True, desc="polars of the blade's sections"
    )


def add_rotor_inputs(component: NodesComp, grid: WakeGrid) -> RotorConstants:
    """Declare the inputs that `rotor_at` reads, but the incidence.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.
    grid : WakeGrid
        Nodes of the wake.

    Returns
    -------
    RotorConstants
        Properties of the rotor that no input changes.
    """
    options = component.options
    fidelity, polars = options["fidelity"], options["polars"]
    nodes = (fidelity.n_chordwise + 1, fidelity.n_spanwise + 1, 3)
    component.add_input("lattice_nodes", shape=nodes, units="m", tags=STATIC)
    component.add_input("diameter", units="m", tags=STATIC)
    add_point_inputs(component, ["speed", "density"])
    table = None
    if polars is not None:
        of_section = polars.values.shape[3:]
        shape = (fidelity.n_spanwise, *of_section)
        component.add_input("section_polars", shape=shape, tags=STATIC)
        component.add_input(
            "section_thickness_over_chord", np.zeros(fidelity.n_spanwise), tags=STATIC
        )
        add_point_inputs(component, ["sound_speed"])
        table = PolarTable(polars.alpha, polars.log_re, jnp.zeros((0, *of_section)), polars.mach)
    return RotorConstants(
        wake_transport(options["wake"], grid), table, float(options["stall_delay"])
    )


def rotor_at(
    inputs: Arrays, constants: RotorConstants, kind: RotorKind, rotation_speed: Scalar
) -> RotorCase:
    """Rotor that the solutions of the lattice take.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name.
    constants : RotorConstants
        Properties that `add_rotor_inputs` returned.
    kind : RotorKind
        Number of blades, and of azimuths.
    rotation_speed : scalar
        Rotation speed [rad/s].

    Returns
    -------
    RotorCase
        Rotor, state, sections and wake.
    """
    sections = None
    if constants.grid is not None:
        table = dataclasses.replace(
            constants.grid,
            values=inputs["section_polars"],
            thickness=inputs["section_thickness_over_chord"],
        )
        sections = ViscousSections(table, constants.stall_delay)
    rotor = RotorGeometry(inputs["lattice_nodes"], 0.5 * inputs["diameter"][0], kind.n_blades)
    state = state_at(inputs, rotation_speed)
    case = RotorCase(rotor, state, sections, constants.wake)
    if kind.n_azimuths is None:
        return case
    return dataclasses.replace(case, n_azimuths=kind.n_azimuths)


def check_rotor_inputs(inputs: Arrays) -> None:
    """Refuse a diameter that is not positive, and an operating point that is none.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name, those of `add_rotor_inputs` among them.

    Raises
    ------
    om.AnalysisError
        If the diameter is not positive, rotation or flight backwards, the incidence beyond its
        range, or a property of the air not positive.
    """
    require_diameter(inputs)
    check_point_inputs(inputs)


def require_diameter(inputs: Any) -> None:
    """Refuse a diameter that is not positive.

    Parameters
    ----------
    inputs : mapping
        Inputs by name, the diameter among them.

    Raises
    ------
    om.AnalysisError
        If the diameter is not positive.
    """
    (diameter,) = inputs["diameter"]
    if not diameter > 0.0:
        raise om.AnalysisError(f"diameter must be positive; it is {diameter:g} m")

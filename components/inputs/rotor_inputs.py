"""Inputs of the components that solve the lattice: a blade, its sections and the air."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.table import PolarTable
from propmdao.aerodynamics.solutions.case import RotorCase
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


def add_rotor_inputs(component: NodesComp) -> RotorConstants:
    """Declare the inputs that `rotor_at` reads.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.

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
    grid = None
    if polars is not None:
        of_section = polars.values.shape[3:]
        shape = (fidelity.n_spanwise, *of_section)
        component.add_input("section_polars", shape=shape, tags=STATIC)
        component.add_input(
            "section_thickness_over_chord", np.zeros(fidelity.n_spanwise), tags=STATIC
        )
        add_point_inputs(component, ["sound_speed"])
        grid = PolarTable(polars.alpha, polars.log_re, jnp.zeros((0, *of_section)), polars.mach)
    wake = wake_transport(options["wake"], fidelity.wake)
    return RotorConstants(wake, grid, float(options["stall_delay"]))


def rotor_at(
    inputs: Arrays, constants: RotorConstants, n_blades: int, rotation_speed: Scalar
) -> RotorCase:
    """Rotor that the solutions of the lattice take.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name.
    constants : RotorConstants
        Properties that `add_rotor_inputs` returned.
    n_blades : int
        Number of blades.
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
    rotor = RotorGeometry(inputs["lattice_nodes"], 0.5 * inputs["diameter"][0], n_blades)
    return RotorCase(rotor, state_at(inputs, rotation_speed), sections, constants.wake)


def check_rotor_inputs(inputs: Arrays) -> None:
    """Refuse a diameter that is not positive, and an operating point that is none.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name, those of `add_rotor_inputs` among them.

    Raises
    ------
    om.AnalysisError
        If the diameter is not positive, rotation or flight backwards, or a property of the air
        not positive.
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

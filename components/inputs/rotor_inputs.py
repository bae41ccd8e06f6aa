"""What the components that solve the lattice are given: a blade, its sections and the air."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax.numpy as jnp
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
from propmdao.components.inputs.point_inputs import add_point_inputs, state_at
from propmdao.records.fidelity import Fidelity
from propmdao.records.pytrees import record
from propmdao.records.wake_law import WakeLaw


@record
class RotorConstants:
    """What of a rotor no input changes.

    Attributes
    ----------
    wake : WakeTransport
        How the wake moves, and where its nodes are.
    grid : PolarTable or None
        Angles and Reynolds numbers of the input `section_polars`, without polars; None for inviscid
        flow.
    stall_delay : float
        1 where rotation delays stalls, 0 for polars as in two dimensions.
    """

    wake: WakeTransport
    grid: PolarTable | None
    stall_delay: float


def declare_rotor(options: OptionsDictionary) -> None:
    """Declare the options that `add_rotor_inputs` reads, and the number of blades.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.
    """
    options.declare("n_blades", types=int, desc="Number of blades.")
    options.declare("fidelity", Fidelity(), types=Fidelity, desc="Panels and wake nodes.")
    options.declare("polars", None, types=SectionPolars, allow_none=True, desc="Or None.")
    options.declare("stall_delay", True, types=bool, desc="Rotation delays stalls.")
    options.declare("wake", WakeLaw(), types=WakeLaw, desc="How the prescribed wake moves.")


def add_rotor_inputs(component: NodesComp) -> RotorConstants:
    """Declare the inputs that `rotor_at` reads.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.

    Returns
    -------
    RotorConstants
        What no input changes.
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
        add_point_inputs(component, ["sound_speed"])
        grid = PolarTable(polars.alpha, polars.log_re, jnp.zeros((0, *of_section)))
    wake = wake_transport(options["wake"], fidelity.wake)
    return RotorConstants(wake, grid, float(options["stall_delay"]))


def rotor_at(
    inputs: Arrays, constants: RotorConstants, n_blades: int, rotation_speed: Any
) -> RotorCase:
    """Rotor that the solutions of the lattice take.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs by name.
    constants : RotorConstants
        What `add_rotor_inputs` returned.
    n_blades : int
        Number of blades.
    rotation_speed : float
        Rotation speed [rad/s].

    Returns
    -------
    RotorCase
        Rotor, state, sections and wake.
    """
    sections = None
    if constants.grid is not None:
        table = dataclasses.replace(constants.grid, values=inputs["section_polars"])
        sections = ViscousSections(table, constants.stall_delay)
    rotor = RotorGeometry(inputs["lattice_nodes"], 0.5 * inputs["diameter"][0], n_blades)
    return RotorCase(rotor, state_at(inputs, rotation_speed), sections, constants.wake)


def require_diameter(inputs: Any) -> None:
    """Refuse a diameter that is not positive.

    Parameters
    ----------
    inputs : mapping
        Inputs with the diameter.

    Raises
    ------
    om.AnalysisError
        Where it is not positive.
    """
    (diameter,) = inputs["diameter"]
    if not diameter > 0.0:
        raise om.AnalysisError(f"diameter must be positive; it is {diameter:g} m")

"""What the components that solve the lattice are given: a blade, its sections and the air."""

from __future__ import annotations

import dataclasses
from typing import Any

import jax.numpy as jnp
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.aerodynamics.sections.laws import AIR_VISCOSITY, ViscousSections
from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.aerodynamics.sections.polars.table import PolarTable
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.records.fidelity import Fidelity


def declare_rotor(options: OptionsDictionary) -> None:
    """Declare the options that `add_rotor_inputs` reads, and the number of blades.

    Parameters
    ----------
    options : OptionsDictionary
        Of a component.
    """
    options.declare("n_blades", types=int, desc="Number of blades.")
    options.declare("fidelity", Fidelity(), types=Fidelity, desc="Numbers of panels.")
    options.declare("polars", None, types=SectionPolars, allow_none=True, desc="Or None.")
    options.declare("stall_delay", True, types=bool, desc="Of rotating sections.")


def add_rotor_inputs(component: NodesComp) -> ViscousSections | None:
    """Declare the inputs that `rotor_at` reads.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.

    Returns
    -------
    ViscousSections or None
        What no input changes: sections that have no polars yet. None for inviscid flow.
    """
    options = component.options
    fidelity, polars = options["fidelity"], options["polars"]
    nodes = (fidelity.n_chordwise + 1, fidelity.n_spanwise + 1, 3)
    component.add_input("lattice_nodes", shape=nodes, units="m", tags=STATIC)
    component.add_input("diameter", units="m", tags=STATIC)
    component.add_point_input("speed", val=0.0, units="m/s")
    component.add_point_input("density", val=1.225, units="kg/m**3")
    if polars is None:
        return None
    of_section = polars.values.shape[3:]
    shape = (fidelity.n_spanwise, *of_section)
    component.add_input("section_polars", shape=shape, tags=STATIC)
    component.add_point_input("sound_speed", val=340.294, units="m/s")
    table = PolarTable(polars.alpha, polars.log_re, jnp.zeros((0, *of_section)))
    return ViscousSections(table, AIR_VISCOSITY, jnp.nan, float(options["stall_delay"]))


def rotor_at(inputs: Arrays, grid: ViscousSections | None) -> dict[str, Any]:
    """Arguments of the solutions of the lattice.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs by name.
    grid : ViscousSections or None
        Of `add_rotor_inputs`.

    Returns
    -------
    dict
        By name: nodes, radius, speed, density, sections.
    """
    sections = grid
    if grid is not None:
        table = dataclasses.replace(grid.polars, values=inputs["section_polars"])
        sections = dataclasses.replace(grid, polars=table, sound_speed=inputs["sound_speed"][0])
    return {
        "nodes": inputs["lattice_nodes"],
        "radius": 0.5 * inputs["diameter"][0],
        "speed": inputs["speed"][0],
        "density": inputs["density"][0],
        "sections": sections,
    }


def require_diameter(inputs: Any) -> None:
    """Refuse a diameter that is none.

    Parameters
    ----------
    inputs : mapping
        With the diameter.

    Raises
    ------
    om.AnalysisError
        Where it is not positive.
    """
    (diameter,) = inputs["diameter"]
    if not diameter > 0.0:
        raise om.AnalysisError(f"diameter must be positive; it is {diameter:g} m")

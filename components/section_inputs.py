"""Section polars as inputs of the components that solve the lattice."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp

from propmdao.aerodynamics.polars import PolarTable, SectionPolars
from propmdao.aerodynamics.section_laws import AIR_VISCOSITY, ViscousSections
from propmdao.components.jax_component import Arrays
from propmdao.components.operating_points import STATIC, OperatingPointsComp


def add_section_inputs(component: OperatingPointsComp, polars: SectionPolars, n: int) -> None:
    """Declare the inputs that `with_inputs` reads.

    Parameters
    ----------
    component : OperatingPointsComp
        Component in its ``setup``.
    polars : SectionPolars
        Whose Reynolds numbers and angles the polars have.
    n : int
        Number of sections.
    """
    component.add_input("section_polars", shape=(n, *polars.values.shape[3:]), tags=STATIC)
    component.add_point_input("sound_speed", val=340.294, units="m/s")


def section_grid(polars: SectionPolars, stall_delay: bool) -> ViscousSections:
    """Return what no input changes: sections that have no polars yet.

    Parameters
    ----------
    polars : SectionPolars
        Whose Reynolds numbers and angles the polars have.
    stall_delay : bool
        Whether rotation delays stall.

    Returns
    -------
    ViscousSections
        Of no section.
    """
    table = PolarTable(polars.alpha, polars.log_re, jnp.zeros((0, *polars.values.shape[3:])))
    return ViscousSections(table, AIR_VISCOSITY, jnp.nan, float(stall_delay))


def with_inputs(grid: ViscousSections | None, inputs: Arrays) -> ViscousSections | None:
    """Sections with the polars and the sound speed of a component's inputs.

    Parameters
    ----------
    grid : ViscousSections or None
        Of `section_grid`; None for inviscid flow.
    inputs : dict of arrays
        Inputs by name.

    Returns
    -------
    ViscousSections or None
        What the lattice is held to.
    """
    if grid is None:
        return None
    table = dataclasses.replace(grid.polars, values=inputs["section_polars"])
    return dataclasses.replace(grid, polars=table, sound_speed=inputs["sound_speed"][0])

"""Inputs of operating points, and the state of the rotor that they make."""

from __future__ import annotations

from collections.abc import Iterable

import jax.numpy as jnp
import openmdao.api as om

from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.records.air import Air, Turbulence, require_turbulence
from propmdao.records.pytrees import Scalar
from propmdao.records.quantities import AIR, ASKED, TURBULENCE, require_asked
from propmdao.records.states import RotorState

#: Names of all properties of the air; each of them may be an input.
AIR_INPUTS = tuple(name for name, quantity in ASKED.items() if quantity.record == AIR)
#: Names of intensity and length scale of turbulence.
TURBULENCE_INPUTS = tuple(name for name, quantity in ASKED.items() if quantity.record == TURBULENCE)


def add_point_inputs(component: NodesComp, names: Iterable[str]) -> None:
    """Declare inputs of the operating point as the table of quantities has them.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.
    names : iterable of str
        Names in the table.
    """
    for name in names:
        quantity = ASKED[name]
        component.add_point_input(quantity.variable, val=quantity.default, units=quantity.unit)


def check_point_inputs(inputs: Arrays) -> None:
    """Refuse an operating point that `propmdao.analyze` refuses, in the same words.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name; those of the operating point are checked. No thrust required
        stands for a propeller at rest.

    Raises
    ------
    om.AnalysisError
        If rotation or flight is backwards, the incidence beyond its range, a property of the air
        not positive, or turbulence has no length scale.
    """
    try:
        for name in ("rpm", "speed", "incidence_deg", *AIR_INPUTS):
            if (variable := ASKED[name].variable) in inputs:
                require_asked(name, inputs[variable].item())
        if TURBULENCE_INPUTS[0] in inputs:
            require_turbulence(Turbulence(*(inputs[name].item() for name in TURBULENCE_INPUTS)))
    except ValueError as error:
        raise om.AnalysisError(str(error)) from error


def state_at(inputs: Arrays, rotation_speed: Scalar) -> RotorState:
    """State of the rotor at an operating point.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name: the speed, the incidence where the component has it, and those
        properties of the air that it has; the other ones are standard.
    rotation_speed : scalar
        Rotation speed [rad/s].

    Returns
    -------
    RotorState
        State for the solutions and the sources of sound.
    """
    air = {name: inputs[name][0] for name in AIR_INPUTS if name in inputs}
    incidence = jnp.radians(inputs["incidence"][0]) if "incidence" in inputs else 0.0
    return RotorState(rotation_speed, inputs["speed"][0], Air(**air), incidence)

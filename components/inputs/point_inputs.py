"""Inputs of operating points, and the state of the rotor that they make."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any

from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.records.air import Air
from propmdao.records.quantities import AIR, ASKED
from propmdao.records.states import RotorState

#: What of the air may be an input.
AIR_INPUTS = tuple(name for name, quantity in ASKED.items() if quantity.record == AIR)


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
        component.add_point_input(
            quantity.variable, val=quantity.default, units=quantity.unit, desc=quantity.meaning
        )


def state_at(inputs: Arrays, rotation_speed: Any) -> RotorState:
    """State of the rotor at an operating point.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs by name: the speed, and of the air what is an input; the rest of it is standard.
    rotation_speed : float
        Rotation speed [rad/s].

    Returns
    -------
    RotorState
        For the solutions and the sources of sound.
    """
    air = {name: inputs[name][0] for name in AIR_INPUTS if name in inputs}
    return RotorState(rotation_speed, inputs["speed"][0], Air(**air))

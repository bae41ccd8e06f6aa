"""Inputs of all kinds of noise: motion of the rotor, air, and observers."""

from __future__ import annotations

from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.components.inputs.point_inputs import add_point_inputs, state_at
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S


def add_noise_inputs(component: NodesComp, observers: np.ndarray) -> None:
    """Declare the inputs that `noise_state` reads, and the observers.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.
    observers : (n_observers, 3) array
        Initial positions [m].
    """
    component.add_point_input("rpm", val=4000.0, units="rpm")
    add_point_inputs(component, ["speed", "density", "sound_speed"])
    component.add_input("observer_position", val=observers, units="m", tags=STATIC)


def noise_state(inputs: Arrays) -> RotorState:
    """State of the rotor whose noise is heard.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs by name.

    Returns
    -------
    RotorState
        For the sources of sound.
    """
    return state_at(inputs, inputs["rpm"][0] * RAD_PER_S)


def check_rotor(inputs: Any, nodes: str) -> None:
    """Refuse blades that reach the speed of sound or an observer.

    Parameters
    ----------
    inputs : mapping
        Inputs of the component, those of `add_noise_inputs` among them.
    nodes : str
        Name of the input that holds points of the blade, (..., 3).

    Raises
    ------
    om.AnalysisError
        When the blade tip is not slower than sound, or an observer not outside the rotor.
    """
    x, y, _ = np.moveaxis(np.asarray(inputs[nodes]), -1, 0)
    radius = float(np.hypot(x, y).max())
    try:
        require_subsonic_tip(radius, noise_state(inputs))
        require_outside_rotor(inputs["observer_position"], radius)
    except ValueError as error:
        raise om.AnalysisError(str(error)) from error

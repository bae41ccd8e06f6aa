"""Inputs of all kinds of noise: motion of the rotor, air, and observers."""

from __future__ import annotations

from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.components.bases.jax_component import Arrays
from propmdao.components.bases.nodes_comp import STATIC, OperatingPointsComp
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S


def add_noise_inputs(component: OperatingPointsComp, observers: np.ndarray) -> None:
    """Declare the inputs that `noise_at` reads.

    Parameters
    ----------
    component : OperatingPointsComp
        Component in its ``setup``.
    observers : (n_observers, 3) array
        Initial positions [m].
    """
    component.add_point_input("rpm", val=4000.0, units="rpm")
    component.add_point_input("speed", val=0.0, units="m/s")
    component.add_point_input("density", val=1.225, units="kg/m**3")
    component.add_point_input("sound_speed", val=340.294, units="m/s")
    component.add_input("observer_position", val=observers, units="m", tags=STATIC)


def noise_at(inputs: Arrays) -> tuple[RotorState, Any]:
    """State of the rotor and observers, which all kinds of noise take.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs by name.

    Returns
    -------
    state : RotorState
        Rotation speed, flight speed and air.
    observers : (n_observers, 3) array
        Positions from the rotor centre [m].
    """
    rpm, speed, density, sound_speed = (
        inputs[name][0] for name in ("rpm", "speed", "density", "sound_speed")
    )
    air = Air(density=density, sound_speed=sound_speed)
    return RotorState(rpm * RAD_PER_S, speed, air), inputs["observer_position"]


def check_rotor(inputs: Any, nodes: str) -> None:
    """Refuse blades that reach the speed of sound or an observer.

    Parameters
    ----------
    inputs : mapping
        With those of `add_noise_inputs`.
    nodes : str
        Input that holds points of the blade, (..., 3).

    Raises
    ------
    om.AnalysisError
        When the blade tip is not slower than sound, or an observer not outside the rotor.
    """
    x, y, _ = np.moveaxis(np.asarray(inputs[nodes]), -1, 0)
    radius = float(np.hypot(x, y).max())
    state, observers = noise_at(inputs)
    try:
        require_subsonic_tip(radius, state)
        require_outside_rotor(observers, radius)
    except ValueError as error:
        raise om.AnalysisError(str(error)) from error

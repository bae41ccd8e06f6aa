"""Inputs of all kinds of noise: motion of the rotor, air, and observers."""

from __future__ import annotations

from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.aerodynamics.sections.edge_layers.tables import SectionLayers
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import STATIC, NodesComp
from propmdao.components.inputs.point_inputs import (
    add_point_inputs,
    check_point_inputs,
    state_at,
)
from propmdao.records.listening import Floats, require_positions
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S


def declare_observers(options: OptionsDictionary, optional: bool = False) -> None:
    """Declare the observers, whose positions are checked when they are given.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    optional : bool
        None, no observers, is allowed and the default.
    """
    desc = "initial positions of the observers from the rotor centre (n, 3) [m]"
    if optional:
        options.declare("observers", None, set_function=_positions_or_none, desc=desc)
    else:
        options.declare("observers", set_function=_positions, desc=desc)


# Functions of the module, because OpenMDAO's recorders pickle options.
def _positions(_: Any, observers: Any) -> Floats:
    return require_positions(observers)


def _positions_or_none(_: Any, observers: Any) -> Floats | None:
    return None if observers is None else require_positions(observers)


def declare_azimuths(options: OptionsDictionary) -> None:
    """Declare the azimuths of a turn around which sources change.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.
    """
    options.declare(
        "n_azimuths",
        None,
        types=int,
        lower=2,
        allow_none=True,
        desc="azimuths of sources that change around the turn; None: steady ones, axial flight",
    )


def declare_layers(options: OptionsDictionary) -> None:
    """Declare the boundary layers of the sections, None without.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component.
    """
    options.declare(
        "layers",
        None,
        types=SectionLayers,
        allow_none=True,
        desc="boundary layers of the sections for broadband noise, as layers_for finds them",
    )


def declare_turbulent_inflow(options: OptionsDictionary) -> None:
    """Declare whether turbulence may flow in.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "turbulent_inflow",
        False,
        types=bool,
        desc="intensity and length scale of turbulence that flows in are inputs",
    )


def add_noise_inputs(component: NodesComp) -> None:
    """Declare the inputs that `noise_state` reads, and the observers.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``, with the options of `declare_observers` and `declare_azimuths`.
    """
    component.add_point_input("rpm", val=4000.0, units="rpm")
    add_point_inputs(component, ["speed", "density", "sound_speed"])
    if component.options["n_azimuths"] is not None:
        add_point_inputs(component, ["incidence_deg"])
    observers = component.options["observers"]
    component.add_input("observer_position", val=observers, units="m", tags=STATIC)


def noise_state(inputs: Arrays) -> RotorState:
    """State of the rotor whose noise is heard.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name.

    Returns
    -------
    RotorState
        State for the sources of sound.
    """
    return state_at(inputs, inputs["rpm"][0] * RAD_PER_S)


def check_rotor(inputs: Arrays, nodes: str) -> None:
    """Refuse operating points that are none, and blades that reach sound or an observer.

    Parameters
    ----------
    inputs : dict of arrays
        Inputs of one point by name, those of `add_noise_inputs` among them.
    nodes : str
        Name of the input that holds points of the blade, (..., 3).

    Raises
    ------
    om.AnalysisError
        If rotation or flight is backwards, the incidence beyond its range, a property of the air
        not positive, the blade tip not slower than sound, or an observer not outside the rotor.
    """
    check_point_inputs(inputs)
    x, y, _ = np.moveaxis(np.asarray(inputs[nodes]), -1, 0)
    radius = float(np.hypot(x, y).max())
    try:
        require_subsonic_tip(radius, noise_state(inputs))
        require_outside_rotor(inputs["observer_position"], radius)
    except ValueError as error:
        raise om.AnalysisError(str(error)) from error

"""Outputs of the components that find the loads of a rotor."""

from __future__ import annotations

import jax.numpy as jnp

from propmdao.aerodynamics.coefficients import coefficients
from propmdao.aerodynamics.solutions.result import RotorLoads, TiltedLoads
from propmdao.components.bases.array_function import Arrays
from propmdao.components.bases.nodes_comp import NodesComp
from propmdao.components.inputs.rotor_inputs import RotorKind
from propmdao.records.fidelity import Fidelity
from propmdao.records.quantities import HUB_LOADS, RESULTS
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

#: Outputs of every rotor, by their name in the table of quantities.
PERFORMANCE = tuple(name for name in RESULTS if name not in ("converged", "failure"))


def n_loads(fidelity: Fidelity, kind: RotorKind) -> int:
    """Return the number of point forces on a blade: bound and chordwise segments, sections.

    At an incidence there is one more on each ring, Bernoulli's unsteady term. Blade elements have
    one each.
    """
    nc, ns = fidelity.n_chordwise, fidelity.n_spanwise
    if kind.blade_element:
        return ns
    return nc * ns + nc * (ns + 1) + ns + nc * ns * (kind.n_azimuths is not None)


def add_performance(component: NodesComp, hub: bool) -> None:
    """Declare thrust, torque and what follows from them.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.
    hub : bool
        Whether force and moment on the hub are outputs, too.
    """
    results = [RESULTS[name] for name in PERFORMANCE]
    for quantity in (*results, *(HUB_LOADS.values() if hub else ())):
        shape = (len(quantity.axes),) if quantity.axes else ()
        component.add_point_output(quantity.variable, shape=shape, units=quantity.unit or None)


def add_loads(component: NodesComp, fidelity: Fidelity, kind: RotorKind) -> None:
    """Declare the loads along the blade, which are the sources of noise.

    Parameters
    ----------
    component : NodesComp
        Component in its ``setup``.
    fidelity : Fidelity
        Numbers of panels.
    kind : RotorKind
        Azimuths of loads that change around the turn, and whether these are of blade elements.
    """
    nc, ns = 1 if kind.blade_element else fidelity.n_chordwise, fidelity.n_spanwise
    n, n_azimuths = n_loads(fidelity, kind), kind.n_azimuths
    around, azimuth = ((), ()) if n_azimuths is None else ((n_azimuths,), ("azimuth",))
    component.axes = {
        "circulation": (*azimuth, "chordwise panel", "strip"),
        "load_position": ("load",),
        "load_force": (*azimuth, "load"),
        "section_speed": (*azimuth, "strip"),
        "section_angle_of_attack": (*azimuth, "strip"),
        "section_lift_coefficient": (*azimuth, "strip"),
    }
    add = component.add_point_output
    add("circulation", shape=(*around, nc, ns), units="m**2/s")
    add("load_position", shape=(n, 3), units="m")
    add("load_force", shape=(*around, n, 3), units="N")
    add("section_speed", shape=(*around, ns), units="m/s")
    add("section_angle_of_attack", shape=(*around, ns), units="rad")
    add("section_lift_coefficient", shape=(*around, ns))


def loads_outputs(loads: RotorLoads | TiltedLoads, state: RotorState, inputs: Arrays) -> Arrays:
    """Outputs of the component.

    Parameters
    ----------
    loads : RotorLoads or TiltedLoads
        Loads of the rotor.
    state : RotorState
        How the rotor turns and flies.
    inputs : dict of arrays
        Inputs by name.

    Returns
    -------
    dict of arrays
        Outputs by name, and the rotation speed.
    """
    numbers = coefficients(loads.thrust, loads.torque, state, inputs["diameter"][0])
    hub = HUB_LOADS if isinstance(loads, TiltedLoads) else ()
    return {
        **{name: getattr(loads, name) for name in hub},
        "rpm": jnp.asarray(state.rotation_speed / RAD_PER_S)[None],
        "thrust": loads.thrust[None],
        "torque": loads.torque[None],
        "shaft_power": (loads.torque * state.rotation_speed)[None],
        "efficiency": numbers.eta[None],
        "figure_of_merit": numbers.figure_of_merit[None],
        "J": numbers.J[None],
        "CT": numbers.CT[None],
        "CQ": numbers.CQ[None],
        "CP": numbers.CP[None],
        "circulation": loads.circulation,
        "load_position": loads.point_loads.position,
        "load_force": loads.point_loads.force,
        "section_speed": loads.sections.relative_speed,
        "section_angle_of_attack": loads.sections.angle_of_attack,
        "section_lift_coefficient": loads.sections.lift_coefficient,
    }

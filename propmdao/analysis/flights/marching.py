"""A march in time at an operating point."""

from __future__ import annotations

import dataclasses

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads, Progress
from propmdao.aerodynamics.wakes.edgewise import (
    edgewise_advance_ratio,
    grid_for,
    warn_if_fast,
)
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.records.models import Model
from propmdao.records.states import OperatingPoint, RotorState


def require_marchable(point: OperatingPoint) -> None:
    """Refuse what cannot be marched, before the work.

    Parameters
    ----------
    point : OperatingPoint
        What is asked for.

    Raises
    ------
    ValueError
        If a thrust is asked for, or a rotor at rest.
    """
    if point.rpm is None:
        raise ValueError("a march in time needs rpm, not thrust: find the rpm without unsteady")
    if point.rpm == 0.0:
        raise ValueError("a rotor that does not turn cannot be marched: rpm must be above 0")


def marched(
    case: RotorCase, point: OperatingPoint, model: Model, progress: Progress | None
) -> tuple[MarchedLoads, RotorState]:
    """March a rotor at an operating point.

    Parameters
    ----------
    case : RotorCase
        The rotor.
    point : OperatingPoint
        Rotation speed and flight of the rotor.
    model : Model
        How it is modelled, with a march.
    progress : callable or None
        Called after every step.

    Returns
    -------
    loads, state : MarchedLoads, RotorState
        Loads, and the state of the rotor.

    Raises
    ------
    ValueError
        If the tip is too fast, or the march needs too much memory; `MarchError` if it diverges.
    """
    assert model.loads.unsteady is not None and point.rotation_speed is not None
    state, radius = point.at(point.rotation_speed), float(case.rotor.radius)
    require_subsonic_tip(radius, state)
    grid, ratio = model.fidelity.period_wake, edgewise_advance_ratio(state, radius)
    warn_if_fast(ratio, stacklevel=4)
    wake = wake_transport(model.loads.wake, grid_for(ratio, grid))
    case = dataclasses.replace(case.turning(point.rotation_speed), wake=wake)
    return march(case, model.loads.unsteady, progress), state

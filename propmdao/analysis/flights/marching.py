"""A march in time at an operating point."""

from __future__ import annotations

import dataclasses

from propmdao.acoustics.kinematics.limits import require_subsonic_tip
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads, Progress
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.records.models import Model
from propmdao.records.states import OperatingPoint, RotorState

_SLOW, _LONGER = 0.05, 1.5  # advance ratio below which the wake has so many times the turns


def require_marchable(point: OperatingPoint, model: Model) -> None:
    """Refuse what cannot be marched, before the work.

    Parameters
    ----------
    point : OperatingPoint
        What is asked for.
    model : Model
        How it is modelled, with a march.

    Raises
    ------
    ValueError
        If a thrust is asked for, a rotor at rest, or broadband noise.
    """
    if point.rpm is None:
        raise ValueError("a march in time needs rpm, not thrust: find the rpm without unsteady")
    if point.rpm == 0.0:
        raise ValueError("a rotor that does not turn cannot be marched: rpm must be above 0")
    if model.noise.broadband is not None:
        raise ValueError("broadband noise of a march in time is not known: leave out unsteady")


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
    # The fastest a blade gets: at an incidence, on the advancing side.
    advancing = point.rotation_speed + float(state.edgewise_speed) / radius
    require_subsonic_tip(radius, RotorState(advancing, abs(float(state.axial_speed)), state.air))
    grid = model.fidelity.period_wake
    if float(state.edgewise_speed) < _SLOW * point.rotation_speed * radius:
        grid = dataclasses.replace(grid, turns=_LONGER * grid.turns)
    wake = wake_transport(model.loads.wake, grid)
    case = dataclasses.replace(case.turning(point.rotation_speed), wake=wake)
    return march(case, model.loads.unsteady, progress), state

"""Quieter propellers by design: vortex lattice, Formulation 1A and OpenMDAO components.

``import propmdao as pm`` gives what a script needs: a described propeller (`load_propeller`,
`Propeller`), its analysis (`analyze`, `sweep`, `fly_over`) with its
`band` of what is not known for sure, the records that say what is asked
(`OperatingPoint`, `Air`, `Change`, `Model`, `Listening` and what they hold, `Flight`) and the
builders of observers (`arc`, `circle`, `hemisphere`, `grid`, `point`). All of them are imported
when they are first used. OpenMDAO components are in `propmdao.components`.
"""

from __future__ import annotations

import importlib
from typing import TYPE_CHECKING, Any

__version__ = "0.1.0.dev0"

# Where each name comes from. Importing this package imports none of them: JAX takes a second.
_HOMES = {
    "Air": "records.air",
    "Analysis": "analysis.results",
    "Change": "propeller.changes",
    "Fidelity": "records.fidelity",
    "Flight": "analysis.flights.flyover_results",
    "Listening": "records.listening",
    "LoadModel": "records.models",
    "Model": "records.models",
    "NoiseModel": "records.models",
    "OperatingPoint": "records.states",
    "Propeller": "propeller.description",
    "SelfNoiseModel": "records.models",
    "Surroundings": "records.listening",
    "Transition": "records.models",
    "Uncertainties": "analysis.uncertainty",
    "WakeGrid": "records.wake_law",
    "WakeLaw": "records.wake_law",
    "analyze": "analysis.single_point",
    "arc": "acoustics.kinematics.observers",
    "band": "analysis.uncertainty",
    "circle": "acoustics.kinematics.observers",
    "fly_over": "analysis.flights.flyovers",
    "grid": "acoustics.kinematics.observers",
    "hemisphere": "acoustics.kinematics.observers",
    "load_propeller": "formats.propellers",
    "point": "acoustics.kinematics.observers",
    "sweep": "analysis.sweeping.sweeps",
}

__all__ = [
    "Air",
    "Analysis",
    "Change",
    "Fidelity",
    "Flight",
    "Listening",
    "LoadModel",
    "Model",
    "NoiseModel",
    "OperatingPoint",
    "Propeller",
    "SelfNoiseModel",
    "Surroundings",
    "Transition",
    "Uncertainties",
    "WakeGrid",
    "WakeLaw",
    "__version__",
    "analyze",
    "arc",
    "band",
    "circle",
    "fly_over",
    "grid",
    "hemisphere",
    "load_propeller",
    "point",
    "sweep",
]

if TYPE_CHECKING:  # what editors and type checkers see
    from propmdao.acoustics.kinematics.observers import arc as arc
    from propmdao.acoustics.kinematics.observers import circle as circle
    from propmdao.acoustics.kinematics.observers import grid as grid
    from propmdao.acoustics.kinematics.observers import hemisphere as hemisphere
    from propmdao.acoustics.kinematics.observers import point as point
    from propmdao.analysis.flights.flyover_results import Flight as Flight
    from propmdao.analysis.flights.flyovers import fly_over as fly_over
    from propmdao.analysis.results import Analysis as Analysis
    from propmdao.analysis.single_point import analyze as analyze
    from propmdao.analysis.sweeping.sweeps import sweep as sweep
    from propmdao.analysis.uncertainty import Uncertainties as Uncertainties
    from propmdao.analysis.uncertainty import band as band
    from propmdao.formats.propellers import load_propeller as load_propeller
    from propmdao.propeller.changes import Change as Change
    from propmdao.propeller.description import Propeller as Propeller
    from propmdao.records.air import Air as Air
    from propmdao.records.fidelity import Fidelity as Fidelity
    from propmdao.records.listening import Listening as Listening
    from propmdao.records.listening import Surroundings as Surroundings
    from propmdao.records.models import LoadModel as LoadModel
    from propmdao.records.models import Model as Model
    from propmdao.records.models import NoiseModel as NoiseModel
    from propmdao.records.models import SelfNoiseModel as SelfNoiseModel
    from propmdao.records.models import Transition as Transition
    from propmdao.records.states import OperatingPoint as OperatingPoint
    from propmdao.records.wake_law import WakeGrid as WakeGrid
    from propmdao.records.wake_law import WakeLaw as WakeLaw


def __getattr__(name: str) -> Any:
    """Import a name of the front door when it is first used."""
    if name not in _HOMES:
        raise AttributeError(f"module 'propmdao' has no attribute '{name}'")
    value = getattr(importlib.import_module(f"propmdao.{_HOMES[name]}"), name)
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    """List the front door, imported or not."""
    return sorted(set(globals()) | set(__all__))

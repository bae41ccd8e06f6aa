"""Options that say how a propeller is modelled, from the table of quantities."""

from __future__ import annotations

from collections.abc import Iterable
from typing import Any, get_args

from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.analysis.request import Request
from propmdao.records.fidelity import Fidelity, Start, WakeMotion
from propmdao.records.models import Layers, Model, SelfNoiseModel
from propmdao.records.quantities import ASKED
from propmdao.records.wake_law import WakeLaw

_RECORDS = {
    "fidelity": (Fidelity(), "numbers of panels, wake nodes and harmonics"),
    "wake": (WakeLaw(), "how the prescribed wake moves"),
}
_WORDS = {
    "layers": get_args(Layers),
    "start": get_args(Start),
    "wake_motion": get_args(WakeMotion),
}
_NUMBERS: dict[str, type | tuple[type, ...]] = {
    "revolutions": int,
    "average": int,
    "timestep_deg": (int, float),
}
#: Options of the transition, numbers or None.
TRANSITION_OPTIONS = ("n_crit", "trip_upper", "trip_lower")
#: Options of `declare_model`.
MODEL_OPTIONS = (
    *_RECORDS,
    "viscous",
    "blade_element",
    "stall_delay",
    *TRANSITION_OPTIONS,
    "unsteady",
    *_NUMBERS,
    "start",
    "wake_motion",
    "broadband",
    "trip",
    "layers",
)


def declare_model(options: OptionsDictionary, names: Iterable[str] = MODEL_OPTIONS) -> None:
    """Declare options of a model, with the defaults of an analysis.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    names : iterable of str
        Names among `MODEL_OPTIONS`.
    """
    for name in names:
        if name in _RECORDS:
            default, meaning = _RECORDS[name]
            options.declare(name, default, types=type(default), desc=meaning)
        else:
            quantity = ASKED[name]
            allowed: dict[str, Any] = {"types": bool}
            if name in _NUMBERS:
                allowed = {"types": _NUMBERS[name]}
            elif name in _WORDS:
                allowed = {"values": _WORDS[name]}
            elif name in TRANSITION_OPTIONS:
                allowed = {"types": (int, float), "allow_none": True}
            elif name == "trip":
                allowed = {"check_valid": _check_trip}
            options.declare(name, quantity.default, desc=quantity.meaning, **allowed)


def _check_trip(_: str, trip: Any) -> None:
    """Refuse words that are no trip."""
    SelfNoiseModel(trip)


def model_of(options: OptionsDictionary) -> Model:
    """Model that the options of a group describe.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a group, all of `MODEL_OPTIONS` among them.

    Returns
    -------
    Model
        The model of loads and noise.

    Raises
    ------
    ValueError
        If options contradict each other.
    """
    # A request has a point, too, but the model does not depend on it.
    return Request.of(rpm=0.0, **{name: options[name] for name in MODEL_OPTIONS}).model

"""Options of the group that say how a propeller is modelled, from the table of quantities."""

from __future__ import annotations

from typing import get_args

from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.analysis.request import Request
from propmdao.records.fidelity import Fidelity
from propmdao.records.models import Model, Trip
from propmdao.records.quantities import ASKED
from propmdao.records.wake_law import WakeLaw

_NAMES = tuple(name for name, quantity in ASKED.items() if quantity.record.startswith("model."))


def declare_trip(options: OptionsDictionary) -> None:
    """Declare how the boundary layers are tripped.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    quantity = ASKED["trip"]
    options.declare("trip", quantity.default, values=get_args(Trip), desc=quantity.meaning)


def declare_model(options: OptionsDictionary) -> None:
    """Declare the options that `model_of` reads.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a group.
    """
    options.declare("fidelity", Fidelity(), types=Fidelity, desc="Panels, harmonics, wake nodes.")
    options.declare("wake", WakeLaw(), types=WakeLaw, desc="How the prescribed wake moves.")
    for name in _NAMES:
        if name == "trip":
            declare_trip(options)
        else:
            quantity = ASKED[name]
            options.declare(name, quantity.default, types=bool, desc=quantity.meaning)


def model_of(options: OptionsDictionary) -> Model:
    """Model that the options of a group describe.

    Parameters
    ----------
    options : OptionsDictionary
        With the options of `declare_model`.

    Returns
    -------
    Model
        How loads and noise are computed.

    Raises
    ------
    ValueError
        If options contradict each other.
    """
    values = {name: options[name] for name in (*_NAMES, "fidelity", "wake")}
    return Request.of(rpm=0.0, **values).model

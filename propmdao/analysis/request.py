"""What is asked of an analysis, in its records or by single values."""

from __future__ import annotations

import dataclasses
import reprlib
from collections.abc import Mapping
from typing import Any, TypedDict

import numpy as np
import numpy.typing as npt

from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air, Turbulence
from propmdao.records.fidelity import Fidelity, GustShape, Marching, Start, WakeMotion
from propmdao.records.listening import Listening, Surroundings
from propmdao.records.models import (
    ElasticModel,
    Layers,
    LoadModel,
    Model,
    NoiseModel,
    SelfNoiseModel,
    Transition,
    Trip,
)
from propmdao.records.plain import from_plain, to_plain
from propmdao.records.quantities import ASKED
from propmdao.records.states import OperatingPoint
from propmdao.records.wake_law import WakeLaw


class Asked(TypedDict, total=False):
    """Single values in place of records; the table of quantities says what they mean."""

    rpm: float | None
    thrust: float | None
    speed: float
    incidence_deg: float
    density: float
    sound_speed: float
    dynamic_viscosity: float
    temperature: float
    pressure: float
    relative_humidity: float
    turbulence_intensity: float
    turbulence_length_scale: float
    twist_offset_deg: float
    chord_factor: float
    diameter: float | None
    n_blades: int | None
    viscous: bool
    blade_element: bool
    stall_delay: bool
    measured_drag: bool
    elastic: bool
    youngs_modulus: float | None
    shear_modulus: float | None
    material_density: float | None
    unsteady: bool
    revolutions: int
    average: int
    timestep_deg: float
    gust_speed: float
    gust_shape: GustShape
    gust_start: float
    gust_length: float
    start: Start
    wake_motion: WakeMotion
    broadband: bool
    trip: Trip | tuple[Trip, ...] | None
    layers: Layers
    wake: WakeLaw
    n_crit: float | None
    trip_upper: float | None
    trip_lower: float | None
    fidelity: Fidelity
    observers: npt.ArrayLike
    surroundings: Surroundings


@dataclasses.dataclass(frozen=True)
class Request:
    """What is asked of an analysis, beside the propeller.

    Attributes
    ----------
    point : OperatingPoint
        Rotation speed or thrust, flight speed, air.
    change : Change
        What is changed of the described propeller.
    model : Model
        How loads and noise are computed.
    listening : Listening
        Who listens, and what is around.

    Raises
    ------
    ValueError
        If turbulence flows in and no broadband noise is asked for.
    """

    point: OperatingPoint
    change: Change = Change()
    model: Model = dataclasses.field(default_factory=Model)
    listening: Listening = dataclasses.field(default_factory=Listening)

    def __post_init__(self) -> None:
        """Refuse turbulence that nobody would hear."""
        intensity = self.point.turbulence.turbulence_intensity
        if intensity > 0.0 and self.model.noise.broadband is None:
            raise ValueError(
                f"turbulence_intensity {intensity:g} m/s is about broadband noise: ask for"
                " broadband noise, too"
            )

    def completed(self, propeller: Propeller) -> Request:
        """Fill in what the model leaves to the propeller."""
        model = self.model.completed(propeller.transition, propeller.tip, propeller.trip)
        return dataclasses.replace(self, model=model)

    def to_dict(self) -> dict[str, Any]:
        """Return it as plain numbers, the part of ``propmdao analyze --json`` that was asked."""
        plain = to_plain(self)
        assert isinstance(plain, dict)
        return plain

    @classmethod
    def from_dict(cls, values: Mapping[str, Any]) -> Request:
        """Make the request that a JSON result answers.

        Parameters
        ----------
        values : dict
            With the keys of `to_dict`; others are left alone.

        Returns
        -------
        Request
            The same as it was.
        """
        names = [field.name for field in dataclasses.fields(cls)]
        return from_plain(cls, {name: values[name] for name in names if name in values})

    @classmethod
    def of(cls, records: Mapping[str, Any] | None = None, **values: Any) -> Request:
        """Make a request of single values.

        Parameters
        ----------
        records : mapping of str to record, optional
            Whole records by the attribute's name; None counts as not given.
        **values
            Single values, see `Asked`. A record that is given takes no single values.

        Returns
        -------
        Request
            Defaults for all the rest.

        Raises
        ------
        TypeError
            For a value that there is not, as Python itself says of a function's arguments.
        ValueError
            If a value contradicts a record or another value, or is out of range.
        """
        given_records = {k: record for k, record in (records or {}).items() if record is not None}
        places: dict[str, dict[str, Any]] = {}
        for name, value in values.items():
            if name not in _PLACES:
                raise TypeError(
                    f"'{name}' is nothing that can be asked; there are {', '.join(_PLACES)}"
                )
            place = _PLACES[name]
            record = place.split(".")[0]
            if record in given_records:
                raise ValueError(f"{name} is given, and {record}, which holds it: give one of them")
            if isinstance(getattr(ASKED.get(name), "default", None), bool):
                _require_switch(name, value)
            places.setdefault(place, {})[name] = value
        made: dict[str, Any] = {
            "point": lambda: OperatingPoint(
                **places.get("point", {}),
                air=Air(**places.get("point.air", {})),
                turbulence=Turbulence(**places.get("point.turbulence", {})),
            ),
            "change": lambda: Change(**places.get("change", {})),
            "model": lambda: _model(places),
            "listening": lambda: Listening(**places.get("listening", {})),
        }
        return cls(**{name: given_records.get(name) or make() for name, make in made.items()})


def _require_switch(name: str, value: Any) -> None:
    """Refuse what is neither True nor False, lest words or records count as True."""
    if not isinstance(value, bool | np.bool_):
        raise ValueError(f"{name} must be True or False; it is {reprlib.repr(value)}")


#: Record that holds each value, as a dotted path.
_PLACES = {name: quantity.record for name, quantity in ASKED.items()} | {
    "wake": "model.loads",
    "fidelity": "model",
    "observers": "listening",
    "surroundings": "listening",
}


def _model(places: Mapping[str, dict[str, Any]]) -> Model:
    """Model of single values."""
    broadband = places.get("model.noise", {}).get("broadband", False)
    self_noise = places.get("model.noise.broadband", {})
    for name, value in self_noise.items():
        # "none" asks for nothing that silence has not.
        if value not in (ASKED[name].default, "none") and not broadband:
            raise ValueError(
                f"{name} {value!r} is about broadband noise: ask for broadband noise, too"
            )
    transition = places.get("model.loads.transition", {})
    loads = dict(places.get("model.loads", {}))
    if not loads.get("viscous", True):
        for name, value in transition.items():
            if value is not None:
                raise ValueError(
                    f"{name} is about the polars of the sections: inviscid flow has none"
                )
    elastic, material = loads.pop("elastic", False), places.get("model.loads.elastic", {})
    named = [name for name, value in material.items() if value is not None]
    if named and not elastic:
        raise ValueError(f"{named[0]} is about an elastic blade: ask for elastic, too")
    loads["elastic"] = ElasticModel(**material) if elastic else None
    unsteady, schedule = loads.pop("unsteady", False), places.get("model.loads.unsteady", {})
    for name, value in schedule.items():
        if value != ASKED[name].default and not unsteady:
            raise ValueError(f"{name} is about a march in time: ask for unsteady, too")
    loads["unsteady"] = Marching(**schedule) if unsteady else None
    loads["transition"] = Transition(**transition)
    return Model(
        loads=LoadModel(**loads),
        noise=NoiseModel(SelfNoiseModel(**self_noise) if broadband else None),
        **places.get("model", {}),
    )

"""Write the JSON schema of ``propmdao analyze --json`` from records and table of quantities.

Run it from the repository: ``python docs/json_schema.py``.
"""

from __future__ import annotations

import dataclasses
import json
import types
import typing
from pathlib import Path
from typing import Any

import numpy as np

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.analysis.elastic.deflections import Deflection
from propmdao.analysis.request import Request
from propmdao.analysis.self_noise import MEASURED
from propmdao.records.quantities import (
    ASKED,
    BROADBAND_LEVELS,
    HUB_LOADS,
    LEVELS,
    MOTOR,
    MOTOR_RESULTS,
    RESULTS,
)
from propmdao.records.units import Quantity

FILE = Path(__file__).parent / "reference" / "analysis.schema.json"
NUMBER, TEXT, YES_OR_NO = ({"type": name} for name in ("number", "string", "boolean"))
_OF_BATTERY = ("battery_energy", "usable_share", "endurance")
VECTOR = {"type": "array", "items": NUMBER, "minItems": 3, "maxItems": 3}


def schema() -> dict[str, Any]:
    """Schema of the result at one operating point.

    Returns
    -------
    dict
        JSON schema, draft 2020-12.
    """
    propeller = {"name": TEXT, "diameter": NUMBER, "n_blades": {"type": "integer"},
                 "checksum": TEXT, "source": TEXT}  # fmt: skip
    asked = _record(Request)["properties"]
    found = {"rpm": _quantity(ASKED["rpm"], NUMBER), "speed": _quantity(ASKED["speed"], NUMBER)}
    found |= {"rho": _quantity(ASKED["density"], NUMBER)}
    special = {"converged": YES_OR_NO, "failure": {"type": ["string", "null"]}}
    found |= {name: _quantity(q, special.get(name, NUMBER)) for name, q in RESULTS.items()}
    found |= {name: _quantity(q, VECTOR) for name, q in HUB_LOADS.items()}
    azimuth = {"azimuth_deg": NUMBER, "blade_force": VECTOR, "blade_moment": VECTOR}
    tilted = {"azimuths": _list(_object(azimuth, azimuth))}
    revolution = {"thrust": NUMBER, "torque": NUMBER, "change": {"type": ["number", "null"]}}
    steps = {name: _list(NUMBER) for name in ("azimuth_deg", "thrust", "torque")}
    marched = {"revolutions": _list(_object(revolution, revolution)),
               "history": _object(steps, steps)}  # fmt: skip
    properties = {
        "propeller": _object(propeller, propeller),
        **asked,
        "polars": {"type": "object", "additionalProperties": TEXT,
                   "description": "where the polars of each airfoil come from"},
        **found,
        "deflection": {"anyOf": [_record(Deflection), {"type": "null"}]},
        "observers": _list(_observer()),
    }  # fmt: skip
    band = {"band": {"type": ["object", "null"], "description": "with --band"}}
    ends = {"least": NUMBER, "largest": NUMBER, "measured": _list(NUMBER), "outside": NUMBER}
    ranges = dict.fromkeys(MEASURED, _object(ends, ends))
    band |= {"broadband_range": _object(ranges, ranges)}
    files = {name: {"description": f"with --{option}"}
             for name, option in (("sound", "wav"), ("figures", "figures"), ("vtk", "vtk"),
                                  ("report", "report"),
                                  ("tables", "out and --spectra"))}  # fmt: skip
    kinds = {"endurance": {"type": ["number", "null"]}}
    motor = {name: _quantity(q, kinds.get(name, NUMBER))
             for name, q in (MOTOR | MOTOR_RESULTS).items()}  # fmt: skip
    always = {"motor": TEXT} | {n: s for n, s in motor.items() if n not in _OF_BATTERY}
    drive = {"drive": _object({"motor": TEXT} | motor, always)}
    return {
        "$schema": "https://json-schema.org/draft/2020-12/schema",
        "title": "propmdao analyze --json, one operating point",
        **_object(properties | tilted | marched | band | files | drive, properties),
    }


def _observer() -> dict[str, Any]:
    place = {"elevation_deg": NUMBER, "azimuth_deg": NUMBER, "radius": NUMBER}
    levels = {name: _quantity(q, NUMBER) for name, q in LEVELS.items()}
    with_noise = {name: _quantity(q, NUMBER) for name, q in BROADBAND_LEVELS.items()}
    names = ("spl_db", "spl_thickness_db", "spl_loading_db")
    harmonic = {"m": {"type": "integer"}, "frequency_hz": NUMBER, **dict.fromkeys(names, NUMBER)}
    band = {"frequency_hz": NUMBER, "spl_db": NUMBER}
    mechanisms = {f"{field.name}_db": NUMBER for field in dataclasses.fields(SelfNoise)}
    always = {
        **place,
        **levels,
        "harmonics": _list(_object(harmonic, harmonic)),
        "third_octave": _list(_object(band, band)),
    }
    weighted = {field.name: NUMBER for field in dataclasses.fields(SelfNoise)}
    broadband = {
        "broadband": _list(_object(band | mechanisms, band | mechanisms)),
        "broadband_dba": _object(weighted, weighted),
    }
    return _object(always | with_noise | broadband, always)


def _quantity(quantity: Quantity, kind: dict[str, Any]) -> dict[str, Any]:
    unit = f" [{quantity.unit}]" if quantity.unit else ""
    return kind | {"description": quantity.meaning + unit}


def _list(items: dict[str, Any]) -> dict[str, Any]:
    return {"type": "array", "items": items}


def _object(properties: dict[str, Any], required: typing.Iterable[str]) -> dict[str, Any]:
    return {
        "type": "object",
        "properties": properties,
        "required": list(required),
        "additionalProperties": False,
    }


def _record(record: type) -> dict[str, Any]:
    """Schema of a record as `propmdao.records.plain.to_plain` writes it."""
    properties = {}
    for name, hint in typing.get_type_hints(record).items():
        kind, quantity = _kind(hint), ASKED.get(name)
        properties[quantity.json if quantity else name] = (
            _quantity(quantity, kind) if quantity else kind
        )
    return _object(properties, properties)


def _kind(hint: Any) -> dict[str, Any]:
    """Schema of the values of a type."""
    if hint is type(None):
        return {"type": "null"}
    if dataclasses.is_dataclass(hint):
        return _record(typing.cast(type, hint))
    origin, arguments = typing.get_origin(hint), typing.get_args(hint)
    if origin is typing.Literal:
        return {"enum": list(arguments)}
    if isinstance(hint, types.UnionType) or origin is typing.Union:
        kinds: list[dict[str, Any]] = []
        for argument in arguments:
            if (kind := _kind(argument)) not in kinds:
                kinds.append(kind)
        return kinds[0] if len(kinds) == 1 else {"anyOf": kinds}
    if origin is tuple or origin is np.ndarray:
        return {"type": "array"}
    simple = {bool: YES_OR_NO, str: TEXT, int: {"type": "integer"}}
    return simple.get(hint, NUMBER)


def text() -> str:
    """Schema as it stands in the file."""
    return json.dumps(schema(), indent=1) + "\n"


if __name__ == "__main__":
    FILE.write_text(text(), encoding="utf-8")

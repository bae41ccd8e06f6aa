"""Propeller files in the designer's units, and the line that the blade angle is measured to."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np

from propmdao.propeller import checks
from propmdao.propeller.airfoils.datums import chord_from_flat_bottom, chord_from_parting_line
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import FloatArray, Propeller
from propmdao.records.quantities import require_asked

_UNITS = {"mm": 1e-3, "inch": 0.0254}  # m
#: Length that stands for an entry of a propeller in either unit.
_LENGTHS = {
    "diameter": "diameter",
    "r_over_R": "radius",
    "c_over_R": "chord",
    "beta_deg": "pitch",
    "sweep_over_R": "sweep",
    "rake_over_R": "rake",
    "trailing_edge_over_R": "trailing_edge_thickness",
}
#: Keys of each entry, the propeller's own first.
FORMS = {key: (key, *(f"{length}_{unit}" for unit in _UNITS)) for key, length in _LENGTHS.items()}
#: Lines that the blade angle may be measured to.
BETA_FROM = ("chord", "flat_bottom", "parting_line")
#: Difference between the last station and the tip that rounding to 0.01 inches or 0.1 mm leaves.
_ROUNDED = 5e-3


def in_own_units(data: dict[str, Any]) -> dict[str, Any]:
    """Turn lengths in millimetres and inches into the entries of a propeller.

    Parameters
    ----------
    data : dict
        Entries of a propeller file. ``diameter_mm``, ``diameter_inch`` stand for the diameter;
        ``radius_``, ``chord_``, ``sweep_``, ``rake_`` and ``trailing_edge_thickness_`` for what is
        over the tip radius (the last may be one number for all stations);
        ``pitch_`` for the blade angle, the angle of a screw that advances so far in a turn, at the
        stations or one number for all. The diameter may be left out beside radii, whose last is the
        tip.

    Returns
    -------
    dict
        The entries under the names of `propmdao.propeller.description.Propeller`.

    Raises
    ------
    PropellerError
        If an entry has two forms, is no length, or the last radius is not half the diameter.
    """
    own = {key: value for key, value in data.items() if key not in sum(FORMS.values(), ())}
    keys: dict[str, str] = {}
    for key, forms in FORMS.items():
        present = [form for form in forms if form in data]
        if len(present) > 1:
            raise PropellerError(f"{' and '.join(present)} are the same thing; give one of them")
        if present:
            keys[key] = present[0]
    lengths = {key: _length(form, data[form]) for key, form in keys.items() if form != key}
    own |= {key: data[form] for key, form in keys.items() if form == key}
    if not lengths:
        return own
    radius = _tip(keys, own, lengths)
    require_asked("diameter", 2.0 * radius, PropellerError)
    own["diameter"] = 2.0 * radius
    if "r_over_R" in lengths:
        own["r_over_R"] = lengths["r_over_R"] / lengths["r_over_R"][-1]
    for key in ("c_over_R", "sweep_over_R", "rake_over_R", "trailing_edge_over_R"):
        if key in lengths:
            values = lengths[key] / radius
            own[key] = values if np.ndim(data[keys[key]]) else float(values[0])
    if "beta_deg" in lengths:
        if "r_over_R" not in own:
            raise PropellerError(f"{keys['beta_deg']} needs stations: r_over_R or radius_mm")
        stations = radius * checks.stations(own["r_over_R"])
        pitch = lengths["beta_deg"]
        if pitch.size not in (1, stations.size):
            raise PropellerError(
                f"{keys['beta_deg']} has {pitch.size} values for {stations.size} stations"
            )
        own["beta_deg"] = np.degrees(np.arctan(pitch / (2.0 * np.pi * stations)))
    return own


def to_chord_line(propeller: Propeller, beta_from: Any) -> Propeller:
    """Refer the blade angle to the chord line.

    Parameters
    ----------
    propeller : Propeller
        Propeller whose blade angle is measured to another line of its sections.
    beta_from : {"chord", "flat_bottom", "parting_line"}
        The line: the chord line; a gauge that rests under the section; the line between the
        foremost and rearmost points, where a mould is parted.

    Returns
    -------
    Propeller
        The propeller with the blade angle of its chord line.

    Raises
    ------
    PropellerError
        If there is no such line.
    """
    if beta_from not in BETA_FROM:
        raise PropellerError(f"beta_from must be one of {', '.join(BETA_FROM)}; got {beta_from!r}")
    if beta_from == "chord":
        return propeller
    line: Callable[[FloatArray, FloatArray, float], float] = (
        chord_from_parting_line
        if beta_from == "parting_line"
        else lambda camber, thickness, _: chord_from_flat_bottom(camber, thickness)
    )
    beta = np.radians(propeller.beta_deg)
    steeper = [line(*shape) for shape in zip(*_as_described(propeller), beta, strict=True)]
    return dataclasses.replace(propeller, beta_deg=propeller.beta_deg + np.degrees(steeper))


def _as_described(propeller: Propeller) -> tuple[FloatArray, FloatArray]:
    """Camber line and thickness of the stations, scaled to what is described."""
    camber, thickness = propeller.sections()
    if propeller.camber_over_chord is not None:
        peak = np.take_along_axis(camber, np.abs(camber).argmax(axis=1)[:, None], axis=1)
        camber = camber / np.where(peak == 0.0, 1.0, peak) * propeller.camber_over_chord[:, None]
    if propeller.thickness_over_chord is not None:
        scale = propeller.thickness_over_chord / thickness.max(axis=1)
        thickness = thickness * scale[:, None]
    return camber, thickness


def _length(form: str, value: Any) -> FloatArray:
    """Lengths [m] of an entry whose name ends in its unit."""
    unit = _UNITS[form.rpartition("_")[2]]
    uniform = form.startswith(("pitch", "trailing_edge")) and np.ndim(value) == 0
    scalar = uniform or form.startswith("diameter")
    values = checks.distribution(form, [checks.number(form, value)] if scalar else value)
    if values.size == 0:
        raise PropellerError(f"{form} must hold a value; it is empty")
    return unit * values


def _tip(keys: dict[str, str], own: dict[str, Any], lengths: dict[str, FloatArray]) -> float:
    """Tip radius [m], by the diameter or the last station."""
    stations = lengths.get("r_over_R")
    if "diameter" not in keys:
        if stations is None:
            raise PropellerError("missing key 'diameter' (m), or diameter_mm or diameter_inch")
        return float(stations[-1])
    diameter = lengths["diameter"][0] if "diameter" in lengths else own["diameter"]
    radius = 0.5 * checks.number(keys["diameter"], diameter)
    if stations is not None and abs(stations[-1] - radius) > _ROUNDED * radius:
        raise PropellerError(
            f"{keys['r_over_R']} must end at the tip, half of {keys['diameter']}; it ends at "
            f"{stations[-1] / radius:.4g} of it"
        )
    return radius

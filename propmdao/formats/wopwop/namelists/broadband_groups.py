"""Namelist groups of the two broadband methods of PSU-WOPWOP, of a rotor's container."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np
from numpy.typing import NDArray

from propmdao.formats.wopwop.bpm_file import BpmFile, read_bpm_file
from propmdao.formats.wopwop.namelists.groups import Group
from propmdao.records.models import Tip, Trip

#: Trips of a case; the numbers are those of the program of NASA RP-1218.
_TRIPS: dict[int, Trip] = {0: "none", 1: "heavy", 2: "light"}
# Attributes of a `BpmFile` by their names in the group, and what &BPMIn calls their origin.
_QUANTITIES = {
    "chord": "sectchord",
    "length": "sectlength",
    "edge_thickness": "tethickness",
    "edge_angle": "teflowangle",
    "tip_slope": "tiplcs",
    "angle_of_attack": "sectaoa",
    "speed": "u",
}
_CHANGING = ("angle_of_attack", "speed", "tip_slope")
_MECHANISMS = ("tbltenoise", "lblvsnoise", "bluntnoise", "bladetipnoise")
_FROM_FILE, _FROM_USER, _COMPUTED = "filevalue", "uservalue", "compute"


@dataclass(frozen=True)
class BpmNoise:
    """Self-noise of blade sections by Brooks, Pope and Marcolini, as a case asks for it.

    Attributes
    ----------
    sections : BpmFile
        Sections; only `speed` may be None, which is then that of their motion.
    trip : {"none", "light", "heavy"}
        Trip of the boundary layers.
    tip : {"rounded", "square"}
        Planform of the tip.
    turbulent_edge, laminar_shedding, bluntness, tip_vortex : bool
        Mechanisms that are heard.
    """

    sections: BpmFile
    trip: Trip
    tip: Tip
    turbulent_edge: bool
    laminar_shedding: bool
    bluntness: bool
    tip_vortex: bool


@dataclass(frozen=True)
class PeggNoise:
    """Broadband noise of a rotor by Pegg's method, as a case asks for it.

    Attributes
    ----------
    thrust : float
        Thrust of the rotor [N].
    blade_area, blade_radius : float
        Planform of all blades [m^2] and their radius [m].
    rotation_speed : float or None
        Rotation speed [rad/s]; None: that of the container's rotation.
    lift_coefficient : float or None
        Mean lift coefficient of the blades; None: by thrust, area and tip speed.
    axis : (3,) array or None
        Direction of the shaft in the container; None: the axis of the container's rotation.
    """

    thrust: float
    blade_area: float
    blade_radius: float
    rotation_speed: float | None
    lift_coefficient: float | None
    axis: NDArray[np.float64] | None


def bpm_noise(group: Group) -> BpmNoise:
    """Read what a ``&BPMIn`` group asks for, and its file.

    Parameters
    ----------
    group : Group
        The group.

    Returns
    -------
    BpmNoise
        Sections and mechanisms.

    Raises
    ------
    WopwopFileError
        If a value is missing, out of range or is to be computed in a way that is not done.
    """
    n = group.count("nsect", least=2, most=10_000)
    if group.count("uniformblade", 0, 0, 1):
        raise group.error("uniformBlade = 1 is not computed: give every section (uniformBlade = 0)")
    if group.values.get("directivityflag", True) is not True:
        raise group.error("noise without directivity (DirectivityFlag = .false.) is not computed")
    name, file = group.text("bpmnoisefile"), None
    if name is not None:
        file = read_bpm_file(group.path.parent / name)
        if file.n_sections != n:
            raise group.error(f"nSect is {n}; {name} has {file.n_sections} sections")
    edge, laminar, blunt, vortex = (
        group.flag(key) if key in group.values else True for key in _MECHANISMS
    )
    quantities = {
        attribute: _quantity(group, attribute, file, n)
        for attribute in _QUANTITIES
        if vortex or attribute != "tip_slope"
    }
    quantities.setdefault("tip_slope", np.ones(1))
    for attribute in ("chord", "length"):
        if not np.all(np.asarray(quantities[attribute]) > 0.0):
            raise group.error(f"{_QUANTITIES[attribute]} must be positive at every section")
    thickness = np.asarray(quantities["edge_thickness"])
    if (n_below := int(np.sum(thickness < 0.0))) > 0:
        warnings.warn(
            f"{group}: TEThickness is below 0, down to {thickness.min():.3g} m, at {n_below} of {n}"
            " sections: they are taken as sharp",
            stacklevel=5,
        )
        quantities["edge_thickness"] = np.maximum(thickness, 0.0)
    trip = group.count("bltrip", 0, 0, max(_TRIPS))
    times, period = (None, None) if file is None else (file.times, file.period)
    if all((q := quantities[name]) is None or len(q) == 1 for name in _CHANGING):
        times, period = None, None
    return BpmNoise(
        BpmFile(n, **quantities, times=times, period=period),
        _TRIPS[trip],
        "rounded" if group.flag("roundbladetip") else "square",
        edge,
        laminar,
        blunt,
        vortex,
    )


def _quantity(
    group: Group, attribute: str, file: BpmFile | None, n: int
) -> NDArray[np.float64] | None:
    """Values of a quantity from where the group says; None where it is computed."""
    key = _QUANTITIES[attribute]
    flag = (group.text(f"{key}flag") or _COMPUTED).lower()
    if flag == _FROM_FILE:
        values = None if file is None else getattr(file, attribute)
        if values is None:
            raise group.error(f"{key}Flag is 'FileValue', and there is no file that holds it")
        return np.asarray(values)
    if flag == _FROM_USER:
        value = group.values.get(key)
        values = np.atleast_1d(np.array(value, float)) if _are_numbers(value) else np.zeros(0)
        wanted = (1,) if attribute == "tip_slope" else (1, n)
        if values.size not in wanted or not np.isfinite(values).all():
            raise group.error(f"{key} must be {' or '.join(map(str, wanted))} finite numbers")
        if attribute == "tip_slope":
            return values
        row = np.broadcast_to(values, n)
        return row[None] if attribute in ("angle_of_attack", "speed") else row
    if flag != _COMPUTED:
        raise group.error(f"{key}Flag must be 'Compute', 'UserValue' or 'FileValue'")
    if attribute == "speed":
        return None
    raise group.error(f"{key} is not computed: give a 'FileValue' or a 'UserValue'")


def pegg_noise_of(group: Group) -> PeggNoise:
    """Read what a ``&PeggIn`` group asks for.

    Parameters
    ----------
    group : Group
        The group.

    Returns
    -------
    PeggNoise
        Thrust, blades and shaft.

    Raises
    ------
    WopwopFileError
        If a value is missing, out of range or is to be computed in a way that is not done.
    """

    def value(key: str, computed: bool) -> float | None:
        flag = (group.text(f"{key}flag") or _COMPUTED).lower()
        if flag == _COMPUTED:
            if computed:
                return None
            raise group.error(f"{key} is not computed: give a 'UserValue'")
        if flag != _FROM_USER:
            raise group.error(f"{key}Flag must be 'Compute' or 'UserValue'")
        number = group.number(key)
        if not number > 0.0:
            raise group.error(f"{key} must be positive; it is {number:g}")
        return number

    axis = None
    if (group.text("hubaxisflag") or _COMPUTED).lower() == _FROM_USER:
        axis = np.array(group.vector("hubaxis"))
        if not axis.any():
            raise group.error("hubAxis must be three numbers, not all zero")
    thrust, area, radius = (
        value(key, computed=False) for key in ("totalthrust", "totalbladearea", "bladeradius")
    )
    assert thrust is not None and area is not None and radius is not None
    return PeggNoise(
        thrust,
        area,
        radius,
        value("rotspeed", computed=True),
        value("clbar", computed=True),
        axis,
    )


def _are_numbers(value: object) -> bool:
    items = value if isinstance(value, list) else [value]
    return all(isinstance(x, int | float) and not isinstance(x, bool) for x in items)

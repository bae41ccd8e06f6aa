"""Every quantity once: name, unit, default and meaning, and its names in files and options.

Options and their help, keys of JSON, columns of tables, inputs and outputs of components and the
nomenclature page (docs/conventions.md) come from this table. Nothing here is slow to import.
"""

from __future__ import annotations

from typing import Any

from propmdao.records.units import Quantity, Range

# Records that hold quantities that are asked for, as a dotted path from the request; results have
# none.
POINT, AIR, CHANGE = "point", "point.air", "change"
LOADS, SELF_NOISE, FIDELITY = "model.loads", "model.noise.broadband", "model.fidelity"
TRANSITION = "model.loads.transition"
ELASTIC = "model.loads.elastic"
UNSTEADY = "model.loads.unsteady"
TURBULENCE = "point.turbulence"


_ASKED = (
    Quantity(
        "rpm", "rpm", "rotation speed", POINT, option="--rpm", placeholder="N",
        help="rotation speed [rev/min]",
        allowed=Range(0.001, 1e6, "rpm", or_zero=True),
    ),
    Quantity(
        "thrust", "N", "thrust of all blades", POINT, variable="thrust_required",
        option="--thrust", placeholder="N", help="find the rotation speed that gives this thrust"
        " [N]",
        allowed=Range(1e-9, 1e9, "N"),
    ),
    Quantity(
        "speed", "m/s", "flight speed, 0 is hover", POINT, 0.0, option="--speed",
        placeholder="M_S", help="flight speed, along the axis unless there is an incidence [m/s],"
        " default 0: hover",
        allowed=Range(0.0, 1000.0, "m/s"),
    ),
    Quantity(
        "incidence_deg", "deg", "angle between shaft and direction of flight, 0 is axial flight",
        POINT, 0.0, variable="incidence", option="--incidence", placeholder="DEG",
        help="angle between the shaft and the direction of flight [deg], default 0: axial, 90"
        " edgewise, above 90 with a descending part. A drone that leans forward by 20 deg in level"
        " flight flies at 70",
        allowed=Range(0.0, 150.0, "deg"),
    ),
    Quantity(
        "density", "kg/m**3", "density of the air", AIR, 1.225, json="rho", option="--rho",
        placeholder="KG_M3", help="air density [kg/m3], default 1.225",
        allowed=Range(1e-4, 2000.0, "kg/m3"),
    ),
    Quantity("sound_speed", "m/s", "speed of sound", AIR, 340.294,
        allowed=Range(50.0, 3000.0, "m/s"),
    ),
    Quantity("dynamic_viscosity", "Pa*s", "dynamic viscosity of the air", AIR, 1.789e-5,
        allowed=Range(1e-7, 1.0, "Pa s"),
    ),
    Quantity("temperature", "K", "temperature of the air that absorbs sound", AIR, 288.15,
        allowed=Range(20.0, 1000.0, "K"),
    ),
    Quantity("pressure", "Pa", "pressure of the air that absorbs sound", AIR, 101325.0,
        allowed=Range(1.0, 1e8, "Pa"),
    ),
    Quantity("relative_humidity", "", "relative humidity of the air, 0 ... 1", AIR, 0.7,
        allowed=Range(0.0, 1.0),
    ),
    Quantity(
        "turbulence_intensity", "m/s", "root mean square of each component of the velocity of"
        " turbulence that flows in", TURBULENCE, 0.0, option="--turbulence-intensity",
        placeholder="M_S",
        help="turbulence that flows into the rotor, heard as broadband noise: root mean square of"
        " each component of the velocity [m/s], default 0: none",
        allowed=Range(0.0, 100.0, "m/s"),
    ),
    Quantity(
        "turbulence_length_scale", "m", "longitudinal integral length scale of the turbulence that"
        " flows in", TURBULENCE, 0.0, option="--turbulence-length", placeholder="M",
        help="its longitudinal integral length scale [m]",
        allowed=Range(1e-5, 1e4, "m", or_zero=True),
    ),
    Quantity(
        "twist_offset_deg", "deg", "added to the blade angle everywhere", CHANGE, 0.0,
        per_node=False, option="--twist-offset", placeholder="DEG",
        help="added to the blade angle everywhere [deg], default 0",
        allowed=Range(-180.0, 180.0, "deg"),
    ),
    Quantity(
        "chord_factor", "", "times the chord everywhere", CHANGE, 1.0, per_node=False,
        option="--chord-factor", placeholder="F", help="times the chord everywhere, default 1",
        allowed=Range(0.001, 100.0),
    ),
    Quantity(
        "diameter", "m", "diameter from tip to tip, which stretches the whole blade", CHANGE,
        per_node=False, option="--diameter", placeholder="M",
        help="stretches the whole blade [m]; default the propeller's",
        allowed=Range(0.001, 1000.0, "m"),
    ),
    Quantity(
        "n_blades", "", "number of blades", CHANGE, per_node=False, option="--blades",
        placeholder="B", help="number of blades; default the propeller's",
        allowed=Range(1, 40),
    ),
    Quantity(
        "viscous", "", "lattice held to the polars of the sections", LOADS, True, per_node=False,
        option="--inviscid", help="without the polars of the sections: no drag",
    ),
    Quantity(
        "blade_element", "", "blade elements in annuli in place of the lattice", LOADS, False,
        per_node=False, option="--blade-element",
        help="loads by blade elements in annuli of momentum, with losses at tip and root, in place"
        " of the lattice: much faster, and up to a fifth more thrust on wide blades",
    ),
    Quantity(
        "stall_delay", "", "stall of the sections delayed by rotation", LOADS, True,
        per_node=False, option="--no-stall-delay",
        help="let the sections stall as in two dimensions; by default rotation delays it (Du and"
        " Selig)",
    ),
    Quantity(
        "n_crit", "", "amplification exponent at which boundary layers turn turbulent", TRANSITION,
        per_node=False, option="--n-crit", placeholder="N",
        help="critical amplification exponent of transition in the polars: 9 is a quiet wind"
        " tunnel, less is disturbed air; default the propeller's, or 5",
        allowed=Range(0.1, 30.0),
    ),
    Quantity(
        "trip_upper", "", "x/c at which the upper side is tripped; 1 is free", TRANSITION,
        per_node=False, option="--trip-upper", placeholder="X_C",
        help="x/c at which the upper side is tripped in the polars: forced transition, 1 is free;"
        " default the propeller's, or 1. With both sides tripped up to x/c 0.5 the broadband noise"
        " is of lightly tripped blades",
        allowed=Range(0.0, 1.0),
    ),
    Quantity(
        "trip_lower", "", "x/c at which the lower side is tripped; 1 is free", TRANSITION,
        per_node=False, option="--trip-lower", placeholder="X_C",
        help="the same of the lower side",
        allowed=Range(0.0, 1.0),
    ),
    Quantity(
        "measured_drag", "", "drag of the sections at the level of wind tunnels", LOADS, True,
        per_node=False, option="--computed-drag",
        help="leave the drag of the catalogue's and NeuralFoil's polars as computed; by default it"
        " is brought to the level that wind tunnels measure",
    ),
    Quantity(
        "elastic", "", "blade that twists and bends under centrifugal and air loads", LOADS, False,
        per_node=False, option="--elastic",
        help="let the blade twist and bend under centrifugal and air loads; needs its material, in"
        " the propeller file or by the options below",
    ),
    Quantity(
        "youngs_modulus", "Pa", "Young's modulus of the blade", ELASTIC, per_node=False,
        option="--youngs-modulus", placeholder="PA",
        help="Young's modulus of the elastic blade [Pa]; default the propeller file's",
        allowed=Range(1e6, 1e13, "Pa"),
    ),
    Quantity(
        "shear_modulus", "Pa", "shear modulus of the blade, by default Young's over 2.7", ELASTIC,
        per_node=False, option="--shear-modulus", placeholder="PA",
        help="shear modulus of the elastic blade [Pa]; default the propeller file's, or Young's"
        " over 2.7 (Poisson's ratio 0.35)",
        allowed=Range(1e5, 1e13, "Pa"),
    ),
    Quantity(
        "material_density", "kg/m**3", "density of the blade", ELASTIC, per_node=False,
        option="--material-density", placeholder="KG_M3",
        help="density of the elastic blade [kg/m3]; default the propeller file's",
        allowed=Range(1.0, 25000.0, "kg/m3"),
    ),
    Quantity(
        "unsteady", "", "loads marched in time", LOADS, False, per_node=False, option="--unsteady",
        help="march the loads in time, step by step, instead of solving for what repeats: for a"
        " free wake and as a check; needs --rpm",
    ),
    Quantity(
        "revolutions", "", "revolutions of a march", UNSTEADY, 4, per_node=False,
        option="--revolutions", placeholder="N", help="revolutions that are marched, default 4",
        allowed=Range(1, 1000),
    ),
    Quantity(
        "average", "", "last revolutions of a march of which loads are the mean", UNSTEADY, 3,
        per_node=False, option="--average", placeholder="N",
        help="last revolutions of which the loads are the mean, default 3",
        allowed=Range(1, 1000),
    ),
    Quantity(
        "timestep_deg", "deg", "angle by which the rotor turns in a time step", UNSTEADY, 3.0,
        per_node=False, option="--timestep", placeholder="DEG",
        help="angle by which the rotor turns in a time step, which divides 360 [deg], default 3",
        allowed=Range(0.25, 45.0, "deg"),
    ),
    Quantity(
        "start", "", "what a march begins with", UNSTEADY, "steady", per_node=False,
        option="--start", placeholder="{steady,impulsive}",
        help="begin the march with the steady wake of axial flight (default) or with none",
    ),
    Quantity(
        "wake_motion", "", "how the wake of a march moves", UNSTEADY, "prescribed",
        per_node=False, option="--wake", placeholder="{prescribed,free}",
        help="how the wake of the march moves: by the law of the steady solution (default), or"
        " freely, every node with the local velocity",
    ),
    Quantity(
        "gust_speed", "m/s", "largest speed of a gust along the shaft, from ahead positive",
        UNSTEADY, 0.0, per_node=False, option="--gust", placeholder="M_S",
        help="a gust along the shaft in the march: its largest speed, positive from ahead, which on"
        " an upright shaft is from above [m/s], default 0: none",
        allowed=Range(-340.0, 340.0, "m/s"),
    ),
    Quantity(
        "gust_shape", "", "how a gust comes", UNSTEADY, "cosine", per_node=False,
        option="--gust-shape", placeholder="{cosine,step}",
        help="the gust comes and goes, (1 - cos)/2 (default), or comes likewise and stays",
    ),
    Quantity(
        "gust_start", "", "revolutions of a march before the gust", UNSTEADY, 1.0, per_node=False,
        option="--gust-start", placeholder="N", help="revolutions before the gust, default 1",
        allowed=Range(0.0, 1000.0),
    ),
    Quantity(
        "gust_length", "", "revolutions over which a gust comes and goes, or comes", UNSTEADY, 1.0,
        per_node=False, option="--gust-length", placeholder="N",
        help="revolutions over which the gust comes and goes, or comes, default 1",
        allowed=Range(0.001, 1000.0),
    ),
    Quantity(
        "broadband", "", "broadband self-noise beside the tones", "model.noise", False,
        per_node=False, option="--broadband", help="add the broadband self-noise to the tones",
    ),
    Quantity(
        "trip", "", "tripping of the boundary layers in broadband noise", SELF_NOISE,
        per_node=False, option="--trip", placeholder="{none,light,heavy}",
        help="tripped boundary layers in the broadband noise alone; default the propeller's, or as"
        " in the polars: none. Untripped ones shed vortices where they separate laminar; a rough or"
        " dusty blade sheds none",
    ),
    Quantity(
        "layers", "", "boundary layers at the trailing edge in broadband noise", SELF_NOISE,
        "sections", per_node=False, option="--layers", placeholder="{sections,bpm}",
        help="boundary layers at the trailing edge in the broadband noise: of the blade's own"
        " sections (default), or the fits of NASA RP-1218 to a NACA 0012",
    ),
)  # fmt: skip

_RESULTS = (
    Quantity("J", "", "advance ratio V / (n D), n in rev/s"),
    Quantity("thrust", "N", "thrust of all blades"),
    Quantity("torque", "N*m", "shaft torque of all blades"),
    Quantity("shaft_power", "W", "shaft power of all blades"),
    Quantity("CT", "", "thrust coefficient T / (rho n^2 D^4)"),
    Quantity("CQ", "", "torque coefficient Q / (rho n^2 D^5)"),
    Quantity("CP", "", "power coefficient 2 pi CQ"),
    Quantity(
        "eta", "", "propulsive efficiency J CT / CP, 0 in hover, below 0 of a brake",
        variable="efficiency",
    ),
    Quantity("figure_of_merit", "", "ideal power of hover T^1.5 / sqrt(2 rho A) over shaft power"),
    Quantity("converged", "", "whether the solution of the loads has converged"),
    Quantity("failure", "", "why it has not, or null"),
)  # fmt: skip

# In the axes of docs/conventions.md, which do not turn with the blades.
_HUB_LOADS = (
    Quantity(
        "hub_force", "N", "mean force of all blades on the hub; z is the shaft, the rotor flies"
        " toward z and x", axes=("x", "y", "z"),
    ),
    Quantity(
        "hub_moment", "N*m", "mean moment of all blades on the hub about the rotor's centre; -z is"
        " the torque", axes=("x", "y", "z"),
    ),
)  # fmt: skip

_LEVELS = (
    Quantity("spl_bpf_db", "dB", "level of the tone at the blade passage frequency"),
    Quantity("oaspl_db", "dB", "overall level of the tones"),
    Quantity("oaspl_thickness_db", "dB", "overall level of the tones of thickness noise"),
    Quantity("oaspl_loading_db", "dB", "overall level of the tones of loading noise"),
    Quantity("oaspl_dba", "dBA", "A-weighted overall level of the tones"),
)

_BROADBAND_LEVELS = (
    Quantity("oaspl_broadband_db", "dB", "overall level of the broadband noise"),
    Quantity("oaspl_broadband_dba", "dBA", "A-weighted overall level of the broadband noise"),
    Quantity("oaspl_total_db", "dB", "overall level of tones and broadband noise"),
    Quantity("oaspl_total_dba", "dBA", "A-weighted overall level of tones and broadband noise"),
)

_MOTOR = (
    Quantity("speed_constant", "rpm/V", "rotation speed for each volt against the motor",
        per_node=False, allowed=Range(0.01, 1e6, "rpm/V")),
    Quantity("resistance", "ohm", "electrical resistance of the motor", per_node=False,
        allowed=Range(0.0, 1e4, "ohm")),
    Quantity("no_load_current", "A", "current of the motor without torque", per_node=False,
        allowed=Range(0.0, 1e4, "A")),
    Quantity("battery_energy", "W*h", "energy of the battery for one rotor", per_node=False,
        option="--battery-wh", placeholder="WH", allowed=Range(1e-6, 1e9, "W h")),
    Quantity("usable_share", "", "part of that energy that may be used", default=0.8,
        per_node=False, option="--usable-share", placeholder="SHARE", allowed=Range(0.01, 1.0)),
)  # fmt: skip

_MOTOR_RESULTS = (
    Quantity("current", "A", "current through the motor"),
    Quantity("voltage", "V", "voltage at the motor"),
    Quantity("electrical_power", "W", "power that the motor takes, below 0 of a generator"),
    Quantity("motor_efficiency", "", "shaft power over that power, below 0 of a generator"),
    Quantity("endurance", "s", "time for which the usable energy lasts"),
)

#: What may be asked, by name.
ASKED = {quantity.name: quantity for quantity in _ASKED}
#: What an analysis finds, by name.
RESULTS = {quantity.name: quantity for quantity in _RESULTS}
#: Force and moment of the rotor on what carries it, by name.
HUB_LOADS = {quantity.name: quantity for quantity in _HUB_LOADS}
#: Constants of a motor and its battery, and what they find, by name.
MOTOR = {quantity.name: quantity for quantity in _MOTOR}
MOTOR_RESULTS = {quantity.name: quantity for quantity in _MOTOR_RESULTS}
#: Levels of the tones at an observer, by name.
LEVELS = {quantity.name: quantity for quantity in _LEVELS}
#: Levels at an observer that broadband noise adds, by name.
BROADBAND_LEVELS = {quantity.name: quantity for quantity in _BROADBAND_LEVELS}


def _column(quantity: Quantity) -> str:
    """Column of a value that a point of a sweep gives: thrust is also the name of a result."""
    return quantity.variable if quantity.name in RESULTS else quantity.json


#: Values that a point of a sweep may give, by their column.
VARIABLES = {
    _column(quantity): quantity
    for quantity in ASKED.values()
    if quantity.record in (POINT, CHANGE) or quantity.name == "density"
}


def require_asked(name: str, value: Any, error: type[ValueError] = ValueError) -> None:
    """Refuse a value of a quantity that is outside its range.

    Parameters
    ----------
    name : str
        Name of a quantity in `ASKED` that is a number.
    value : float
        The value.
    error : type
        Exception that is raised, a ValueError.

    Raises
    ------
    ValueError
        If the value is no number or out of range; an exception of the type `error`.
    """
    allowed = ASKED[name].allowed
    assert allowed is not None  # words and switches have no range
    allowed.require(name, value, error)

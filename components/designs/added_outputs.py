"""What a design problem adds to the propeller: means, the Mach number of the tip, thickness."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt
import openmdao.api as om

from propmdao.components.noise_objective_comp import NoiseObjectiveComp
from propmdao.propeller.description import Propeller
from propmdao.propeller.design_choices import RESPONSES
from propmdao.records.states import OperatingPoint

Floats = npt.NDArray[np.float64]


def is_tilted(points: Sequence[OperatingPoint]) -> bool:
    """Whether the shaft stands at an angle to the flight at any of the operating points.

    Parameters
    ----------
    points : sequence of OperatingPoint
        Operating points of a design.

    Returns
    -------
    bool
        True where loads change around the turn.
    """
    return any(point.incidence_deg != 0.0 for point in points)


def output_name(word: str, n_points: int) -> str:
    """Output of the model that a word stands for where it is minimised.

    Parameters
    ----------
    word : str
        Word of `propmdao.propeller.design_choices.RESPONSES`.
    n_points : int
        Number of operating points.

    Returns
    -------
    str
        Name of the output.
    """
    response = RESPONSES[word]
    averaged = response.is_noise or (n_points > 1 and response.may_be_minimised)
    return f"mean_{word}" if averaged else response.output


def add_response(
    model: om.Group,
    word: str,
    points: Sequence[OperatingPoint],
    n_observers: int,
    propeller: Propeller,
) -> None:
    """Add what the group does not have: levels over all observers, means, the tip's Mach number.

    Parameters
    ----------
    model : om.Group
        Model with the group's outputs, promoted.
    word : str
        Word of `propmdao.propeller.design_choices.RESPONSES`.
    points : sequence of OperatingPoint
        Operating points of the design.
    n_observers : int
        Number of observers.
    propeller : Propeller
        The described propeller.
    """
    response, n = RESPONSES[word], len(points)
    if response.is_noise:
        shape = (n_observers,) if n == 1 else (n, n_observers)
        model.add_subsystem(
            f"all_{word}",
            NoiseObjectiveComp(shape=shape, exponent=1.0),
            promotes_inputs=[("level_db", response.output)],
            promotes_outputs=[("soft_maximum_db", output_name(word, n))],
        )
    elif word == "tip-mach":
        per_point = {"shape": n}
        # At an incidence the fastest of a turn, where the blade advances.
        edgewise = " + speed * sin(incidence)" if is_tilted(points) else ""
        axial = " * cos(incidence)" if is_tilted(points) else ""
        incidence = {"incidence": {**per_point, "units": "rad"}} if is_tilted(points) else {}
        mach = om.ExecComp(
            f"tip_mach = ((0.5 * diameter * rotation_speed{edgewise})**2 + (speed{axial})**2)**0.5"
            " / sound_speed",
            tip_mach=per_point,
            rotation_speed={**per_point, "units": "rad/s"},
            diameter={"val": propeller.diameter, "units": "m"},
            speed={**per_point, "units": "m/s"},
            sound_speed={**per_point, "units": "m/s"},
            **incidence,
        )
        inputs = ["diameter", "speed", "sound_speed", ("rotation_speed", "rpm"), *incidence]
        model.add_subsystem("tip", mach, promotes_inputs=inputs, promotes_outputs=["tip_mach"])
        model.set_input_defaults("diameter", propeller.diameter, units="m")
    elif n > 1:
        unit = {"units": response.unit}
        mean = om.ExecComp(f"mean = sum(each) / {n}", mean=unit, each={"shape": n, **unit})
        model.add_subsystem(
            f"all_{word}",
            mean,
            promotes_inputs=[("each", response.output)],
            promotes_outputs=[("mean", output_name(word, n))],
        )


def add_thickness(
    model: om.Group, least: float, propeller: Propeller, described: Mapping[str, Floats]
) -> None:
    """Add the thickness of the sections in metres at the stations, and its limit.

    Parameters
    ----------
    model : om.Group
        Model with the group's distributions, promoted.
    least : float
        Least thickness [m].
    propeller : Propeller
        The described propeller, which may be thinner.
    described : mapping of str to array
        Distributions of the described propeller.
    """
    radius, n = 0.5 * propeller.diameter, len(propeller.r_over_R)
    thickness = om.ExecComp(
        "section_thickness = radius * chord * ratio",
        has_diag_partials=True,
        section_thickness={"shape": n, "units": "m"},
        radius={"val": np.full(n, radius), "constant": True},
        chord={"shape": n},
        ratio={"shape": n},
    )
    model.add_subsystem(
        "sections",
        thickness,
        promotes_inputs=[("chord", "chord_over_R"), ("ratio", "thickness_over_chord")],
        promotes_outputs=["section_thickness"],
    )
    now = radius * np.asarray(described["chord_over_R"]) * described["thickness_over_chord"]
    lower = np.minimum(least, now)
    model.add_constraint("section_thickness", lower=lower, units="m", ref=least)

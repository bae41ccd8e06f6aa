"""A blade free in chord, twist, thickness, camber and sweep: the problem of `gradient_design.py`.

29 control points shape the blade of the APC Slow Flyer 11x4.7 with NACA 4-digit sections; it gives
the thrust of the thesis' problem without more torque. What is minimised is heard by a row of
microphones on the wake's side, by their soft maximum: at a single one an optimiser lets thickness
and loading noise cancel each other and makes others louder. Tones and the A-weighted total with
broadband noise ask for different blades, so one of them is minimised and the other held at the
baseline's.

The bounds and slopes below keep the search where the model holds:

- thickness 4 to 20 % and camber 0 to 8.5 % of the chord: the polars know 3 to 22 % and 0 to 9 %;
- chords at least 70 % of the baseline's: the polars know Reynolds numbers from 3e3. The fits of
  broadband noise were measured from 5e4 (NASA RP-1218), which tips of this size do not reach;
- sweep at most 0.5 R per R, 27 deg: neither polars nor strips of broadband noise know more of it;
  and 0.15 R at the tip, which makes the disk 1 % wider;
- slopes between control points: strips know nothing of a neighbour with quite another section;
- sections nowhere thinner than a moulded blade is made, in metres: t = t/c c.

Twist, chord and rotation speed have room enough for the trim to find the thrust in every corner.
"""

from pathlib import Path

import low_noise_design as thesis
import numpy as np
import openmdao.api as om
from low_noise_design import BASELINE

import propmdao as pm
from propmdao.components import NoiseObjectiveComp, PropellerGroup
from propmdao.formats.naca_blade import with_naca_sections

AT = np.array([0.15, 0.3, 0.5, 0.7, 0.85, 1.0])  # r/R of the control points
MICROPHONES = [-75.0, -60.0, -45.0, -30.0, -15.0]  # deg, at the distance of the thesis' one
EXPONENT = 8.0  # of the soft maximum
_CHORD = np.interp(AT, BASELINE.r_over_R, BASELINE.c_over_R)
_TWIST = np.interp(AT, BASELINE.r_over_R, BASELINE.beta_deg)
# Lower and upper bound of the control points; of the slopes between them, per tip radius. In deg
# for the blade angle.
BOUNDS = {
    "chord_over_R": (0.7 * _CHORD, np.array([2.0, 1.5, 1.5, 1.5, 1.5, 3.0]) * _CHORD),
    "beta": (np.maximum(_TWIST - 8.0, 0.5), _TWIST + 8.0),
    "thickness_over_chord": (np.full(6, 0.04), np.array([0.20, 0.15, 0.12, 0.12, 0.12, 0.15])),
    "camber_over_chord": (np.zeros(6), np.full(6, 0.085)),
    # Sweep of the root would only turn the blade.
    "sweep_over_R": (np.append(0.0, np.full(5, -0.15)), np.append(0.0, np.full(5, 0.15))),
}
SLOPES = {
    "chord_over_R": (-1.2, 1.2),
    "beta": (-80.0, 20.0),
    "thickness_over_chord": (-0.6, 0.6),
    "camber_over_chord": (-0.2, 0.2),
    "sweep_over_R": (-0.5, 0.5),
}
MIN_THICKNESS = ([0.15, 0.5, 1.0], [1.5e-3, 1.5e-3, 0.5e-3])  # r/R, m
OBJECTIVES = {"tones": "tones.soft_maximum_db", "total": "total.soft_maximum_db"}  # dB, dBA


def units(name: str) -> str | None:
    """Unit in which `BOUNDS` and `SLOPES` give a distribution."""
    return "deg" if name == "beta" else None


def free_indices(name: str) -> np.ndarray:
    """Indices of a distribution's control points that are free."""
    lower, upper = BOUNDS[name]
    return np.flatnonzero(lower < upper)


def build_problem(
    objective: str, torque_limit: float, noise_limit: float, fidelity: pm.Fidelity | None = None
) -> om.Problem:
    """Blade to soft maxima, with design variables, constraints and one of `OBJECTIVES`.

    Parameters
    ----------
    objective : str
        Name of the one of `OBJECTIVES` that is minimised; the other must not exceed the limit.
    torque_limit, noise_limit : float
        Torque [N m] and level [dB] or [dBA] of the baseline.
    fidelity : Fidelity, optional
        Numbers of panels and harmonics, by default those of the thesis' problem.

    Returns
    -------
    om.Problem
        Problem, set up, at the baseline's chord and twist and sections NACA 4409.
    """
    prob = om.Problem(reports=False)
    model = prob.model
    blade = PropellerGroup(
        propeller=thesis.START,
        observers=pm.arc(thesis.DISTANCE, MICROPHONES),
        fidelity=fidelity or thesis.FIDELITY,
        broadband=True,
        design_distributions=dict.fromkeys(BOUNDS, AT),
        control="values",  # bounds and slopes are of chord and twist themselves
        spline_method="cubic",  # linear in its control points: Akima's kinks would be the blade's
    )
    model.add_subsystem("propeller", blade, promotes=["*"])
    model.set_input_defaults("speed", thesis.SPEED, units="m/s")
    model.set_input_defaults("density", thesis.DENSITY, units="kg/m**3")
    model.set_input_defaults("thrust_required", thesis.THRUST, units="N")
    for name, level in (("tones", "oaspl_db"), ("total", "oaspl_total_dba")):
        soft = NoiseObjectiveComp(shape=len(MICROPHONES), exponent=EXPONENT)
        model.add_subsystem(name, soft, promotes_inputs=[("level_db", level)])
    _add_thickness(model)
    _add_slopes(model)

    # SLSQP starts with the unit matrix for the curvature, so scaling is its first step: variables
    # go from 0 to 1 between their bounds, where the levels change by some ten dB. With an
    # objective in tens of dB the first step crosses a part of the box and not all of it.
    for name, (lower, upper) in BOUNDS.items():
        free = free_indices(name)
        model.add_design_var(
            f"{name}_cp", indices=free, units=units(name),
            lower=lower[free], upper=upper[free], ref0=lower[free], ref=upper[free],
        )  # fmt: skip
    for name, output in OBJECTIVES.items():
        if name == objective:
            model.add_objective(output, ref=10.0)
        else:
            model.add_constraint(output, upper=noise_limit, ref=10.0)
    model.add_constraint("torque", upper=torque_limit, ref=torque_limit)
    model.add_constraint("section_thickness", lower=min_thickness(), units="m", ref=1e-3)
    for name, (low, high) in SLOPES.items():
        # Linear: their derivatives are computed once.
        model.add_constraint(
            f"{name}_slope.slope", lower=low, upper=high, ref=high - low, units=units(name),
            linear=True,
        )  # fmt: skip
    # Backward, so that no more than three responses pass through the physics; the thickness of the
    # sections depends on the splines alone. Forward would be once for each variable.
    prob.setup(mode="rev")
    return prob


def min_thickness() -> np.ndarray:
    """Least thickness of the sections at the propeller's stations, (n_stations,) [m]."""
    return np.interp(BASELINE.r_over_R, *MIN_THICKNESS)


def _add_thickness(model: om.Group) -> None:
    """Add the thickness of the sections in metres, from the splines' values at the stations."""
    n = len(BASELINE.r_over_R)
    thickness = om.ExecComp(
        "section_thickness = radius * chord * ratio",
        section_thickness={"shape": n, "units": "m"},
        radius={"val": 0.5 * BASELINE.diameter, "units": "m"},
        chord={"shape": n},
        ratio={"shape": n},
    )
    model.add_subsystem("strength", thickness, promotes_outputs=["section_thickness"])
    for name, source in (("chord", "chord_over_R"), ("ratio", "thickness_over_chord")):
        model.promotes("strength", inputs=[(name, source)], src_indices=om.slicer[0, :])


def _add_slopes(model: om.Group) -> None:
    """Add the slopes of the distributions between control points."""
    n = AT.size - 1
    for name in SLOPES:
        meta = {"shape": n, "units": "rad" if name == "beta" else None}
        slope = om.ExecComp("slope = (after - before) / apart", slope=meta, after=meta, before=meta,
                            apart={"val": np.diff(AT)})  # fmt: skip
        model.add_subsystem(f"{name}_slope", slope)
        for side, first in (("before", 0), ("after", 1)):
            model.promotes(
                f"{name}_slope", inputs=[(side, f"{name}_cp")],
                src_indices=np.arange(first, first + n), src_shape=(AT.size,),
            )  # fmt: skip


def write_blade(prob: om.Problem, name: str, folder: Path) -> pm.Propeller:
    """Make the blade of a design and write it as a file for `propmdao analyze`."""
    values = {n: prob.get_val(n, units=units(n)).ravel() for n in BOUNDS}
    return with_naca_sections(
        BASELINE, name, BASELINE.r_over_R.tolist(), values["camber_over_chord"],
        values["thickness_over_chord"], folder, c_over_R=values["chord_over_R"],
        beta_deg=values["beta"], sweep_over_R=values["sweep_over_R"],
        source="free-form blade of a design study",
    )  # fmt: skip

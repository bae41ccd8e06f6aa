"""A described propeller as a design problem: objective, free distributions and limits in words."""

from __future__ import annotations

import dataclasses
import os
import warnings
from collections.abc import Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt
import openmdao.api as om

from propmdao.components.designs.added_outputs import (
    add_response,
    add_thickness,
    is_tilted,
    output_name,
)
from propmdao.components.designs.span_constraints import LinearComp, chord_factors
from propmdao.components.geometry_comp import blade_distributions
from propmdao.components.propeller_group import PropellerGroup
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller
from propmdao.propeller.design_choices import (
    BASELINE,
    FREE,
    N_CONTROL,
    OBJECTIVES,
    RESPONSES,
    THICKNESS,
    Response,
    control_radii,
)
from propmdao.records.states import OperatingPoint

Floats = npt.NDArray[np.float64]
Ranges = dict[str, tuple[float, float]]

_DB = 10.0  # of an objective or a limit that is a level, for the first step of SLSQP
_LEAST_FACTOR = 0.5  # times the lowest chord factor: the chord between control points


def design_problem(
    propeller: Propeller | str | os.PathLike[str],
    points: OperatingPoint | Sequence[OperatingPoint],
    observers: npt.ArrayLike | None = None,
    *,
    free: Sequence[str] | Mapping[str, tuple[float, float]] = ("chord", "twist"),
    minimise: str = "dba",
    limits: Mapping[str, float | str] | None = None,
    n_control: int = 5,
    **options: Any,
) -> om.Problem:
    """Set up the design problem of a propeller, ready for a driver.

    The thrust of every operating point is met in every design, by the rotation speed. Design
    variables are changes of the described distributions at `n_control` radii, evenly from the first
    station to the tip, with cubic splines through them; the described blade is the start.

    Parameters
    ----------
    propeller : Propeller, str or path
        The described propeller, a name of the catalogue or a propeller file.
    points : OperatingPoint or sequence of OperatingPoint
        Operating points at a thrust; they share the blade. With an incidence at any of them all
        are solved around the turn, hover as well, which takes some hundred times as long; torque
        and power are means over the turn then.
    observers : (n, 3) array, optional
        Positions of those who hear the noise that is minimised or limited [m].
    free : sequence of str, or mapping of str to (float, float)
        Words of `propmdao.propeller.design_choices.FREE`, with ranges of their own or without.
    minimise : str
        Word of `propmdao.propeller.design_choices.OBJECTIVES`. A level is that of the mean square
        over observers and operating points, torque and power are means over the operating points.
    limits : mapping of str to float or "baseline", optional
        Upper limits by the words of `propmdao.propeller.design_choices.RESPONSES`, "baseline" for
        what the described blade has, and "thickness": least thickness of the sections [m], or what
        the described blade has where that is less.
    n_control : int
        Number of control points of each distribution.
    **options
        Further options of `PropellerGroup`: blade_element, fidelity, n_crit, trip and so on.

    Returns
    -------
    om.Problem
        Problem after ``setup``. The model's outputs are those of `PropellerGroup` and, where they
        are minimised or limited, ``mean_dba``, ``mean_db``, ``mean_tones``, ``tip_mach``,
        ``section_thickness``.

    Raises
    ------
    ValueError
        If a word is unknown, a number out of range, something does not go together, or the
        described blade cannot be analysed; in one line.
    """
    if not isinstance(propeller, Propeller):
        propeller = load_propeller(propeller)
    points = (points,) if isinstance(points, OperatingPoint) else tuple(points)
    limits = dict(limits or {})
    n_observers = 0 if observers is None else len(np.asarray(observers))
    ranges = require_words(points, free, minimise, limits, n_control, n_observers)
    responses = {word: RESPONSES[word] for word in (minimise, *limits) if word in RESPONSES}
    noisy = any(response.is_noise for response in responses.values())
    radii = control_radii(propeller.r_over_R[0], n_control)
    group = PropellerGroup(
        propeller=propeller,
        num_nodes=None if len(points) == 1 else len(points),
        observers=observers if noisy else None,
        tilted=is_tilted(points),
        broadband=any(response.has_broadband for response in responses.values()),
        design_distributions={FREE[word].distribution: radii for word in ranges},
        spline_method="cubic",
        **options,
    )
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("propeller", group, promotes=["*"])
    for word in responses:
        add_response(prob.model, word, points, n_observers, propeller)
    # Tones, polars and the Mach number of the tip take the speed of sound in.
    takes_sound_speed = noisy or options.get("viscous", True) or "tip-mach" in responses
    _set_points(prob.model, points, bool(takes_sound_speed))
    described = blade_distributions(propeller, "camber_over_chord")
    for word, range_ in ranges.items():
        _add_variable(prob.model, word, range_, radii, propeller, described)
    if "thickness" in limits:
        add_thickness(prob.model, float(limits.pop("thickness")), propeller, described)
        for word in {"chord", "thickness"} - ranges.keys():
            name = FREE[word].distribution
            prob.model.set_input_defaults(name, np.asarray(described[name], float))
    _finish(prob, minimise, limits, len(points))
    return prob


def designed_blade(prob: om.Problem, name: str) -> Propeller:
    """Blade of a design problem as its variables are now.

    Parameters
    ----------
    prob : om.Problem
        Problem of `design_problem` that has run.
    name : str
        Name of the new propeller.

    Returns
    -------
    Propeller
        The described propeller with the distributions that were free.
    """
    group = prob.model.propeller
    propeller: Propeller = group.options["propeller"]
    attributes = {"chord_over_R": "c_over_R", "beta": "beta_deg"}
    changed: dict[str, Any] = {}
    for distribution in group.options["design_distributions"]:
        units = "deg" if distribution == "beta" else None
        values = np.array(prob.get_val(distribution, units=units)).ravel()
        changed[attributes.get(distribution, distribution)] = values
    source = f"designed from {propeller.name}"
    if propeller.source:
        source += f" ({propeller.source})"
    return dataclasses.replace(propeller, name=name, source=source, **changed)


def require_words(
    points: Sequence[OperatingPoint],
    free: Sequence[str] | Mapping[str, tuple[float, float]],
    minimise: str,
    limits: Mapping[str, float | str],
    n_control: int,
    n_observers: int,
) -> Ranges:
    """Refuse a design problem that is none, before the work.

    Parameters
    ----------
    points, free, minimise, limits, n_control
        The same as those of `design_problem`.
    n_observers : int
        Number of observers.

    Returns
    -------
    dict of str to (float, float)
        Range of what is free, by word.

    Raises
    ------
    ValueError
        If a word is unknown, a number out of range, or something does not go together.
    """
    if not points:
        raise ValueError("a design problem needs an operating point")
    for point in points:
        if point.thrust is None:
            raise ValueError("the operating points of a design are at a thrust, not at an rpm")
    ranges = {}
    for word in free:
        _require_known("free", word, FREE)
        low, high = free[word] if isinstance(free, Mapping) else FREE[word].default
        for end in (low, high):
            FREE[word].allowed.require(f"end of the range of {word}", end)
        described = 1.0 if word == "chord" else 0.0
        if not low <= described <= high or low == high:
            raise ValueError(
                f"the range of {word} must include the described blade, {described:g}; it is"
                f" {low:g} ... {high:g}"
            )
        ranges[word] = (float(low), float(high))
    if not ranges:
        raise ValueError(f"nothing is free; there are {', '.join(FREE)}")
    _require_known("minimise", minimise, OBJECTIVES)
    for word, limit in limits.items():
        _require_known("limit", word, (*RESPONSES, "thickness"))
        if word == minimise:
            raise ValueError(f"{word} is minimised: a limit on it says nothing")
        if word == "thickness":
            THICKNESS.require("least thickness", limit)
            if not ranges.keys() & {"chord", "thickness"}:
                raise ValueError("least thickness is a limit on a free chord or thickness")
        elif limit != BASELINE:
            RESPONSES[word].allowed.require(f"limit of {word}", limit)
    for word in (minimise, *limits):
        if word in RESPONSES and RESPONSES[word].is_noise and not n_observers:
            raise ValueError(f"{word} is heard by observers: there are none")
    N_CONTROL.require("number of control points", n_control)
    return ranges


def _require_known(kind: str, word: str, known: Iterable[str]) -> None:
    if word not in known:
        raise ValueError(f"{kind}: there is no '{word}'; there are {', '.join(known)}")


def _set_points(model: om.Group, points: Sequence[OperatingPoint], has_sound_speed: bool) -> None:
    """Operating points as the inputs of the model."""
    values = {
        "speed": ([point.speed for point in points], "m/s"),
        "density": ([point.air.density for point in points], "kg/m**3"),
        "thrust_required": ([point.thrust for point in points], "N"),
    }
    if is_tilted(points):
        values["incidence"] = ([point.incidence_deg for point in points], "deg")
    if has_sound_speed:
        values["sound_speed"] = ([point.air.sound_speed for point in points], "m/s")
    for name, (numbers, units) in values.items():
        model.set_input_defaults(name, np.array(numbers, float), units=units)


def _add_variable(
    model: om.Group,
    word: str,
    range_: tuple[float, float],
    radii: Floats,
    propeller: Propeller,
    described: Mapping[str, Floats],
) -> None:
    """Add the design variables of a distribution, and what holds it between control points."""
    free = FREE[word]
    name, stations = free.distribution, propeller.r_over_R
    here = np.interp(radii, stations, np.asarray(described[name], float))
    lower, upper = free.ends(range_, here)
    if word == "sweep":
        lower[0] = upper[0] = 0.0  # at the root it would only turn the blade
    indices = np.flatnonzero(lower < upper)
    lower, upper = lower[indices], upper[indices]
    # From 0 to 1 between the bounds: SLSQP begins with a unit matrix for the curvature.
    model.add_design_var(
        f"{name}_cp", indices=indices, units=free.unit or None, lower=lower, upper=upper,
        ref0=lower, ref=upper,
    )  # fmt: skip
    if word == "chord":
        factors = LinearComp(matrix=chord_factors(stations, described[name]))
        model.add_subsystem(
            "chord_between",
            factors,
            promotes_inputs=[("distribution", name)],
            promotes_outputs=[("values", "chord_factor")],
        )
        model.add_constraint("chord_factor", lower=_LEAST_FACTOR * range_[0], linear=True)
    elif free.within is not None:
        lowest, highest = free.within
        values = np.asarray(described[name], float)
        model.add_constraint(
            name, lower=np.minimum(lowest, values), upper=np.maximum(highest, values),
            ref=highest - lowest, linear=True,
        )  # fmt: skip


def _finish(
    prob: om.Problem, minimise: str, limits: Mapping[str, float | str], n_points: int
) -> None:
    """Analyse the described blade, whose values are limits and scales, and set up with them."""
    # Backward: few responses and many variables. The thickness of the sections is many numbers, but
    # they depend on the splines alone and cost nothing.
    prob.setup(mode="rev")
    try:
        with warnings.catch_warnings():
            warnings.filterwarnings("ignore", category=om.DerivativesWarning)
            prob.run_model()
    except om.AnalysisError as error:
        raise ValueError(f"the described blade cannot be analysed: {error}") from error

    def scale(response: Response, value: Floats) -> float:
        return _DB if response.is_noise else float(np.abs(value).max())

    for word, limit in limits.items():
        # A limit holds at each operating point, not in the mean.
        response, name = RESPONSES[word], output_name(word, 1)
        value = np.array(prob.get_val(name, units=response.unit or None))
        upper = value if limit == BASELINE else np.full(value.shape, float(limit))
        prob.model.add_constraint(
            name, upper=upper, units=response.unit or None, ref=scale(response, upper)
        )
    name, response = output_name(minimise, n_points), RESPONSES[minimise]
    value = np.array(prob.get_val(name, units=response.unit or None))
    prob.model.add_objective(name, units=response.unit or None, ref=scale(response, value))
    prob.setup(mode="rev")

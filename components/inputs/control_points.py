"""Control points of the blade's distributions: increments on the described blade, or its values."""

from __future__ import annotations

import warnings
from collections.abc import Mapping
from typing import Any

import numpy as np
import numpy.typing as npt
import openmdao.api as om
from openmdao.components.interp_util.interp import InterpND
from openmdao.utils.options_dictionary import OptionsDictionary

Floats = npt.NDArray[np.float64]

SPLINE_METHODS = ("slinear", "akima", "cubic")
CONTROLS = ("increments", "values")
#: Distribution whose increments are factors: it must stay positive.
_FACTORS = "chord_over_R"
_ROUNDING = 1.0e-6  # of the largest value of a distribution, a deviation that is none


def declare_control_points(options: OptionsDictionary) -> None:
    """Declare which distributions have control points, and what these mean.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a group.
    """
    options.declare("design_distributions", {}, types=dict, desc="r/R of control points by name")
    options.declare(
        "control", CONTROLS[0], values=CONTROLS, desc="what control points give of a distribution"
    )
    options.declare(
        "spline_method", SPLINE_METHODS[0], values=SPLINE_METHODS, desc="curve through them"
    )


def add_control_points(
    group: om.Group, stations: Floats, described: Mapping[str, Floats]
) -> tuple[str, ...]:
    """Add splines that give the design distributions, under their names, from control points.

    Parameters
    ----------
    group : om.Group
        Group in its ``setup``, with the options of `declare_control_points`.
    stations : (n_stations,) array
        r/R of the propeller's stations.
    described : mapping of str to (n_stations,) array
        All distributions of the described propeller by name.

    Returns
    -------
    tuple of str
        Names of the distributions whose outputs have OpenMDAO's leading axis of splines, of one.

    Raises
    ------
    ValueError
        If a distribution is unknown, or control points do not rise from first station to tip.
    """
    method = group.options["spline_method"]
    points = {
        name: _points(name, radii, described, stations)
        for name, radii in group.options["design_distributions"].items()
    }
    if group.options["control"] == "increments":
        for name, r in points.items():
            _add_increments(group, name, r, stations, described[name])
        return ()
    starts = {name: np.interp(r, stations, described[name]) for name, r in points.items()}
    _warn_of_deviations(points, starts, method, stations, described)
    for name, r in points.items():
        _add_spline(group, name, r, starts[name], stations)
        group.promotes(f"{name}_spline", outputs=[("spline", name)])
    return tuple(points)


def _units(name: str) -> str | None:
    return "rad" if name == "beta" else None


def _add_spline(
    group: om.Group, name: str, points: Floats, start: Floats, stations: Floats
) -> None:
    """Spline from ``name_cp`` to the output "spline", with the leading axis of one."""
    units = _units(name)
    spline = om.SplineComp(
        method=group.options["spline_method"], x_cp_val=points, x_interp_val=stations
    )
    spline.add_spline("cp", "spline", y_cp_val=start, y_units=units)
    group.add_subsystem(f"{name}_spline", spline)
    group.promotes(
        f"{name}_spline",
        inputs=[("cp", f"{name}_cp")],
        src_indices=np.arange(points.size),
        flat_src_indices=True,
        src_shape=(points.size,),
    )
    group.set_input_defaults(f"{name}_cp", val=start, units=units)


def _add_increments(
    group: om.Group, name: str, points: Floats, stations: Floats, described: Floats
) -> None:
    """Described distribution plus what the spline gives; times it for the chord."""
    is_factor = name == _FACTORS
    start = np.full(points.size, 1.0 if is_factor else 0.0)
    _add_spline(group, name, points, start, stations)
    units, operation = _units(name), "*" if is_factor else "+"
    total = om.ExecComp(
        f"{name} = described {operation} spline",
        has_diag_partials=True,
        described={"val": described, "constant": True},
        spline={"shape": described.shape, "units": units},
        **{name: {"val": described, "units": units}},
    )
    group.add_subsystem(f"{name}_described", total, promotes_outputs=[name])
    group.connect(f"{name}_spline.spline", f"{name}_described.spline", src_indices=om.slicer[0, :])


def _warn_of_deviations(
    points: Mapping[str, Floats],
    starts: Mapping[str, Floats],
    method: str,
    stations: Floats,
    described: Mapping[str, Floats],
) -> None:
    """Say once how far the blade of the control points is from the described one."""
    deviations = []
    for name, r in points.items():
        spline = InterpND(method=method, points=r, x_interp=stations)
        deviation = spline.evaluate_spline(starts[name]).ravel() - described[name]
        worst = int(np.argmax(np.abs(deviation)))
        if abs(deviation[worst]) > _ROUNDING * np.abs(described[name]).max():
            factor, unit = (np.degrees(1.0), " deg") if name == "beta" else (1.0, "")
            deviations.append(
                f"{name} by {factor * deviation[worst]:+.3g}{unit} at r/R {stations[worst]:.2f},"
                f" where it is {factor * described[name][worst]:.3g}{unit}"
            )
    if deviations:
        warnings.warn(
            f"{method} curves through control points change the described blade:"
            f' {"; ".join(deviations)}. With control="increments" they start from it',
            stacklevel=2,
        )


def _points(
    name: str, control_points: Any, known: Mapping[str, object], stations: Floats
) -> Floats:
    if name not in known:
        raise ValueError(
            f"design_distributions: unknown distribution '{name}'; there are {', '.join(known)}"
        )
    points = np.asarray(control_points, dtype=float)
    if points.ndim != 1 or points.size < 2 or not np.all(np.diff(points) > 0.0):
        raise ValueError(
            f"design_distributions: control points of {name} must be at least two rising r/R; "
            f"they are {points.tolist()}"
        )
    if points[0] > stations[0] or points[-1] < stations[-1]:
        raise ValueError(
            f"design_distributions: control points of {name} must reach from "
            f"{stations[0]:g} to {stations[-1]:g} r/R; they reach from {points[0]:g} to "
            f"{points[-1]:g}"
        )
    return points

"""Figures of rotors for pages: the blade in space, its shape, its loads."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.lattice.rings import turned
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.analysis.results import Analysis
from propmdao.figures.contents.disk_loads import loads_over_disk
from propmdao.figures.contents.distributions import blade_distributions, span_values
from propmdao.figures.contents.palette import BLADE_COLORS, line_styles
from propmdao.figures.pages.diagrams import (
    diagram,
    filled_map,
    line,
    numbers,
)
from propmdao.figures.pages.parts import Figure, Panel
from propmdao.geometry.meshes import propeller_surface
from propmdao.propeller.description import Propeller

_N_CONTOUR, _N_SPAN = 33, 26
_ALONE = "#0072B2"  # colour of a line that is compared with none


def in_space(propellers: Mapping[str, Propeller]) -> Figure:
    """Draw propellers in space, to be turned around.

    Parameters
    ----------
    propellers : mapping of str to Propeller
        Propellers by name.

    Returns
    -------
    Figure
        A diagram for each, in millimetres.
    """
    panels = [_space(name, propeller) for name, propeller in propellers.items()]
    return Figure(
        "Blades in space",
        "The propeller in its axes: z along the shaft toward thrust, blade 1 along x; it turns from"
        " x to y",
        {"all": panels},
        note="z is the shaft, in the direction of thrust; blade 1 lies along x, and the rotor turns"
        " from x to y.",
    )


def _space(name: str, propeller: Propeller) -> Panel:
    points = 1e3 * np.asarray(propeller_surface(propeller, _N_CONTOUR, _N_SPAN))
    n_blades = int(propeller.n_blades)
    azimuths = 2.0 * np.pi * np.arange(n_blades) / n_blades
    blades = np.asarray(turned(jnp.reshape(points, (-1, 3)), azimuths)).reshape(
        n_blades, *points.shape
    )
    data = [
        {
            "type": "surface",
            "name": f"blade {number}",
            **{axis: np.round(blade[..., k], 2).tolist() for k, axis in enumerate("xyz")},
            # One colour each, lit so that the shape shows.
            "surfacecolor": np.zeros(points.shape[:2], int).tolist(),
            "colorscale": [[0, color], [1, color]],
            "showscale": False,
            "lighting": {"ambient": 0.45, "diffuse": 0.6, "specular": 0.1, "roughness": 0.7},
            # As the eye sees it, from above and behind the eye.
            "lightposition": {"x": -2e3, "y": 1e4, "z": -5e3},
            "hovertemplate": "x %{x:.1f}, y %{y:.1f}, z %{z:.1f} mm<extra>blade "
            f"{number}</extra>",
        }
        for number, blade in enumerate(blades, start=1)
        for color in ["#E69F00" if number == 1 else "#56B4E9"]
    ]
    low, high = blades.min(axis=(0, 1, 2)), blades.max(axis=(0, 1, 2))
    # One scale along all axes; a cube of Plotly's has the size 1.
    ratio = 1.6 * (high - low) / (high - low).max()
    plain = {"backgroundcolor": "white", "gridcolor": "#dddddd", "showspikes": False}
    axes: dict[str, Any] = {
        f"{name}axis": plain
        | {
            "title": {"text": f"{name}, mm"},
            "range": [float(low[k]), float(high[k])],
            "nticks": 3 if ratio[k] < 0.5 else 6,
        }
        for k, name in enumerate("xyz")
    }
    scene = axes | {
        "aspectmode": "manual",
        "aspectratio": {name: float(ratio[k]) for k, name in enumerate("xyz")},
        "camera": {
            "eye": {"x": 0.6, "y": -1.1, "z": 0.9},
            "up": {"x": 0, "y": 0, "z": 1},
            "projection": {"type": "orthographic"},
        },
    }
    layout = {"scene": scene, "margin": {"l": 0, "r": 0, "t": 0, "b": 0}, "paper_bgcolor": "white"}
    described = f"{name}, {n_blades} blades, {1e3 * propeller.diameter:.4g} mm"
    return Panel(described, data, layout)


def shapes(propellers: Mapping[str, Propeller]) -> Figure:
    """Draw distributions over span, one propeller over the other.

    Parameters
    ----------
    propellers : mapping of str to Propeller
        Propellers by name, up to four.

    Returns
    -------
    Figure
        Chord, blade angle, thickness, camber, planform.
    """
    curves = {name: blade_distributions(blade) for name, blade in propellers.items()}
    styles = _styles(propellers)
    panels = []
    for label in next(iter(curves.values())):
        data = [line(*curves[name][label], name, **styles[name]) for name in propellers]
        planform = label.startswith("planform")
        scale = {"scaleanchor": "x"} if planform else {"rangemode": "tozero"}
        panels.append(diagram(label, data, ("r/R", ""), y=scale))
    return Figure(
        "Shape over span",
        f"Chord, blade angle, thickness, camber and planform of {' and '.join(propellers)} from"
        " root to tip",
        {"all": panels},
    )


def span_loads(analyses: Mapping[str, Analysis]) -> Figure:
    """Draw loads over span, one propeller over the other.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses of rotors that turn, by the name of the propeller, up to four.

    Returns
    -------
    Figure
        Lift, angle of attack, drag, Reynolds number, circulation, thrust; means over the turn with
        the range over it where they are not the same all around.
    """
    values = {name: span_values(analysis) for name, analysis in analyses.items()}
    radii = {n: np.asarray(analysis.loads.strips.r_over_R) for n, analysis in analyses.items()}
    styles = _styles(analyses)
    panels = []
    for label in next(iter(values.values())):
        data: list[dict[str, Any]] = []
        for name in analyses:
            over_turn, r, style = values[name][label], radii[name], styles[name]
            if len(over_turn) > 1:
                data += _range_of(r, over_turn, style["color"])
            data.append(line(r, over_turn.mean(axis=0), name, **style))
        panels.append(diagram(label, data, ("r/R", "")))
    tilted = any(isinstance(analysis.loads, TiltedLoads) for analysis in analyses.values())
    return Figure(
        "Loads over span",
        "Lift coefficient, angle of attack, drag coefficient, Reynolds number, circulation and"
        " thrust of the blade from root to tip",
        {"all": panels},
        note="Means over the turn; the bands are their range over it." if tilted else "",
    )


def _range_of(r: np.ndarray, over_turn: np.ndarray, color: str) -> list[dict[str, Any]]:
    """Band between the lowest and the highest value of a turn."""
    edge = {"type": "scatter", "mode": "lines", "x": numbers(r), "line": {"width": 0},
            "hoverinfo": "skip", "showlegend": False, "meta": {"hidden": True}}  # fmt: skip
    filled = "rgba({},{},{},0.2)".format(*(int(color[k : k + 2], 16) for k in (1, 3, 5)))
    return [
        edge | {"y": numbers(over_turn.min(axis=0))},
        edge | {"y": numbers(over_turn.max(axis=0)), "fill": "tonexty", "fillcolor": filled},
    ]


def over_turn(analysis: Analysis) -> list[Figure]:
    """Draw what changes around the turn and from turn to turn.

    Parameters
    ----------
    analysis : Analysis
        The analysis.

    Returns
    -------
    list of Figure
        Maps of the disk at an incidence, thrust and torque at every step of a march; none in steady
        flow.
    """
    loads, figures = analysis.loads, []
    if isinstance(loads, TiltedLoads) and analysis.point.incidence_deg:
        r = np.asarray(loads.strips.r_over_R)
        panels = []
        for label, values in loads_over_disk(loads).items():
            azimuth = np.linspace(0.0, 360.0, len(values) + 1)
            closed = np.concatenate([values, values[:1]])
            unit = label.rpartition(", ")[2]
            panels.append(
                filled_map(label, ("azimuth of the blade, deg", "r/R"), azimuth, r, closed.T, unit)
            )
        figures.append(
            Figure(
                "Loads over the disk",
                "Thrust per span and angle of attack of a blade over its azimuth and r/R",
                {"all": panels},
                note="Azimuth 0 is ahead; blades retreat at 90 and advance at 270 degrees.",
            )
        )
    if isinstance(loads, MarchedLoads):
        thrust, torque = np.asarray(loads.thrust_history), np.asarray(loads.torque_history)
        turns = np.arange(thrust.size) / len(loads.blade_force)
        panels = [
            diagram(label, [line(turns, values, color=_ALONE)], ("revolutions", ""))
            for label, values in (("thrust, N", thrust), ("torque, N m", torque))
        ]
        figures.append(
            Figure(
                "History of the march",
                "Thrust and torque of all blades over the revolutions of the march",
                {"all": panels},
            )
        )
    return figures


def _styles(names: Mapping[str, Any]) -> dict[str, dict[str, Any]]:
    """Colour and style of the line of each propeller."""
    if len(names) == 1:
        return {name: {"color": _ALONE} for name in names}
    styles = line_styles(names)
    return {
        name: {"color": color, "style": styles[name]}
        for name, color in zip(names, BLADE_COLORS, strict=False)
    }

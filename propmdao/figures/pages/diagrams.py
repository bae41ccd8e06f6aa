"""Diagrams as Plotly draws them: traces, axes, text that is only text."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import numpy.typing as npt

from propmdao.figures.contents.palette import Floats, line_colors, line_styles
from propmdao.figures.pages.parts import Panel

_DASHES = {"-": "solid", "--": "dash", "-.": "dashdot", ":": "dot"}
_SYMBOLS = {"o": "circle", "s": "square", "D": "diamond", "^": "triangle-up", "v": "triangle-down",
            "<": "triangle-left", ">": "triangle-right"}  # fmt: skip
_GRID = "#e2e2e2"
# Fills from light to dark, which colour-blind people and grey prints tell apart, and none so dark
# that black levels on its lines could not be read.
_FILLS = [[0.0, "#f7fcf0"], [0.33, "#ccebc5"], [0.67, "#7bccc4"], [1.0, "#3a97c9"]]


def text(words: str) -> str:
    """Words for a diagram, in which Plotly would take a tag for markup and an entity for a sign.

    Parameters
    ----------
    words : str
        Name that a user or a file gave.

    Returns
    -------
    str
        The words as Plotly has to be told them.
    """
    return words.replace("&", "&amp;").replace("<", "&lt;").replace(">", "&gt;")


def numbers(values: npt.ArrayLike) -> list[Any]:
    """Numbers with six digits, as lists; what is none leaves a gap.

    Parameters
    ----------
    values : array_like
        Numbers, nan where there is none.

    Returns
    -------
    list
        Nested lists of the shape of the values.
    """
    known = np.asarray(values, float)
    if known.ndim > 1:
        return [numbers(row) for row in known]
    return [float(f"{value:.6g}") + 0.0 if np.isfinite(value) else None for value in known]


def line(x: npt.ArrayLike, y: npt.ArrayLike, name: str = "", **settings: Any) -> dict[str, Any]:
    """Make a line.

    Parameters
    ----------
    x, y : (n,) array_like
        Points.
    name : str
        Name.
    **settings
        color, style of `palette.LINE_STYLES`, width, marker of `palette.MARKERS`.

    Returns
    -------
    dict
        Trace.
    """
    drawn = {
        "type": "scatter",
        "mode": "lines+markers" if "marker" in settings else "lines",
        "name": text(name),
        "x": numbers(x),
        "y": numbers(y),
        "line": {
            "color": settings["color"],
            "dash": _DASHES[settings.get("style", "-")],
            "width": settings.get("width", 2.0),
        },
    }
    if "marker" in settings:
        drawn["marker"] = {"symbol": _SYMBOLS[settings["marker"]], "size": 6}
    return drawn


def lines_of(
    x: npt.ArrayLike, values: Mapping[str, npt.ArrayLike], **settings: Any
) -> list[dict[str, Any]]:
    """Make lines with the colours and styles that their names have in every figure.

    Parameters
    ----------
    x : (n,) array_like
        Common abscissa.
    values : mapping of str to (n,) array_like
        Values by name.
    **settings
        Settings of `line` that all have.

    Returns
    -------
    list of dict
        Traces; the total is broad, and below the others.
    """
    colors, styles = line_colors(values), line_styles(values)
    drawn = [
        line(x, y, name, color=colors[name], style=styles[name],
             width=4.0 if name == "total" else 2.0, **settings)
        for name, y in values.items()
    ]  # fmt: skip
    return sorted(drawn, key=lambda trace: trace["name"] != "total")


def diagram(
    label: str,
    data: Sequence[dict[str, Any]],
    axes: tuple[str, str],
    x: Mapping[str, Any] | None = None,
    y: Mapping[str, Any] | None = None,
) -> Panel:
    """Make a diagram of two axes.

    Parameters
    ----------
    label : str
        Name, which stands above and may take the place of the name of the vertical axis.
    data : sequence of dict
        Traces.
    axes : (str, str)
        Names of the axes with their units; the second may be empty.
    x, y : mapping, optional
        Further settings of the axes.

    Returns
    -------
    Panel
        The diagram.
    """
    return Panel(
        label,
        list(data),
        _layout(axes[0], axes[1] or label)
        | {
            "xaxis": _axis(axes[0]) | dict(x or {}),
            "yaxis": _axis(axes[1]) | dict(y or {}),
        },
    )


def filled_map(
    label: str, axes: tuple[str, str], x: Floats, y: Floats, values: Floats, unit: str = ""
) -> Panel:
    """Make a map of filled contours.

    Parameters
    ----------
    label : str
        Name of the values.
    axes : (str, str)
        Names of the axes with their units.
    x, y : (n_x,), (n_y,) array
        Abscissae.
    values : (n_y, n_x) array
        Values, nan where there is none.
    unit : str
        Unit of the values.

    Returns
    -------
    Panel
        The map.
    """
    trace = {
        "type": "contour",
        "x": numbers(x),
        "y": numbers(y),
        "z": numbers(values),
        "colorscale": _FILLS,
        "contours": {"showlabels": True, "labelfont": {"color": "black"}},
        "colorbar": {"thickness": 14, "title": {"text": text(unit), "side": "right"}},
        "connectgaps": False,
    }
    layout = _layout(*axes, label)
    return Panel(label, [trace], layout | {"xaxis": _axis(axes[0]), "yaxis": _axis(axes[1])})


def half_circle(label: str, data: Sequence[dict[str, Any]], bottom: float, top: float) -> Panel:
    """Make a polar diagram over elevation, from the wake to ahead.

    Parameters
    ----------
    label : str
        Name of the levels with their unit.
    data : sequence of dict
        Traces of `over_elevation`.
    bottom, top : float
        Levels at the centre and at the rim [dB].

    Returns
    -------
    Panel
        The diagram.
    """
    named = {-90: "-90° wake", 0: "0° plane", 90: "+90° ahead"}
    ticks = [-90, -60, -30, 0, 30, 60, 90]
    polar = {
        "sector": [-90, 90],
        "angularaxis": {
            "tickmode": "array",
            "tickvals": ticks,
            "ticktext": [named.get(tick, f"{tick:+d}°") for tick in ticks],
            "gridcolor": _GRID,
        },
        "radialaxis": {
            "range": [bottom, top],
            "gridcolor": _GRID,
            "dtick": 10,
            "angle": 90,
            "tickangle": 0,
            "side": "counterclockwise",
        },
        "bgcolor": "white",
    }  # fmt: skip
    layout = _layout("elevation, deg", label) | {
        "polar": polar,
        "margin": {"l": 70, "r": 70, "t": 30, "b": 30},
    }
    return Panel(label, list(data), layout)


def over_elevation(
    elevation_deg: npt.ArrayLike, values: Mapping[str, npt.ArrayLike], bottom: float
) -> list[dict[str, Any]]:
    """Make lines of a polar diagram.

    Parameters
    ----------
    elevation_deg : (n,) array_like
        Elevations [deg].
    values : mapping of str to (n,) array_like
        Levels by name [dB].
    bottom : float
        Level at the centre, below which nothing is drawn [dB].

    Returns
    -------
    list of dict
        Traces.
    """
    traces = []
    for trace in lines_of(elevation_deg, {n: np.maximum(v, bottom) for n, v in values.items()}):
        theta, r = trace.pop("x"), trace.pop("y")
        traces.append(trace | {"type": "scatterpolar", "theta": theta, "r": r})
    return traces


def _layout(*columns: str) -> dict[str, Any]:
    """Layout of every diagram; the columns are heads of the table of its numbers."""
    return {
        "template": "none",
        "font": {"family": "system-ui, sans-serif", "size": 13, "color": "#1a1a1a"},
        "margin": {"l": 60, "r": 15, "t": 10, "b": 45},
        "paper_bgcolor": "white",
        "plot_bgcolor": "white",
        "showlegend": False,  # the page has its own, which keys reach
        "hovermode": "closest",
        "meta": {"columns": list(columns)},
    }


def _axis(name: str) -> dict[str, Any]:
    return {
        "title": {"text": text(name), "standoff": 8, "font": {"size": 13}},
        "exponentformat": "e",
        "automargin": True,
        "gridcolor": _GRID,
        "linecolor": "#777777",
        "zeroline": False,
        "ticks": "outside",
        "tickcolor": "#777777",
    }

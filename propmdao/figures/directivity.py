"""Figures of where the noise goes: polar diagrams over elevation, maps of a hemisphere."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, NamedTuple, cast

import numpy as np
import numpy.typing as npt

from propmdao.figures.style import (
    LEVEL,
    LINE_STYLES,
    Floats,
    Measured,
    half_circle,
    line_colors,
    page,
)

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

#: Levels in dB by name, or by name and then by noise source.
Levels = Mapping[str, npt.ArrayLike | Mapping[str, npt.ArrayLike]]


class _Line(NamedTuple):
    label: str
    color: str
    style: str
    level: Floats


def directivity(
    elevation_deg: npt.ArrayLike,
    levels: Levels,
    measured: Measured | None = None,
    label: str = "OASPL",
    microphone_deg: float | None = None,
) -> Figure:
    """Levels on an arc from below the rotor to above it, as a polar diagram.

    Parameters
    ----------
    elevation_deg : (n,) array
        Elevation from the rotor plane, rising, negative on the wake's side [deg].
    levels : mapping of str to (n,) array or to mapping of str to (n,) array
        Levels by name [dB], such as `sound.source_levels` gives for one sound. Where sounds are
        compared: levels by the name of the sound, a line style each, and then by noise source.
    measured : mapping of str to (elevation_deg, levels), optional
        Measured levels by the same names: dots.
    label : str
        Name of the level.
    microphone_deg : float, optional
        Elevation to mark, that of the microphone of a study [deg].

    Returns
    -------
    Figure
        The figure; levels more than 40 dB below the loudest lie at its centre.
    """
    measured = measured or {}
    lines = _lines(levels)
    drawn = [*(line.level for line in lines), *(known for _, known in measured.values())]
    loudest = max(float(np.max(level)) for level in drawn)
    figure, axes = half_circle(loudest, f"{label}, {LEVEL}")
    floor, top = axes.get_ylim()
    angle = np.radians(np.asarray(elevation_deg, float))
    for line in lines:
        axes.plot(
            angle, np.maximum(line.level, floor), color=line.color, linestyle=line.style,
            linewidth=2.0, label=line.label,
        )  # fmt: skip
        if line.label in measured:
            elevation, known = (np.asarray(values, float) for values in measured[line.label])
            axes.plot(
                np.radians(elevation), known, "o", color=line.color, label=f"{line.label}, measured"
            )
    if microphone_deg is not None:
        axes.plot(
            np.radians([microphone_deg] * 2), [floor, top], color="#CC79A7", label="microphone",
            linewidth=2.0, zorder=1.5,
        )  # fmt: skip
    figure.legend(loc="center left", bbox_to_anchor=(0.55, 0.85))
    return figure


def _lines(levels: Levels) -> list[_Line]:
    """Lines of a polar diagram: colours by source, styles by the sound that they belong to."""
    single = {name: level for name, level in levels.items() if not isinstance(level, Mapping)}
    compared = {name: level for name, level in levels.items() if isinstance(level, Mapping)}
    colors = line_colors(single)
    lines = [
        _Line(name, colors[name], "-", np.asarray(level, float)) for name, level in single.items()
    ]
    for i, (name, sources) in enumerate(compared.items()):
        colors, style = line_colors(sources), LINE_STYLES[i % len(LINE_STYLES)]
        lines += [
            _Line(f"{name}, {source}", colors[source], style, np.asarray(level, float))
            for source, level in sources.items()
        ]
    return lines


def hemisphere_map(
    elevation_deg: npt.ArrayLike,
    azimuth_deg: npt.ArrayLike,
    level: npt.ArrayLike,
    label: str = f"OASPL, {LEVEL}",
) -> Figure:
    """Map of levels on the hemisphere below, seen from below: straight below in its middle.

    Parameters
    ----------
    elevation_deg : (n_elevations,) array
        Elevations from -90 to 0, rising [deg].
    azimuth_deg : (n_azimuths,) array
        Azimuths from 0 to 360, closed [deg]; 0 is drawn on top.
    level : (n_elevations, n_azimuths) array
        Levels in the order of `observers.sphere` [dB].
    label : str
        Name of the level, with its unit.

    Returns
    -------
    Figure
        The figure, drawn down to 30 dB below the loudest.
    """
    # Constrained layouts leave no room for the names of the directions.
    figure = page(8.5, layout=None)
    axes = cast("PolarAxes", figure.add_axes((0.08, 0.1, 0.7, 0.82), projection="polar"))
    top = np.floor(np.max(level)) + 1.0
    drawn = np.maximum(np.asarray(level, float), top - 30.0)
    steps = np.linspace(np.floor(drawn.min()), top, 25)
    azimuth, elevation = np.radians(np.asarray(azimuth_deg, float)), np.asarray(elevation_deg)
    filled = axes.contourf(azimuth, elevation, drawn, steps, cmap="viridis")
    axes.set(theta_zero_location="N", ylim=(-90.0, 0.0), yticks=[-60.0, -30.0, 0.0])
    # Seen from below, the azimuth about the upward axis turns clockwise.
    axes.set_theta_direction(-1)
    axes.set_yticklabels(["-60°", "-30°", ""], color="white")
    axes.set_rlabel_position(22.5)
    axes.set_xlabel("azimuth around, elevation inward")
    axes.grid(color="white", linewidth=0.5)
    scale = figure.add_axes((0.87, 0.15, 0.03, 0.72))
    figure.colorbar(filled, cax=scale, label=label, format="%.1f")
    return figure

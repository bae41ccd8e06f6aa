"""Figures of where the noise goes: polar diagrams over elevation, maps of a hemisphere.

All are 1200 pixels wide, without a display. Measurements are dots of the colour of
the line that they belong to.
"""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt

from propmdao.figures.acoustic_plots import LEVEL, Measured, colored
from propmdao.figures.style import half_circle, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes


def directivity(
    elevation_deg: npt.ArrayLike,
    levels: Mapping[str, npt.ArrayLike],
    measured: Measured | None = None,
    label: str = "OASPL",
) -> Figure:
    """Levels on an arc from below the rotor to above it, as a polar diagram.

    Parameters
    ----------
    elevation_deg : (n,) array
        From the rotor plane, rising, negative on the wake's side [deg].
    levels : mapping of str to (n,) array
        Levels by name [dB]; `acoustic_plots.source_levels` gives those of the noise sources.
    measured : mapping of str to (elevation_deg, levels), optional
        By the same names: dots.
    label : str
        Which level it is.

    Returns
    -------
    Figure
        The figure; levels more than 40 dB below the loudest lie at its centre.
    """
    measured = measured or {}
    drawn = [*levels.values(), *(known for _, known in measured.values())]
    loudest = max(float(np.max(level)) for level in drawn)
    figure, axes = half_circle(loudest, 22.5, f"{label}, {LEVEL}")
    floor = axes.get_ylim()[0]
    for name, color, level in colored(levels):
        angle = np.radians(np.asarray(elevation_deg, float))
        axes.plot(angle, np.maximum(level, floor), color=color, linewidth=2.0, label=name)
        if name in measured:
            at, known = (np.asarray(q, float) for q in measured[name])
            axes.plot(np.radians(at), known, "o", color=color, label=f"{name}, measured")
    figure.legend(loc="center left", bbox_to_anchor=(0.55, 0.85))
    return figure


def hemisphere_map(
    elevation_deg: npt.ArrayLike,
    azimuth_deg: npt.ArrayLike,
    level: npt.ArrayLike,
    label: str = "OASPL, dB re 20 µPa",
) -> Figure:
    """Map of levels on the hemisphere below, seen from below: straight below in its middle.

    Parameters
    ----------
    elevation_deg : (n_elevations,) array
        From -90 to 0, rising [deg].
    azimuth_deg : (n_azimuths,) array
        From 0 to 360, closed [deg]; 0 is drawn on top.
    level : (n_elevations, n_azimuths) array
        As `observers.sphere` orders them [dB].
    label : str
        What is drawn, with its unit.

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

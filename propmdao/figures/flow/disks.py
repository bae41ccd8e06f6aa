"""Maps of the disk: how loads change around the turn."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, cast

import numpy as np
import numpy.typing as npt

from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.figures.contents.disk_loads import loads_over_disk
from propmdao.figures.contents.palette import Floats
from propmdao.figures.style import literal, page

if TYPE_CHECKING:
    from matplotlib.figure import Figure
    from matplotlib.projections.polar import PolarAxes

# Fills from dark blue to yellow, which colour-blind people and grey prints tell apart.
_COLORS = "viridis"
_N_STEPS = 12


def disk_of_loads(loads: TiltedLoads, title: str = "") -> Figure:
    """Draw thrust and angle of attack of a blade over the disk.

    Parameters
    ----------
    loads : TiltedLoads
        Loads of a turn.
    title : str
        Title.

    Returns
    -------
    Figure
        Thrust per span [N/m] and effective angle of attack [deg] of the blade that stands at each
        azimuth.
    """
    return disk_maps(np.asarray(loads.strips.r_over_R), loads_over_disk(loads), title)


def disk_maps(r_over_R: npt.ArrayLike, maps: Mapping[str, Floats], title: str = "") -> Figure:
    """Draw maps of the disk beside each other, seen from the side to which the thrust points.

    Parameters
    ----------
    r_over_R : (n_radii,) array
        Radii, rising.
    maps : mapping of str to (n_azimuths, n_radii) array
        Values by their name with its unit, at equally spaced azimuths from 0.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure: flight is upward, along azimuth 0, and the rotor turns counter-clockwise.
    """
    width = 10.0 / len(maps)
    figure = page(width + 0.9, layout=None)
    figure.text(0.02, 0.98, literal(title), va="top")
    for number, (name, values) in enumerate(maps.items()):
        left = number / len(maps)
        size = 0.62 / len(maps)
        bottom = 0.24
        square = (left + 0.19 / len(maps), bottom, size, size * 10.0 / (width + 0.9))
        axes = cast("PolarAxes", figure.add_axes(square, projection="polar"))
        _draw(axes, np.asarray(r_over_R, float), values)
        scale = figure.add_axes((left + 0.1 / len(maps), 0.115, 0.8 / len(maps), 0.025))
        figure.colorbar(
            axes.collections[0], cax=scale, label=name, format="%g", orientation="horizontal"
        )
    return figure


def _draw(axes: PolarAxes, r_over_R: Floats, values: Floats) -> None:
    """Draw one map."""
    azimuth = np.linspace(0.0, 2.0 * np.pi, len(values) + 1)
    closed = np.concatenate([values, values[:1]])
    axes.contourf(azimuth, r_over_R, closed.T, _N_STEPS, cmap=_COLORS)
    if closed.min() < 0.0 < closed.max():
        axes.contour(azimuth, r_over_R, closed.T, [0.0], colors="white", linewidths=2.0)
        axes.text(0.8, 1.215, "white line: 0", transform=axes.transAxes, va="center")
    axes.set(theta_zero_location="N", ylim=(0.0, 1.0), yticks=[0.5, 1.0])
    axes.set_yticklabels(["0.5", "1 r/R"], color="white")
    axes.set_rlabel_position(150.0)
    ticks = np.arange(0.0, 360.0, 45.0)
    named = {0.0: "0°, ahead", 90.0: "90°\nretreating", 180.0: "180°", 270.0: "270°\nadvancing"}
    axes.set_thetagrids(ticks, [named.get(tick, f"{tick:g}°") for tick in ticks])
    names = axes.get_xticklabels()
    names[2].set_horizontalalignment("right")
    names[6].set_horizontalalignment("left")
    axes.grid(color="white", linewidth=0.5)
    arrow = {"arrowstyle": "-|>", "color": "black", "linewidth": 2.0}
    axes.annotate("", xy=(0.5, 1.3), xytext=(0.5, 1.13), xycoords="axes fraction", arrowprops=arrow)
    axes.text(0.53, 1.215, "flight", transform=axes.transAxes, va="center")
    # The way in which the blades turn.
    start, end = (np.radians(22.0), 1.12), (np.radians(38.0), 1.12)
    bent = arrow | {"connectionstyle": "arc3,rad=0.08"}
    axes.annotate("", xy=end, xytext=start, arrowprops=bent, annotation_clip=False)

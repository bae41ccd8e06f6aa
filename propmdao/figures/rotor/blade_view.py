"""Figure of a propeller in space."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np

from propmdao.aerodynamics.lattice.rings import turned
from propmdao.figures.style import literal, page
from propmdao.geometry.meshes import propeller_surface
from propmdao.propeller.description import Propeller

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_N_CONTOUR, _N_SPAN = 41, 40
_BOX = {"facecolor": "white", "alpha": 0.8, "linewidth": 0.0, "pad": 1.0}


def blade_view(propeller: Propeller, title: str = "") -> Figure:
    """Draw a propeller from above, with its axes, and blade 1 from its trailing edge.

    Parameters
    ----------
    propeller : Propeller
        The propeller.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure: z toward thrust, blade 1 along x, rotation from x to y.
    """
    points = 1e3 * propeller_surface(propeller, _N_CONTOUR, _N_SPAN)
    # Axes in space fill the smaller side of their place, so each has a square of the page's width,
    # which reaches out of the page and over the other's.
    figure = page(8.0, layout=None)
    both: list[Any] = [
        figure.add_axes((0.0, height - 0.625, 1.0, 1.25), projection="3d")
        for height in (0.62, 0.17)
    ]
    above, tip = both
    n_blades = int(propeller.n_blades)
    azimuths = 2.0 * np.pi * np.arange(n_blades) / n_blades
    on_blades = np.asarray(turned(points.reshape(-1, 3), azimuths))
    all_blades = on_blades.reshape(n_blades, *points.shape)
    arrow = 0.15e3 * propeller.diameter
    for axes, blades in ((above, all_blades), (tip, all_blades[:1])):
        for blade in blades:
            axes.plot_surface(
                *np.moveaxis(blade, -1, 0), color="#56B4E9", edgecolor="0.3", linewidth=0.1,
                rcount=_N_CONTOUR, ccount=_N_SPAN, antialiased=True,
            )  # fmt: skip
        low, high = (np.array([end(b, axis=(0, 1)) for b in blades]) for end in (np.min, np.max))
        low, high = low.min(axis=0), high.max(axis=0)
        if axes is above:
            for name, direction in (("x", (1, 0, 0)), ("y", (0, 1, 0)), ("z, thrust", (0, 0, 1))):
                end = arrow * np.array(direction)
                axes.quiver(0, 0, 0, *end, color="#D55E00", arrow_length_ratio=0.15)
                axes.text(*(1.1 * end), name, color="#D55E00", bbox=_BOX)
                low, high = np.minimum(low, end), np.maximum(high, end)
        # A cube around all of it, so that one scale holds along every axis.
        middle, half = 0.5 * (low + high), 0.5 * float((high - low).max())
        ends = {f"{axis}lim": (m - half, m + half) for axis, m in zip("xyz", middle, strict=True)}
        axes.set(**ends)
        axes.set_box_aspect((1.0, 1.0, 1.0), zoom=1.25)
        axes.set_axis_off()
        axes.patch.set_visible(False)
    above.view_init(elev=35.0, azim=-60.0)
    tip.view_init(elev=20.0, azim=-75.0)
    figure.text(0.02, 0.97, literal(title), va="top")
    figure.text(0.02, 0.06, "blade 1, leading edge behind")
    return figure

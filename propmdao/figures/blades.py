"""Figure of blades: distributions over span, planform, sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from propmdao.figures.style import BLADE_COLORS, GRID, headline, line_styles, literal, page
from propmdao.geometry.blade import Blade, span_interpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.propeller.description import Propeller

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from matplotlib.figure import Figure


def blade_comparison(
    propellers: Mapping[str, Propeller], section_r_over_R: Sequence[float], title: str = ""
) -> Figure:
    """Blades beside each other: distributions over span, planform and sections.

    Parameters
    ----------
    propellers : mapping of str to Propeller
        Up to four propellers by name: the first dashed, the second solid.
    section_r_over_R : sequence of float
        Radii r/R of the sections that are drawn.
    title : str
        Title.

    Returns
    -------
    Figure
        The figure.
    """
    figure = page(8.0)
    grid = figure.add_gridspec(1, 2, width_ratios=(1.15, 1.0))
    spans: Any = grid[0].subgridspec(5, 1).subplots(sharex=True)
    sections: Any = grid[1].subgridspec(len(section_r_over_R), 1)
    sections = sections.subplots(sharex=True, sharey=True, squeeze=False)[:, 0]
    styles = line_styles(propellers)
    for i, (name, propeller) in enumerate(propellers.items()):
        # The first on top: its dashes let what is equal shine through.
        line = {"color": BLADE_COLORS[i], "linestyle": styles[name], "zorder": 4 - i}
        _draw_spans(spans, propeller, linewidth=2.0, label=literal(name), **line)
        _draw_sections(sections, propeller, section_r_over_R, linewidth=2.0, **line)
    for axes in (*spans, *sections):
        axes.grid(**GRID)
    spans[-1].set_xlabel("r/R")
    sections[-1].set_xlabel("x/c")
    figure.align_ylabels(spans)
    headline(figure, title)
    figure.legend(*spans[0].get_legend_handles_labels(), loc="outside upper center", ncols=4)
    return figure


def _draw_spans(spans: Sequence[Axes], propeller: Propeller, **line: Any) -> None:
    """Draw distributions over span, the planform on the last axes."""
    r = np.linspace(propeller.r_over_R[0], 1.0, 200)
    span = span_interpolation(propeller.r_over_R, r)
    chord, beta_deg, sweep = (
        np.asarray(span.smooth) @ values
        for values in (propeller.c_over_R, propeller.beta_deg, propeller.sweep_over_R)
    )
    camber, thickness = (np.asarray(span.linear) @ shape for shape in _sections(propeller))
    largest = np.take_along_axis(camber, np.abs(camber).argmax(axis=1)[:, None], axis=1)
    # Seen from ahead: the leading edge is toward +y, a quarter of the chord from the sweep line.
    projected = chord * np.cos(np.radians(beta_deg))
    edges = np.append(0.25 * projected - sweep, (-0.75 * projected - sweep)[::-1])
    for axes, label, values in zip(
        spans,
        ("chord c/R", "blade angle, deg", "thickness t/c", "camber f/c", "planform y/R"),
        (chord, beta_deg, thickness.max(axis=1), largest[:, 0], edges),
        strict=True,
    ):
        axes.plot(r if values.size == r.size else np.append(r, r[::-1]), values, **line)
        axes.set_ylabel(label)


def _draw_sections(
    sections: Sequence[Axes], propeller: Propeller, r_over_R: Sequence[float], **line: Any
) -> None:
    """Draw contours of unit chord, one on each axes."""
    linear = np.asarray(span_interpolation(propeller.r_over_R, r_over_R).linear)
    camber, thickness = (linear @ shape for shape in _sections(propeller))
    x = np.append(CHORD_FRACTION[::-1], CHORD_FRACTION)
    for axes, r, f, t in zip(sections, r_over_R, camber, thickness, strict=True):
        axes.plot(x, np.append((f + 0.5 * t)[::-1], f - 0.5 * t), **line)
        axes.set_title(f"section at r/R {r:g}", fontsize="medium")
        axes.set_ylabel("z/c, stretched")


def _sections(propeller: Propeller) -> tuple[npt.NDArray[np.float64], npt.NDArray[np.float64]]:
    """Camber and thickness over chord, (n_stations, n_chord), as the blade has them."""
    blade = Blade.from_propeller(propeller)
    camber = blade.camber_over_chord[:, None] * blade.camber_shape
    thickness = blade.thickness_over_chord[:, None] * blade.thickness_shape
    return np.asarray(camber), np.asarray(thickness)

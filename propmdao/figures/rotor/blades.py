"""Figure of blades: distributions over span, planform, sections."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

from propmdao.figures.contents.distributions import blade_distributions, section_contours
from propmdao.figures.contents.palette import BLADE_COLORS, line_styles
from propmdao.figures.style import GRID, headline, literal, page
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
    for axes, (label, (r, values)) in zip(
        spans, blade_distributions(propeller).items(), strict=True
    ):
        axes.plot(r, values, **line)
        axes.set_ylabel(label)


def _draw_sections(
    sections: Sequence[Axes], propeller: Propeller, r_over_R: Sequence[float], **line: Any
) -> None:
    """Draw contours of unit chord, one on each axes."""
    contours = section_contours(propeller, r_over_R)
    for axes, r, (x, z) in zip(sections, r_over_R, contours, strict=True):
        axes.plot(x, z, **line)
        axes.set_title(f"section at r/R {r:g}", fontsize="medium")
        axes.set_ylabel("z/c, stretched")

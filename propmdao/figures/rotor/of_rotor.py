"""Figures of an analysis that need no observer: blade, loads over span, polars."""

from __future__ import annotations

from typing import TYPE_CHECKING

from propmdao.aerodynamics.sections.polars.family import SectionPolars
from propmdao.analysis.results import Analysis
from propmdao.figures.contents.subjects import operation
from propmdao.figures.rotor.blade_view import blade_view
from propmdao.figures.rotor.section_polars import section_polars
from propmdao.figures.rotor.span_loads import span_loads

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def rotor_figures(analysis: Analysis, polars: SectionPolars | None = None) -> dict[str, Figure]:
    """Draw the rotor of an analysis.

    Parameters
    ----------
    analysis : Analysis
        Analysis, with or without observers.
    polars : SectionPolars, optional
        Polars with which it was made; None in inviscid flow.

    Returns
    -------
    dict of str to Figure
        "blade", "span_loads", which a rotor at rest has not, and "polars" of viscous loads.
    """
    propeller = analysis.changed_propeller
    described = f"{propeller.name}, {propeller.n_blades} blades, {propeller.diameter:.4g} m"
    figures = {"blade": blade_view(propeller, described)}
    if analysis.rpm > 0.0:
        title = operation(analysis)
        figures["span_loads"] = span_loads(analysis, title)
        if polars is not None:
            figures["polars"] = section_polars(analysis, polars, title)
    return figures

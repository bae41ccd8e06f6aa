"""Figures of the analyses of several propellers at the same operating point and observers."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING

from propmdao.acoustics.kinematics.observers import directions
from propmdao.analysis.results import Analysis
from propmdao.figures.contents.palette import LEVEL, LEVEL_DBA
from propmdao.figures.contents.sound import analysis_sound, source_levels
from propmdao.figures.contents.subjects import observer_groups
from propmdao.figures.designs.spectra_over_each_other import spectra_over_each_other
from propmdao.figures.of_analysis import arc_diagram
from propmdao.figures.rotor.blades import blade_comparison

if TYPE_CHECKING:
    from matplotlib.figure import Figure

_SECTIONS_AT = (0.3, 0.75, 0.95)  # r/R, as far as the blades reach inward


def compared_figures(
    analyses: Mapping[str, Analysis], observer: int | None = None
) -> dict[str, Figure]:
    """Draw analyses over each other.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, two to four, with the same observers.
    observer : int, optional
        Index of the observer of the spectra; None for propellers that nobody hears.

    Returns
    -------
    dict of str to Figure
        "blades"; with an observer also "spectra", and for an arc of three elevations or more
        "directivity" in dB and "directivity_dba", with "_2" and so on for further arcs.
    """
    blades = {name: analysis.changed_propeller for name, analysis in analyses.items()}
    inner = max(float(blade.r_over_R[0]) for blade in blades.values())
    title = " and ".join(blades)
    figures = {"blades": blade_comparison(blades, [max(r, inner) for r in _SECTIONS_AT], title)}
    if observer is None:
        return figures
    first = next(iter(analyses.values()))
    sounds = {name: analysis_sound(analysis) for name, analysis in analyses.items()}
    positions = first.listening.observers
    seen = directions(positions).rounded()
    point = first.point
    driven = f"{point.rpm:g} rpm" if point.thrust is None else f"{point.thrust:g} N"
    flight = f"{point.speed:g} m/s" if point.speed else "hover"
    if point.incidence_deg:
        flight += f" at an incidence of {point.incidence_deg:g}°"
    noise = "tones and broadband noise" if first.broadband is not None else "tones"
    parts = f"{driven}, {flight}; {noise}"
    title = (
        f"{parts} at observer {observer + 1}: {seen.elevation_deg[observer]:.4g}°,"
        f" {seen.radius[observer]:.4g} m"
    )
    figures["spectra"] = spectra_over_each_other(sounds, observer, title)
    arcs = [members for kind, members in observer_groups(first.listening) if kind == "arc"]
    for name, a_weighted in (("directivity", False), ("directivity_dba", True)):
        label = f"OASPL, {LEVEL_DBA if a_weighted else LEVEL}"
        levels = {
            propeller: source_levels(sound, a_weighted)["total"]
            for propeller, sound in sounds.items()
        }
        number = 0
        for members in arcs:
            here = {propeller: level[members] for propeller, level in levels.items()}
            figure = arc_diagram(positions[members], here, label, parts)
            if figure is not None:
                number += 1
                figures[name if number == 1 else f"{name}_{number}"] = figure
    return figures

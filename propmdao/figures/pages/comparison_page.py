"""The page of propellers beside each other at one operating point."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

from propmdao.analysis.results import Analysis
from propmdao.figures.contents.doubts import doubts
from propmdao.figures.pages import rotor_figures, sound_figures, tables
from propmdao.figures.pages.analysis_page import blades_section, inputs_section, tones_alone
from propmdao.figures.pages.parts import Origin, Page, Section
from propmdao.records.states import OperatingPoint


def comparison_page(
    analyses: Mapping[str, Analysis], observer: int | None, origin: Origin, seconds: float
) -> Page:
    """Make the page of a comparison.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, two to four, with the same observers.
    observer : int or None
        Index of the observer of table and sounds; None where nobody listens.
    origin : Origin
        Where the numbers come from.
    seconds : float
        Length of the sounds [s].

    Returns
    -------
    Page
        The page.
    """
    results = {name: analysis.to_dict() for name, analysis in analyses.items()}
    first = next(iter(analyses.values()))
    return Page(
        title=" and ".join(analyses),
        subtitle=f"{operating_point(first.point)}, air {float(first.point.air.density):.4g} kg/m³",
        doubts=doubts_of_all(results),
        numbers=first_numbers(results, observer),
        sections=[
            *compared_sections(analyses, results, observer, seconds),
            blades_section({name: a.changed_propeller for name, a in analyses.items()}),
            inputs_section(results),
        ],
        origin=origin,
    )


def operating_point(point: OperatingPoint) -> str:
    """What is asked of propellers alike, in words.

    Parameters
    ----------
    point : OperatingPoint
        The operating point.

    Returns
    -------
    str
        Thrust or rotation speed, flight.
    """
    driven = f"{point.rpm:g} rpm" if point.thrust is None else f"{point.thrust:g} N"
    flight = f"{float(point.speed):g} m/s" if point.speed else "hover"
    if point.incidence_deg:
        flight += f" at an incidence of {point.incidence_deg:g}°"
    return f"{driven}, {flight}"


def doubts_of_all(results: Mapping[str, dict[str, Any]]) -> list[str]:
    """What keeps the numbers of several propellers from being used.

    Parameters
    ----------
    results : mapping of str to dict
        Results by the name of the propeller, with the keys of ``propmdao analyze --json``.

    Returns
    -------
    list of str
        Sentences, those of one propeller with its name in front.
    """
    every = {name: doubts([result]) for name, result in results.items()}
    common = [s for s in next(iter(every.values())) if all(s in own for own in every.values())]
    own = [f"{name}: {s}" for name, said in every.items() for s in said if s not in common]
    return [*own, *common, *tones_alone(next(iter(results.values())))]


def first_numbers(results: Mapping[str, Mapping[str, Any]], observer: int | None) -> dict[str, str]:
    """Numbers of several propellers that are read first.

    Parameters
    ----------
    results : mapping of str to dict
        Results by the name of the propeller, with the keys of ``propmdao analyze --json``.
    observer : int or None
        Index of the observer; None where nobody listens.

    Returns
    -------
    dict of str to str
        Rotation speed, power and level of each, with their units.
    """
    shown = {}
    for name, result in results.items():
        shown[f"{name}: rotation speed"] = f"{result['rpm']:.0f} rpm"
        shown[f"{name}: shaft power"] = f"{result['shaft_power']:.4g} W"
        if observer is not None:
            heard_at = result["observers"][observer]
            key = "oaspl_total_dba" if "oaspl_total_dba" in heard_at else "oaspl_dba"
            what = "all noise" if key == "oaspl_total_dba" else "tones"
            shown[f"{name}: {what}, observer {observer + 1}"] = tables.level_dba(heard_at[key])
    return shown


def compared_sections(
    analyses: Mapping[str, Analysis],
    results: Mapping[str, dict[str, Any]],
    observer: int | None,
    seconds: float | None,
    where: str = "",
) -> list[Section]:
    """Sections on several propellers at one operating point.

    Parameters
    ----------
    analyses : mapping of str to Analysis
        Analyses by the name of the propeller, two to four, with the same observers.
    results : mapping of str to dict
        The same with the keys of ``propmdao analyze --json``.
    observer : int or None
        Index of the observer of table and sounds; None where nobody listens.
    seconds : float or None
        Length of the sounds [s]; None for no sounds.
    where : str
        Operating point, for the headings of a page of several.

    Returns
    -------
    list of Section
        Numbers, noise where somebody listens, loads of rotors that turn.
    """
    place = f" at {where}" if where else ""
    sections = [Section(f"Numbers{place}", [tables.beside(results, observer)])]
    turning = {name: analysis for name, analysis in analyses.items() if analysis.rpm > 0.0}
    if observer is not None and len(turning) == len(analyses):
        sections.append(_heard(analyses, observer, seconds, f"Noise{place}"))
    if turning:
        sections.append(Section(f"Loads{place}", [rotor_figures.span_loads(turning)]))
    return sections


def _heard(
    analyses: Mapping[str, Analysis], observer: int, seconds: float | None, heading: str
) -> Section:
    """Sounds, spectra, directions."""
    first = next(iter(analyses.values()))
    loudest = sound_figures.loudest_observers(first)
    shown: Sequence[int] = [observer, *(i for i in loudest if i != observer)]
    shown = shown[: sound_figures.MOST_OBSERVERS]
    parts: list[Any] = []
    if seconds is not None:
        parts += sound_figures.players(analyses, [observer], seconds)
    parts.append(sound_figures.beside(analyses, shown))
    parts += sound_figures.over_directions(analyses)
    notes = ["All sounds have one full scale, so that they can be compared by ear."]
    return Section(heading, parts, notes if seconds is not None else [])

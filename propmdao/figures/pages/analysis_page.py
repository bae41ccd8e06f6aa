"""The page of an analysis: numbers, sounds, figures, inputs."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from propmdao.analysis.results import Analysis
from propmdao.figures.contents.doubts import TONES_ONLY, doubts
from propmdao.figures.contents.subjects import condition
from propmdao.figures.pages import rotor_figures, sound_figures, tables
from propmdao.figures.pages.parts import Figure, Origin, Page, Section, Table


def analysis_page(
    analysis: Analysis, result: dict[str, Any], origin: Origin, seconds: float
) -> Page:
    """Make the page of an analysis.

    Parameters
    ----------
    analysis : Analysis
        The analysis.
    result : dict
        The same with the keys of ``propmdao analyze --json``.
    origin : Origin
        Where the numbers come from.
    seconds : float
        Length of the sounds [s].

    Returns
    -------
    Page
        The page.
    """
    propeller = analysis.changed_propeller
    name = analysis.propeller.name
    sections = []
    if result["observers"]:
        sections.append(_heard(analysis, result, seconds))
    if analysis.rpm > 0.0:
        loads = [rotor_figures.span_loads({name: analysis}), *rotor_figures.over_turn(analysis)]
        sections.append(Section("Loads", loads))
    if result.get("band"):
        sections.append(Section("How far the numbers may be off", [tables.band(result)]))
    sections.append(blades_section({name: propeller}))
    sections.append(inputs_section({name: result}))
    return Page(
        title=name,
        subtitle=f"{propeller.n_blades} blades, diameter {propeller.diameter:.4g} m;"
        f" {condition(analysis)}, air {result['rho']:.4g} kg/m³",
        doubts=[*doubts([result]), *tones_alone(result)],
        numbers=tables.first_numbers(result),
        sections=sections,
        origin=origin,
    )


def _heard(analysis: Analysis, result: Mapping[str, Any], seconds: float) -> Section:
    """Levels, sounds, spectra, directions."""
    observers = sound_figures.loudest_observers(analysis)
    parts: list[Any] = [tables.levels(result["observers"])]
    if analysis.broadband is not None:
        parts.append(tables.mechanisms(result["observers"]))
    notes = []
    if analysis.rpm > 0.0:
        name = analysis.propeller.name
        parts += sound_figures.players({name: analysis}, observers, seconds)
        parts.append(sound_figures.at_observers(analysis, observers))
        parts += sound_figures.over_directions({name: analysis})
        notes.append(sound_figures.words_on_observers(len(observers), len(result["observers"])))
    return Section("Noise", parts, notes)


def tones_alone(result: Mapping[str, Any]) -> list[str]:
    """Sentence on what levels without broadband noise lack.

    Parameters
    ----------
    result : dict
        With the keys of ``propmdao analyze --json``.

    Returns
    -------
    list of str
        The sentence, or none.
    """
    quiet = result["model"]["noise"]["broadband"] is None
    return [TONES_ONLY] if quiet and result["observers"] else []


def blades_section(propellers: Mapping[str, Any]) -> Section:
    """Section on what blades look like.

    Parameters
    ----------
    propellers : mapping of str to Propeller
        Propellers that were analysed, by name.

    Returns
    -------
    Section
        Blades in space, their shape over span, their stations.
    """
    parts: list[Figure | Table] = [
        rotor_figures.in_space(propellers),
        rotor_figures.shapes(propellers),
    ]
    parts += [tables.stations(name, propeller) for name, propeller in propellers.items()]
    return Section("Blades", parts)


def inputs_section(results: Mapping[str, dict[str, Any]]) -> Section:
    """Section on what numbers follow from.

    Parameters
    ----------
    results : mapping of str to dict
        Results by the name of the propeller, of one request.

    Returns
    -------
    Section
        Propellers with their sources, and everything that was asked.
    """
    described = [tables.described(result["propeller"]) for result in results.values()]
    return Section("Inputs", [*described, tables.inputs(next(iter(results.values())))])

"""The page of an optimisation: the search, and both blades beside each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
import numpy.typing as npt

from propmdao.analysis.results import Analysis
from propmdao.figures.contents.palette import RUN_COLORS
from propmdao.figures.pages.analysis_page import blades_section, inputs_section
from propmdao.figures.pages.comparison_page import (
    compared_sections,
    doubts_of_all,
    first_numbers,
    operating_point,
)
from propmdao.figures.pages.diagrams import diagram, line
from propmdao.figures.pages.parts import Figure, Origin, Page, Section

_SECONDS = 4.0  # of each sound
_MOST_HEARD = 2  # operating points with sounds: a page of two is below 5 MB
_LEAST_VIOLATION = 1e-7


def design_page(
    points: Sequence[Mapping[str, Analysis]],
    observers: Sequence[int | None],
    search: Section,
    origin: Origin,
) -> Page:
    """Make the page of an optimisation.

    Parameters
    ----------
    points : sequence of mapping of str to Analysis
        Analyses of the described and the designed blade at each operating point.
    observers : sequence of int or None
        Index of the observer of table and sounds at each; None where nobody listens.
    search : Section
        How the design was found, of `search_section`.
    origin : Origin
        Where the numbers come from.

    Returns
    -------
    Page
        The page.
    """
    every = [{name: a.to_dict() for name, a in analyses.items()} for analyses in points]
    first = points[0]
    described, designed = first
    several = len(points) > 1
    sections = []
    for number, (analyses, results, observer) in enumerate(
        zip(points, every, observers, strict=True)
    ):
        where = operating_point(next(iter(analyses.values())).point) if several else ""
        seconds = _SECONDS if number < _MOST_HEARD else None
        sections += compared_sections(analyses, results, observer, seconds, where)
    asked = [operating_point(next(iter(analyses.values())).point) for analyses in points]
    return Page(
        title=f"{designed}, from {described}",
        subtitle="; ".join(asked),
        doubts=[*dict.fromkeys(doubt for results in every for doubt in doubts_of_all(results))],
        numbers=first_numbers(every[0], observers[0]),
        sections=[
            *sections,
            search,
            blades_section({name: a.changed_propeller for name, a in first.items()}),
            inputs_section(every[0]),
        ],
        origin=origin,
    )


def search_section(
    objective: npt.ArrayLike, violation: npt.ArrayLike, label: str, tolerance: float
) -> Section:
    """Section on how a design was found.

    Parameters
    ----------
    objective : (n_evaluations,) array_like
        Objective of every design; nan where the analysis failed.
    violation : (n_evaluations,) array_like
        Largest violation of a constraint in driver scaling.
    label : str
        Name of the objective with its unit.
    tolerance : float
        Violation that counts as none.

    Returns
    -------
    Section
        The history of the search.
    """
    reached, missed = np.asarray(objective, float), np.asarray(violation, float)
    number = np.arange(1, reached.size + 1)
    met = missed <= tolerance
    best = np.minimum.accumulate(np.where(met & ~np.isnan(reached), reached, np.inf))
    best = np.where(np.isfinite(best), best, np.nan)
    dots = line(number, reached, "every design", color=RUN_COLORS[0], marker="o")
    dots |= {"mode": "markers"}
    dots["marker"] |= {"color": RUN_COLORS[0]}
    designs = ("designs evaluated", "")
    drawn = np.where(np.isfinite(missed), np.maximum(missed, _LEAST_VIOLATION), np.nan)
    panels = [
        diagram(
            label,
            [dots, line(number, best, "best that meets all limits", color=RUN_COLORS[1])],
            designs,
        ),
        diagram(
            "largest violation of a limit, scaled",
            [
                line(number, drawn, "violation", color=RUN_COLORS[4], marker="s"),
                line(number[[0, -1]], [tolerance] * 2, "tolerance", color="#555555", style="--"),
            ],
            designs,
            y={"type": "log"},
        ),
    ]
    failed = int(np.sum(np.isnan(reached)))
    lacking = f", {failed} of them failed" if failed else ""
    return Section(
        "Search",
        [
            Figure(
                "History of the search",
                f"{label} and largest violation of a limit over the designs evaluated",
                {"all": panels},
                note=f"Violations below {_LEAST_VIOLATION:g} are drawn there.",
            )
        ],
        [f"{reached.size} designs were evaluated{lacking}."],
    )

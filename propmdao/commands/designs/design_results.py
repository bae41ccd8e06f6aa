"""What ``propmdao optimise`` writes: the blade, its history, and both blades beside each other."""

from __future__ import annotations

import argparse
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

import numpy as np

from propmdao.analysis.single_point import analyze
from propmdao.analysis.sounds import MAX_CHANNELS
from propmdao.commands.designs.compared_analyses import ComparedAnalyses
from propmdao.commands.designs.design_options import ASKED_OPTIONS
from propmdao.commands.designs.design_search import TOLERANCE
from propmdao.commands.observer_options import listening_of
from propmdao.commands.output.output_files import save_figures, write_csv
from propmdao.commands.output.progress import progress
from propmdao.commands.output.report_file import origin_of, write_report
from propmdao.commands.output.results_folder import file_name
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.components.drivers.search_history import SearchHistory
from propmdao.figures.designs import searches
from propmdao.figures.designs.of_comparison import compared_figures
from propmdao.formats.toml_files import write_toml
from propmdao.propeller.description import Propeller
from propmdao.propeller.design_choices import RESPONSES
from propmdao.records.states import OperatingPoint
from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from matplotlib.figure import Figure


def write_results(
    folder: Path,
    options: argparse.Namespace,
    blades: tuple[Propeller, Propeller],
    points: Sequence[OperatingPoint],
    history: SearchHistory,
) -> dict[str, Any]:
    """Write the designed propeller and compare it with the described one.

    Parameters
    ----------
    folder : Path
        Folder of the results.
    options : argparse.Namespace
        What was typed.
    blades : (Propeller, Propeller)
        The described and the designed one.
    points : sequence of OperatingPoint
        Operating points of the design.
    history : SearchHistory
        Designs of the search.

    Returns
    -------
    dict
        Results for the record: the analyses of both blades at every operating point.
    """
    described, designed = blades
    file = folder / f"{file_name(designed.name)}.toml"
    write_toml(file, designed)
    _write_history(folder / "history.csv", history, RESPONSES[options.minimise].label)
    figures = {"history": _history_figure(history, options.minimise, designed.name)}
    files = [str(file), str(folder / "history.csv")]
    listening = listening_of(options)
    asked = {name: getattr(options, name) for name in ASKED_OPTIONS}
    if len(listening.observers):  # a blade that is quieter in tones may be louder in all
        asked["broadband"] = True
    results: list[dict[str, Any]] = []
    compared_at: list[ComparedAnalyses] = []
    warned_of: list[str] = []
    for number, point in enumerate(points, start=1):
        suffix = "" if len(points) == 1 else f"_at_{number}"
        where = f"{point.thrust:g} N, {point.speed:g} m/s"
        if point.incidence_deg:
            where += f", {point.incidence_deg:g} deg"
        progress(f"analysing both blades at {where}")
        with warning_lines("optimise") as warned:
            analyses = {
                blade.name: analyze(blade, point, listening=listening, **asked)
                for blade in (described, designed)
            }
        compared = ComparedAnalyses.beside(analyses)
        results += compared.results.values()
        compared_at.append(compared)
        warned_of += warned
        if len(points) > 1:
            print_line(f"At {where}:")
        compared.print_table()
        files += compared.write_table(folder / f"comparison{suffix}.csv")
        drawn = compared_figures(analyses, compared.observer)
        figures.setdefault("blades", drawn.pop("blades"))
        figures |= {f"{name}{suffix}": figure for name, figure in drawn.items()}
        if 0 < len(listening.observers) <= MAX_CHANNELS:
            files += compared.write_sounds(folder, 5.0, suffix)
    files += save_figures(folder, figures)
    if options.report is not None:
        _write_page(options, compared_at, history, warned_of)
        files.append(str(options.report))
    print_line(" ".join(["Files:", *files]))
    return {"results": results}


def _write_page(
    options: argparse.Namespace,
    compared_at: Sequence[ComparedAnalyses],
    history: SearchHistory,
    warned_of: Sequence[str],
) -> None:
    """Write the page of the design."""
    from propmdao.figures.pages.design_page import design_page, search_section

    label = RESPONSES[options.minimise].label
    page = design_page(
        [compared.analyses for compared in compared_at],
        [compared.observer for compared in compared_at],
        search_section(history.objective, history.violation, label, TOLERANCE),
        origin_of(options, [*dict.fromkeys(warned_of)]),
    )
    write_report(options, page)


def _write_history(path: Path, history: SearchHistory, label: str) -> None:
    """Write every design that was tried."""
    rows: list[list[Any]] = []
    designs = zip(history.objective, history.violation, history.constraint, strict=True)
    for number, (objective, violation, constraint) in enumerate(designs, start=1):
        failed = not np.isfinite(violation)
        numbers = ["", ""] if failed else [float(objective), float(violation)]
        rows.append([number, *numbers, constraint])
    heads = ["design", label, "largest violation, scaled", "violated, or failure"]
    write_csv(path, heads, rows)


def _history_figure(history: SearchHistory, minimise: str, name: str) -> Figure:
    label = RESPONSES[minimise].label
    runs = {name: (history.objective, history.violation)}
    return searches.history(runs, label, TOLERANCE, f"search for {name}")

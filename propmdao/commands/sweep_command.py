"""Command line: ``propmdao sweep``."""

from __future__ import annotations

import argparse
from collections.abc import Callable, Mapping, Sequence
from pathlib import Path
from typing import Any

from propmdao.commands.observer_options import (
    add_observers,
    add_surroundings,
    air_of,
    listening_of,
)
from propmdao.commands.options import (
    TURBULENCE_OPTIONS,
    add_asked,
    add_command,
    add_propeller,
    number,
    number_or_range,
)
from propmdao.commands.output.output_files import (
    require_matplotlib,
    require_output_folder,
    save_figures,
)
from propmdao.commands.output.report_file import (
    add_report,
    origin_of,
    require_report,
    write_report,
)
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.records.quantities import VARIABLES
from propmdao.records.units import Range
from propmdao.runtime.terminal import print_line

SWEEP_DESCRIPTION = """\
A propeller at many points into a table, a row per point: a map of thrust, torque and noise over
rotation speed and flight speed, the effect of pitch, or samples for a surrogate model.

Every combination of the values given is a point. A value may be a range START:STOP:STEP that
includes STOP, and options may be repeated. With --samples, ranges are LOWEST:HIGHEST and points are
drawn in between (Latin hypercube).

A table that exists is gone on with: its points are not analysed again, so a sweep that was stopped
or killed resumes. Points that cannot be analysed are rows with status failed and the reason.
"""

SWEEP_EXAMPLES = """\
examples:
  propmdao sweep apcsf_11x4.7 --rpm 3000:6000:500 --speed 0:12:2 --arc 1.905 -45 --out sweep.csv
  propmdao sweep apcsf_11x4.7 --thrust 1.5 --speed 8 --twist-offset -2:4:0.5 --out pitch.csv
  propmdao sweep my_blade.toml --samples 200 --rpm 3000:6000 --speed 0:12 --out samples.parquet
  propmdao sweep apcsf_11x4.7 --points flight.csv --workers 2 --out flight_analysed.csv

Columns that --points may have: rpm, thrust_required, speed, rho, twist_offset_deg, chord_factor,
diameter, n_blades. SI units, angles in degrees. Exit status: 0, or 2 with one line on stderr, also
when every point has failed.
"""

#: What is asked of all points alike.
ASKED_OF_ALL = (
    "viscous",
    "blade_element",
    "stall_delay",
    "n_crit",
    "trip_upper",
    "trip_lower",
    "broadband",
    "trip",
    "layers",
    *TURBULENCE_OPTIONS,
)


def add_sweep(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "sweep",
        _sweep,
        "thrust, torque and noise at many points into a table",
        SWEEP_DESCRIPTION,
        SWEEP_EXAMPLES,
    )
    add_propeller(command)
    for variable, quantity in VARIABLES.items():
        command.add_argument(
            quantity.option,
            dest=variable,
            metavar=quantity.placeholder,
            action="append",
            help=quantity.help,
        )
    command.add_argument(
        "--points",
        metavar="FILE",
        help="points from a CSV file, combined with every value of the other options",
    )
    command.add_argument(
        "--samples", type=int, metavar="N", help="draw N points in the ranges LOWEST:HIGHEST"
    )
    command.add_argument(
        "--seed", type=int, default=1, help="of the drawn points, default 1; same seed, same points"
    )
    add_asked(command, ASKED_OF_ALL)
    command.add_argument(
        "--workers", type=int, default=1, metavar="N", help="processes that analyse, default 1"
    )
    command.add_argument(
        "--out",
        required=True,
        metavar="FILE",
        help="table: .csv, or .parquet, which is written at the end beside the .csv of that name",
    )
    command.add_argument(
        "--figures",
        type=Path,
        metavar="FOLDER",
        help="CT, CP, efficiency and figure of merit over the one or two variables that vary, as"
        " PNG, with record.json: inputs and versions",
    )
    add_report(
        command, "results over the one or two variables that vary, points, inputs and versions"
    )
    add_observers(command)
    add_surroundings(command)


def _sweep(options: argparse.Namespace) -> None:
    asked = {name: getattr(options, name) for name in ASKED_OF_ALL} | air_of(options)
    points = _points(options)
    listening = listening_of(options, _incidence(options, points))
    asked |= {"observers": listening.observers, "surroundings": listening.surroundings}
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.analysis.sweeping.sweeps import sweep, swept_rows
    from propmdao.formats.propellers import load_propeller
    from propmdao.runtime.worker_processes import WorkerLostError

    columns: tuple[str, ...] = ()
    if options.figures is not None:
        require_output_folder("--figures", options.figures)
        require_matplotlib("--figures")
    require_report(options)
    if options.figures is not None or options.report is not None:
        from propmdao.figures.contents.sweeps import varied_columns

        columns = varied_columns(points)
    with warning_lines("sweep") as warned:
        propeller = load_propeller(options.propeller)
    try:
        n_new, failures = sweep(propeller, points, options.out, n_workers=options.workers, **asked)
    except WorkerLostError as error:
        raise ValueError(f"{error} The rows so far are kept: run again to go on") from error
    counts = f"points: {len(points)}, {n_new} new, {len(failures)} failed"
    if failures and len(failures) == len(points):
        raise ValueError(f"{counts}, the first with: {failures[0]}")
    print_line(f"{counts}; {options.out}")
    if options.figures is not None:
        from propmdao.commands.output.results_folder import write_record
        from propmdao.figures.contents.sweeps import SHOWN
        from propmdao.figures.rotor.sweep_maps import sweep_maps

        write_record(options.figures, options, {propeller.name: propeller}, points=points)
        rows = [
            {name: float(row[name]) for name in (*columns, *SHOWN)}
            for row in swept_rows(propeller, points, options.out, **asked)
        ]
        figures = {"sweep": sweep_maps(rows, columns, propeller.name)}
        print_line(" ".join(["Figures:", *save_figures(options.figures, figures)]))
    if options.report is not None:
        from propmdao.analysis.request import Request
        from propmdao.figures.pages.sweep_page import sweep_page

        done = swept_rows(propeller, points, options.out, **asked)
        common = Request.of(rpm=0.0, **asked).to_dict()
        common = {name: common[name] for name in ("model", "listening")}
        origin = origin_of(options, warned)
        page = sweep_page(propeller, done, columns, common, failures, origin)
        print_line(f"Report: {write_report(options, page)}")
    for reason in list(dict.fromkeys(failures))[:3]:
        print_line(f"  failed: {reason}")


def _incidence(options: argparse.Namespace, points: Sequence[Mapping[str, float]]) -> float:
    """Incidence of the points, by which --level turns observers that are placed by the ground."""
    every = {point.get("incidence_deg", 0.0) for point in points}
    if options.level and (options.grid or options.hemisphere) and len(every) > 1:
        raise ValueError(
            "--grid and --hemisphere are placed by the ground: with --level all points need the"
            f" same incidence; they have {len(every)}"
        )
    return every.pop()


def _points(options: argparse.Namespace) -> list[dict[str, float]]:
    from propmdao.analysis.sweeping.points import MOST_POINTS, grid, latin_hypercube, read_points

    typed = {variable: getattr(options, variable) for variable in VARIABLES}
    typed = {variable: texts for variable, texts in typed.items() if texts}
    drawn: list[dict[str, float]] = [{}]
    if options.samples is not None:
        Range(1, MOST_POINTS).require("--samples", options.samples)
        ranges = {
            variable: _low_high(variable, typed.pop(variable), number)
            for variable, texts in list(typed.items())
            if any(":" in text for text in texts)
        }
        if not ranges:
            raise ValueError("--samples needs a range LOWEST:HIGHEST to draw from")
        drawn = latin_hypercube(ranges, options.samples, options.seed)
    listed = [{}] if options.points is None else read_points(options.points)
    for variable in typed:
        if any(variable in point for point in listed):
            raise ValueError(f"{variable} is given as an option and in '{options.points}'")
    values = {name: _values(name, texts, number_or_range) for name, texts in typed.items()}
    n_points = len(drawn) * len(listed)
    for numbers in values.values():
        n_points *= len(numbers)
    if n_points > MOST_POINTS:
        raise ValueError(f"{n_points} points are more than the {MOST_POINTS} that are allowed")
    return [{**a, **b, **c} for a in listed for b in drawn for c in grid(values)]


def _values(
    variable: str, texts: Sequence[str], parse: Callable[[str], float | list[float]]
) -> list[float]:
    values: list[float] = []
    for text in texts:
        value = _parsed(variable, text, parse)
        values += value if isinstance(value, list) else [value]
    return list(dict.fromkeys(values))


def _low_high(
    variable: str, texts: Sequence[str], parse: Callable[[str], float]
) -> tuple[float, float]:
    parts = texts[0].split(":")
    if len(texts) > 1 or len(parts) != 2:
        raise ValueError(f"{variable}: --samples needs one range LOWEST:HIGHEST; it is {texts}")
    low, high = (_parsed(variable, part, parse) for part in parts)
    if not low < high:
        raise ValueError(f"{variable}: LOWEST of {texts[0]!r} must be below HIGHEST")
    return low, high


def _parsed(variable: str, text: str, parse: Callable[[str], Any]) -> Any:
    try:
        return parse(text)
    except argparse.ArgumentTypeError as error:
        raise ValueError(f"{variable}: {error}") from None

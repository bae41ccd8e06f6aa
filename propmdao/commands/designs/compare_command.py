"""Command line: ``propmdao compare``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import (
    add_observers,
    add_surroundings,
    air_of,
    listening_of,
)
from propmdao.commands.options import add_asked, add_command, asked_of, number
from propmdao.commands.output.json_output import print_json
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
from propmdao.formats.endings import PROPELLER_READERS, described
from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.commands.designs.compared_analyses import ComparedAnalyses
    from propmdao.propeller.description import Propeller
    from propmdao.records.listening import Listening

FEWEST, MOST = 2, 4  # propellers: what a table of 80 columns and a figure hold
DESCRIPTION = f"""\
{FEWEST} to {MOST} propellers at the same thrust or rotation speed, heard by the same observers.

Prints operating points and levels with their change from the first propeller, at one observer and
as means over all of them. With --results everything else goes into a folder: the table unrounded,
spectra and third octaves over each other, directivity of an arc in dB and in dBA, the blades over
each other, a sound file for each propeller, all of one full scale so that they can be compared by
ear, and record.json with every input, number and version.
"""

EXAMPLES = """\
examples:
  propmdao compare apcsf_11x4.7 apcsf_10x4.7 --thrust 3
  propmdao compare apcsf_11x4.7 my_blade.toml --thrust 3 --speed 8 --arc 1.905 -75:75:15 --broadband
  propmdao compare old.toml new.toml --thrust 6 --arc 2 -90:90:10 --broadband --results old_and_new
  propmdao compare old.toml new.toml --thrust 6 --arc 2 -90:90:10 --broadband --report page.html

Levels are in dB re 20 uPa, rms. SI units throughout. Exit status: 0, or 2 with one line on stderr.
"""

#: What may be asked of all propellers alike.
ASKED_OPTIONS = (
    "rpm",
    "thrust",
    "speed",
    "incidence_deg",
    "density",
    "viscous",
    "blade_element",
    "stall_delay",
    "n_crit",
    "trip_upper",
    "trip_lower",
    "measured_drag",
    "broadband",
    "trip",
    "layers",
)


def add_compare(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "compare",
        _compare,
        "propellers beside each other: thrust, torque, noise, figures, sounds",
        DESCRIPTION,
        EXAMPLES,
    )
    command.add_argument(
        "propellers",
        nargs="+",
        metavar="PROPELLER",
        help=f"{FEWEST} to {MOST} names from 'propmdao list', or paths of files:"
        f" {described(PROPELLER_READERS)}",
    )
    add_asked(command, ASKED_OPTIONS)
    command.add_argument("--json", action="store_true", help="print JSON instead of a table")
    command.add_argument(
        "--observer",
        type=int,
        metavar="N",
        help="observer of the table and the spectra, counted from 1; default that of the first"
        " propeller's loudest tones",
    )
    command.add_argument(
        "--results",
        type=Path,
        metavar="FOLDER",
        help="write table, figures, sounds and record.json",
    )
    add_report(command, "numbers, players for the sounds, figures, inputs and versions")
    command.add_argument(
        "--seconds", type=number, metavar="S", help="length of the sounds [s], default 5"
    )
    add_observers(command)
    add_surroundings(command)


def _compare(options: argparse.Namespace) -> None:
    listening = listening_of(options)
    _check(options, listening)
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.analysis.request import Request

    asked = asked_of(options) | air_of(options)
    Request.of({"listening": listening}, **asked)
    from propmdao.analysis.single_point import analyze
    from propmdao.commands.designs.compared_analyses import ComparedAnalyses
    from propmdao.figures.contents.doubts import TONES_ONLY
    from propmdao.formats.propellers import load_propeller

    with warning_lines("compare") as warned:
        loaded = [load_propeller(name) for name in options.propellers]
        propellers = dict(zip(_labels(options.propellers, loaded), loaded, strict=True))
        analyses = {
            name: analyze(propeller, listening=listening, **asked)
            for name, propeller in propellers.items()
        }
    chosen = None if options.observer is None else int(options.observer) - 1
    compared = ComparedAnalyses.beside(analyses, chosen)
    results = list(compared.results.values())
    if options.report is not None:
        from propmdao.figures.pages.comparison_page import comparison_page

        origin = origin_of(options, warned)
        page = comparison_page(analyses, compared.observer, origin, _seconds(options))
        write_report(options, page)
    if options.json:
        files = _write(options, propellers, compared)
        print_json({"results": results, "files": files})
        return
    compared.print_table()
    if compared.observer is None:
        print_line("No observers: --arc RADIUS ELEVATION... adds their noise.")
    elif results[0]["model"]["noise"]["broadband"] is None:
        print_line(TONES_ONLY)
    files = _write(options, propellers, compared)
    if files:
        print_line(" ".join(["Files:", *files]))


def _check(options: argparse.Namespace, listening: Listening) -> None:
    """Refuse options that do not go together, before the work."""
    n_propellers, n_observers = len(options.propellers), len(listening.observers)
    if not FEWEST <= n_propellers <= MOST:
        raise ValueError(f"{FEWEST} to {MOST} propellers are compared; there are {n_propellers}")
    if options.observer is not None and not 1 <= options.observer <= n_observers:
        there = f"must be within 1 ... {n_observers}" if n_observers else "needs observers"
        raise ValueError(f"--observer {there}; it is {options.observer}")
    if options.seconds is not None and options.results is None and options.report is None:
        raise ValueError(
            "--seconds is of the sounds in a folder or a page: add --results FOLDER or --report"
            " FILE.html"
        )
    if n_observers and (options.results is not None or options.report is not None):
        from propmdao.analysis.sounds import require_sound

        require_sound(1 if options.results is None else n_observers, _seconds(options))
    require_report(options)
    if options.results is not None:
        require_output_folder("--results", options.results)
        require_matplotlib("--results")


def _seconds(options: argparse.Namespace) -> float:
    return 5.0 if options.seconds is None else float(options.seconds)


def _labels(typed: list[str], propellers: list[Propeller]) -> list[str]:
    """Names of the propellers; as they were typed where two have the same."""
    names = [propeller.name for propeller in propellers]
    labels = [
        text if names.count(name) > 1 else name for text, name in zip(typed, names, strict=True)
    ]
    for label in labels:
        if labels.count(label) > 1:
            raise ValueError(f"{label} is given twice: compare it with another propeller")
    return labels


def _write(
    options: argparse.Namespace, propellers: dict[str, Propeller], compared: ComparedAnalyses
) -> list[str]:
    """Write the folder of results; the files in it, and the page that is written already."""
    page = [] if options.report is None else [str(options.report)]
    if options.results is None:
        return page
    from propmdao.commands.output.results_folder import write_record
    from propmdao.figures.designs.of_comparison import compared_figures

    folder: Path = options.results
    results = list(compared.results.values())
    files = [str(write_record(folder, options, propellers, results=results))]
    files += compared.write_table(folder / "comparison.csv")
    files += save_figures(folder, compared_figures(compared.analyses, compared.observer))
    if compared.observer is not None:
        files += compared.write_sounds(folder, _seconds(options))
    return [*files, *page]

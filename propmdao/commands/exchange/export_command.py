"""Command line: ``propmdao export``."""

from __future__ import annotations

import argparse
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.commands.observer_options import add_observers, listening_of
from propmdao.commands.options import (
    add_asked,
    add_command,
    add_propeller,
    asked_of,
    number,
)
from propmdao.commands.output.output_files import require_output, require_output_folder
from propmdao.commands.output.warning_lines import warning_lines
from propmdao.formats.endings import PROPELLER_WRITERS, STL_UNITS
from propmdao.runtime.terminal import print_line

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller

_FILES = "\n".join(f"  {ending:<10}  {form.contents}" for ending, form in PROPELLER_WRITERS.items())
#: Options without which some files cannot be written, and what they are of.
_NEEDED = {"section": "section", "reynolds": "Reynolds number"}
DESCRIPTION = f"""\
A propeller in a file that other programs read. The ending says which:

{_FILES}
  other       folder of a PSU-WOPWOP case: blade, loads at --rpm or --thrust, observers
"""

EXAMPLES = """\
examples:
  propmdao export apcsf_11x4.7 --to blades.stl --units mm
  propmdao export apcsf_11x4.7 --to propeller.step --hub 30 10
  propmdao export apcsf_11x4.7 --to my_blade.toml
  propmdao export apcsf_11x4.7 --section 0.75 --to section_75.dat
  propmdao export apcsf_11x4.7 --section 0.75 --reynolds 1e5 --to polar_75.txt
  propmdao export apcsf_11x4.7 --rpm 4200 --speed 8 --arc 1.905 -45 0 --to my_case

Axes: z toward thrust, blade 1 along x, rotation from x to y. Exit status: 0, or 2 with one line on
stderr.
"""


def add_export(commands: argparse._SubParsersAction[Any]) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    """
    command = add_command(
        commands,
        "export",
        _export,
        "the blade as STL, TOML, CSV, section coordinates or PSU-WOPWOP case",
        DESCRIPTION,
        EXAMPLES,
    )
    add_propeller(command)
    command.add_argument(
        "--to", type=Path, required=True, metavar="FILE", help="what is written or replaced"
    )
    command.add_argument(
        "--section", type=number, metavar="R_OVER_R", help="r/R of the section in a .dat or .txt"
    )
    command.add_argument(
        "--reynolds", type=number, metavar="RE", help="Reynolds number of the polar in a .txt file"
    )
    command.add_argument(
        "--units", choices=STL_UNITS, help="unit of length of an .stl file, m by default"
    )
    command.add_argument(
        "--hub",
        type=number,
        nargs=2,
        metavar=("DIAMETER", "HEIGHT"),
        help="hub of a .step file [mm], fused with the blades",
    )
    names = ("rpm", "thrust", "speed", "incidence_deg", "density", "twist_offset_deg", "viscous")
    add_asked(command, names, required=False)
    add_observers(command)


def _export(options: argparse.Namespace) -> None:
    path, ending = options.to, options.to.suffix.lower()
    writer = PROPELLER_WRITERS.get(ending)
    driven = options.rpm is not None or options.thrust is not None
    if ending and writer is None and not driven:
        raise ValueError(
            f"--to {path}: there is no export to {ending!r}; a file ends in"
            f" {', '.join(PROPELLER_WRITERS)}, a PSU-WOPWOP case (--rpm, --thrust) in no such"
        )
    takes = () if writer is None else writer.takes
    for name, what in _NEEDED.items():
        if (getattr(options, name) is not None) != (name in takes):
            files = " or ".join(e for e, form in PROPELLER_WRITERS.items() if name in form.takes)
            raise ValueError(f"a {files} file is of one {what}, and only that has --{name}")
    if options.units is not None and "units" not in takes:
        files = " or ".join(e for e, form in PROPELLER_WRITERS.items() if "units" in form.takes)
        raise ValueError(f"--units is of an {files} file: of all else the unit is settled")
    if options.hub is not None and "hub" not in takes:
        raise ValueError("--hub is of a .step file: nothing else has one")
    if writer is not None and driven:
        raise ValueError(f"a {ending} file holds no loads: --rpm and --thrust do not go along")
    if writer is None and not driven:
        raise ValueError("a PSU-WOPWOP case holds loads: it needs --rpm or --thrust")
    if ending:
        require_output("--to", path)
    else:
        require_output_folder("--to", path)
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.formats.propellers import load_propeller
    from propmdao.propeller.changes import Change

    with warning_lines("export"):
        propeller = load_propeller(options.propeller)
    if writer is None:
        _write_case(options, propeller)
        return
    propeller = Change(options.twist_offset_deg).applied_to(propeller)
    unit = options.units or "m"
    arguments = {**vars(options), "units": unit}
    n_items = writer(path, propeller, *[arguments[name] for name in takes])
    lengths = f", {STL_UNITS[unit][0]}" if "units" in takes else ""
    items = writer.items.removesuffix("s") if n_items == 1 else writer.items
    print_line(f"{path}: {propeller.name}, {n_items} {items}{lengths}")


def _write_case(options: argparse.Namespace, propeller: Propeller) -> None:
    listening = listening_of(options)
    if not len(listening.observers):
        raise ValueError("a PSU-WOPWOP case needs observers, as with --arc 1.905 -45")
    from propmdao.analysis.single_point import analyze
    from propmdao.analysis.wopwop.exported_case import write_case

    with warning_lines("export"):
        analysis = analyze(propeller, **asked_of(options), listening=listening)
    write_case(analysis, options.to)
    incidence = analysis.point.incidence_deg
    tilted = f" at an incidence of {incidence:g} deg" if incidence else ""
    n_observers = len(listening.observers)
    print_line(
        f"{options.to}: PSU-WOPWOP case of {propeller.name} at {analysis.rpm:.1f} rpm,"
        f" {analysis.point.speed:g} m/s{tilted}, thrust {float(analysis.loads.thrust):.4g} N,"
        f" {n_observers} observer{'s' if n_observers > 1 else ''}"
    )
    from propmdao.commands import report

    report.print_doubts([analysis.to_dict()])

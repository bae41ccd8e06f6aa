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
from propmdao.commands.warning_lines import warning_lines

if TYPE_CHECKING:
    from propmdao.propeller.description import Propeller

DESCRIPTION = """\
A propeller in a file that other programs read. The ending says which:

  .stl   closed surface of all blades, outward, binary, in metres (no hub)
  .toml  propeller file, as propmdao reads it
  .csv   chord, blade angle, thickness, camber, sweep and rake at the stations
  .dat   section at --section, x and z over chord in Selig's order
  none   folder of a PSU-WOPWOP case: blade, loads at --rpm or --thrust, observers
"""

EXAMPLES = """\
examples:
  propmdao export apcsf_11x4.7 --to blades.stl
  propmdao export apcsf_11x4.7 --to my_blade.toml
  propmdao export apcsf_11x4.7 --section 0.75 --to section_75.dat
  propmdao export apcsf_11x4.7 --rpm 4200 --speed 8 --arc 1.905 -45 0 --to my_case

Axes: z toward thrust, blade 1 along x, rotation from x to y. Exit status: 0, or 2 with one line on
stderr.
"""
_ENDINGS = (".stl", ".toml", ".csv", ".dat")


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
        "--section", type=number, metavar="R_OVER_R", help="where the section of a .dat file is"
    )
    names = ("rpm", "thrust", "speed", "density", "twist_offset_deg", "viscous")
    add_asked(command, names, required=False)
    add_observers(command)


def _export(options: argparse.Namespace) -> None:
    path, ending = options.to, options.to.suffix.lower()
    if ending and ending not in _ENDINGS:
        raise ValueError(
            f"--to {path}: there is no export to {ending!r}; a file ends in"
            f" {', '.join(_ENDINGS)}, a PSU-WOPWOP case in nothing"
        )
    if not path.absolute().parent.is_dir():
        raise ValueError(f"--to {path}: there is no folder {path.parent}")
    if path.is_dir() and ending:
        raise ValueError(f"--to {path}: it is a folder")
    if (options.section is None) == (ending == ".dat"):
        raise ValueError("a .dat file is of one section, and only that has --section R_OVER_R")
    driven = options.rpm is not None or options.thrust is not None
    if ending and driven:
        raise ValueError(f"a {ending} file holds no loads: --rpm and --thrust do not go along")
    if not ending and not driven:
        raise ValueError("a PSU-WOPWOP case holds loads: it needs --rpm or --thrust")
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.formats.propellers import load_propeller
    from propmdao.propeller.changes import Change

    propeller = load_propeller(options.propeller)
    if not ending:
        _write_case(options, propeller)
        return
    propeller = Change(options.twist_offset_deg).applied_to(propeller)
    try:
        said = _write_file(path, ending, propeller, options.section)
    except OSError as error:
        raise ValueError(f"--to {path}: {error.strerror or error}") from None
    print(f"{path}: {propeller.name}, {said}")


def _write_file(path: Path, ending: str, propeller: Propeller, r_over_R: float) -> str:
    """Write a file by its ending; what it holds."""
    from propmdao.formats import blades
    from propmdao.formats.toml_files import write_toml
    from propmdao.records.fidelity import Fidelity

    if ending == ".stl":
        return f"{blades.export_stl(path, propeller, Fidelity())} triangles, metres"
    if ending == ".csv":
        return f"{blades.export_csv(path, propeller)} stations"
    if ending == ".dat":
        return f"{blades.export_section(path, propeller, r_over_R)} points"
    write_toml(path, propeller)
    return f"{propeller.r_over_R.size} stations"


def _write_case(options: argparse.Namespace, propeller: Propeller) -> None:
    listening = listening_of(options)
    if not len(listening.observers):
        raise ValueError("a PSU-WOPWOP case needs observers, as with --arc 1.905 -45")
    from propmdao.analysis.single_point import analyze
    from propmdao.analysis.wopwop_export import write_case

    with warning_lines("export"):
        analysis = analyze(propeller, **asked_of(options), listening=listening)
    write_case(analysis, options.to)
    print(
        f"{options.to}: PSU-WOPWOP case of {propeller.name} at {analysis.rpm:.1f} rpm,"
        f" {analysis.point.speed:g} m/s, thrust {float(analysis.loads.thrust):.4g} N,"
        f" {len(listening.observers)} observers"
    )

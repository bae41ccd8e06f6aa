"""Command line: ``propmdao analyze``."""

from __future__ import annotations

import argparse
import sys
import warnings
from collections.abc import Callable, Sequence
from pathlib import Path
from typing import TYPE_CHECKING, Any

from propmdao.json_output import print_json

if TYPE_CHECKING:
    from propmdao.aerodynamics.polars import PolarTable

DESCRIPTION = """\
Thrust, torque and noise of a propeller in hover (speed 0) or axial flight.

Steady vortex lattice held to the polars of the blade's sections, with a wake carried by the flow it
induces, then tones by Farassat's Formulation 1A: thickness and loading noise of the full blade
surface, heard by observers that fly along. With --broadband also the self-noise of the blades
(Brooks, Pope and Marcolini). The polars that ship are of E63, Clark-Y, their blends and NACA
4-digit sections; others are given with --polar, or made where NeuralFoil is installed.
"""

EXAMPLES = """\
examples:
  propmdao analyze apcsf_11x4.7 --rpm 4200 --speed 8
  propmdao analyze apcsf_11x4.7 --thrust 1.5 --speed 8 --arc 1.905 -45 --broadband
  propmdao analyze my_blade.toml --rpm 3000:5000:500 --arc 1.905 -45 0 45 --json
  propmdao analyze my_blade.toml --rpm 4200 --polar sg6042 sg6042_re50k.txt sg6042_re100k.txt

CT = T/(rho n^2 D^4), CQ = Q/(rho n^2 D^5), CP = 2 pi CQ, J = V/(n D), eta = J CT/CP, n in rev/s.
Levels are in dB re 20 uPa, rms. SI units throughout. Exit status: 0, or 2 with one line on stderr.
"""


def add_analyze(
    commands: argparse._SubParsersAction[Any],
    number: Callable[[str], float],
    number_or_range: Callable[[str], float | list[float]],
    arc: Callable[[list[float]], list[tuple[float, float]]],
) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    number, number_or_range : callable
        Read a number, or a number or range, from a text.
    arc : callable
        Observers of one ``--arc``.
    """
    command = commands.add_parser(
        "analyze",
        help="thrust, torque and noise at given rpm or thrust",
        description=DESCRIPTION,
        epilog=EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    command.set_defaults(command=_analyze, read_arc=arc)
    command.add_argument(
        "propeller",
        metavar="PROPELLER",
        help="name from 'propmdao list', or path of a propeller file (TOML)",
    )
    drive = command.add_mutually_exclusive_group(required=True)
    drive.add_argument(
        "--rpm",
        action="append",
        type=number_or_range,
        metavar="N",
        help="rotation speed [rev/min], or a range START:STOP:STEP that includes STOP; may be"
        " repeated. Ranges and repetition give a list, of one result per value",
    )
    drive.add_argument(
        "--thrust",
        type=number,
        metavar="N",
        help="find the rotation speed that gives this thrust [N]",
    )
    command.add_argument(
        "--speed",
        type=number,
        default=0.0,
        metavar="M_S",
        help="flight speed [m/s], default 0: hover",
    )
    command.add_argument(
        "--rho",
        type=number,
        default=1.225,
        metavar="KG_M3",
        help="air density [kg/m3], default 1.225",
    )
    command.add_argument(
        "--twist-offset",
        type=number,
        default=0.0,
        metavar="DEG",
        help="added to the blade angle everywhere [deg], default 0",
    )
    command.add_argument(
        "--inviscid", action="store_true", help="without the polars of the sections: no drag"
    )
    command.add_argument(
        "--no-stall-delay",
        action="store_true",
        help="let the sections stall as in two dimensions; by default rotation delays it"
        " (Du and Selig)",
    )
    command.add_argument(
        "--polar",
        action="append",
        nargs="+",
        default=[],
        metavar=("AIRFOIL", "FILE"),
        help="polars of an airfoil of the propeller: files of XFOIL or XFLR5, one per Reynolds"
        " number, or one C81 file (ending .c81); may be repeated for other airfoils",
    )
    command.add_argument(
        "--arc",
        action="append",
        nargs="+",
        type=number,
        default=[],
        metavar=("RADIUS", "ELEVATION"),
        help="observers at RADIUS [m] from the hub and each ELEVATION [deg] from the rotor plane,"
        " negative below it (wake side); may be repeated for other radii",
    )
    command.add_argument(
        "--broadband", action="store_true", help="add the broadband self-noise to the tones"
    )
    command.add_argument("--json", action="store_true", help="print JSON instead of tables")


def _analyze(options: argparse.Namespace) -> None:
    observers = [observer for values in options.arc for observer in options.read_arc(values)]
    if options.inviscid and (options.polar or options.no_stall_delay):
        raise ValueError("--inviscid has no sections: --polar and --no-stall-delay do not go along")
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.aerodynamics.polars import polars_for
    from propmdao.analysis import analyze
    from propmdao.propeller import load_propeller

    propeller = load_propeller(options.propeller)
    own = _own_polars(options.polar)
    names = [name for _, name in propeller.airfoils]
    for airfoil in own:
        if airfoil not in [*names, *(Path(name).stem for name in names)]:
            raise ValueError(
                f"--polar {airfoil}: {propeller.name} has no such airfoil; it has"
                f" {', '.join(dict.fromkeys(names))}"
            )
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        polars = None if options.inviscid else polars_for(propeller, own)
        analyses = [
            analyze(
                propeller,
                rpm=rpm,
                thrust=options.thrust,
                speed=options.speed,
                density=options.rho,
                twist_offset_deg=options.twist_offset,
                viscous=not options.inviscid,
                stall_delay=not options.no_stall_delay,
                polars=polars,
                broadband=options.broadband,
                observers=observers,
            ).to_dict()
            for rpm in _rpm_values(options.rpm)
        ]
    for message in dict.fromkeys(str(warning.message) for warning in caught):
        print(f"propmdao analyze: warning: {message}", file=sys.stderr)
    if options.json:
        print_json(analyses if _is_list(options.rpm) else analyses[0])
    else:
        from propmdao import report

        report.print_analyses(propeller, options.twist_offset, analyses)


def _own_polars(given: Sequence[Sequence[str]]) -> dict[str, PolarTable]:
    """Tables of the files of every ``--polar``, by airfoil."""
    from propmdao.aerodynamics.polars import read_c81, read_polars

    tables = {}
    for airfoil, *files in given:
        if not files:
            raise ValueError(f"--polar {airfoil} has no file")
        if airfoil in tables:
            raise ValueError(f"--polar {airfoil} is given twice: name all of its files at once")
        c81 = [file for file in files if file.lower().endswith(".c81")]
        if c81 and len(files) > 1:
            raise ValueError(f"--polar {airfoil}: a C81 file stands alone; there is also {files}")
        tables[airfoil] = read_c81(c81[0]) if c81 else read_polars(*files)
    return tables


def _rpm_values(given: list[float | list[float]] | None) -> list[float | None]:
    """All rpm in the order given; one None where thrust is given instead."""
    if given is None:
        return [None]
    return [rpm for item in given for rpm in (item if isinstance(item, list) else [item])]


def _is_list(given: list[float | list[float]] | None) -> bool:
    return given is not None and (len(given) > 1 or isinstance(given[0], list))

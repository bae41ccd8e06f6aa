"""Command line: ``propmdao list``, ``analyze``, ``sweep`` and ``wopwop``.

Written with argparse because ``--arc RADIUS ELEVATION...`` takes any number of values, negative
ones among them, which parsers that give every option a fixed number of values cannot read.
"""

from __future__ import annotations

import argparse
import contextlib
import json
import math
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import propmdao
from propmdao.sweep_command import add_sweep
from propmdao.wopwop_command import add_wopwop

MAX_RPM_VALUES = 1000

ANALYZE_DESCRIPTION = """\
Thrust, torque and noise of a propeller in hover (speed 0) or axial flight.

Steady vortex lattice with a wake carried by the flow it induces, then tones by Farassat's
Formulation 1A: thickness and loading noise of the full blade surface, heard by observers that fly
along. Not included: viscous drag (torque and power come out low) and broadband noise, so oaspl_dba
is of the tones only.
"""

ANALYZE_EXAMPLES = """\
examples:
  propmdao analyze apcsf_11x4.7 --rpm 4200 --speed 8
  propmdao analyze apcsf_11x4.7 --thrust 1.5 --speed 8 --arc 1.905 -45
  propmdao analyze my_blade.toml --rpm 3000:5000:500 --arc 1.905 -45 0 45 --json

CT = T/(rho n^2 D^4), CQ = Q/(rho n^2 D^5), CP = 2 pi CQ, J = V/(n D), eta = J CT/CP, n in rev/s.
Levels are in dB re 20 uPa, rms. SI units throughout. Exit status: 0, or 2 with one line on stderr.
"""


class _Parser(argparse.ArgumentParser):
    """Parser whose errors are one line, without the usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, f"{self.prog}: error: {message}\n")


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Arguments after the program's name; those of the process by default.

    Returns
    -------
    int
        Exit status: 0, or 2 after one line on stderr about bad input; 130 when interrupted, 1 when
        nobody reads the output any more.
    """
    parser = build_parser()
    options = parser.parse_args(arguments)
    try:
        options.command(options)
        sys.stdout.flush()
    except ValueError as error:
        print(f"{parser.prog} {options.name}: error: {error}", file=sys.stderr)
        return 2
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        # Python flushes stdout once more on exit, which would complain.
        with open(os.devnull, "w") as nowhere, contextlib.suppress(ValueError, OSError):
            os.dup2(nowhere.fileno(), sys.stdout.fileno())
        return 1
    return 0


def build_parser() -> argparse.ArgumentParser:
    """Describe the command line.

    Returns
    -------
    argparse.ArgumentParser
        Parser of everything after the program's name; it leaves with status 2 on bad input.
    """
    parser = _Parser(
        prog="propmdao",
        description="Quieter propellers by design: thrust, torque and noise of a propeller.",
        epilog="'propmdao COMMAND --help' explains a command.",
        allow_abbrev=False,
    )
    parser.add_argument("--version", action="version", version=f"propmdao {propmdao.__version__}")
    commands = parser.add_subparsers(metavar="COMMAND", dest="name", required=True)

    listing = commands.add_parser(
        "list",
        help="the propellers that ship with propmdao",
        description="The propellers that ship with propmdao, by the names that analyze takes.",
        allow_abbrev=False,
    )
    listing.set_defaults(command=_list)
    listing.add_argument("--json", action="store_true", help="print JSON instead of a table")

    analysis = commands.add_parser(
        "analyze",
        help="thrust, torque and noise at given rpm or thrust",
        description=ANALYZE_DESCRIPTION,
        epilog=ANALYZE_EXAMPLES,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    analysis.set_defaults(command=_analyze)
    analysis.add_argument(
        "propeller",
        metavar="PROPELLER",
        help="name from 'propmdao list', or path of a propeller file (TOML)",
    )
    drive = analysis.add_mutually_exclusive_group(required=True)
    drive.add_argument(
        "--rpm",
        action="append",
        type=_rpm,
        metavar="N",
        help="rotation speed [rev/min], or a range START:STOP:STEP that includes STOP; may be"
        " repeated. Ranges and repetition give a list, of one result per value",
    )
    drive.add_argument(
        "--thrust",
        type=_number,
        metavar="N",
        help="find the rotation speed that gives this thrust [N]",
    )
    analysis.add_argument(
        "--speed",
        type=_number,
        default=0.0,
        metavar="M_S",
        help="flight speed [m/s], default 0: hover",
    )
    analysis.add_argument(
        "--rho",
        type=_number,
        default=1.225,
        metavar="KG_M3",
        help="air density [kg/m3], default 1.225",
    )
    analysis.add_argument(
        "--twist-offset",
        type=_number,
        default=0.0,
        metavar="DEG",
        help="added to the blade angle everywhere [deg], default 0",
    )
    analysis.add_argument(
        "--arc",
        action="append",
        nargs="+",
        type=_number,
        default=[],
        metavar=("RADIUS", "ELEVATION"),
        help="observers at RADIUS [m] from the hub and each ELEVATION [deg] from the rotor plane,"
        " negative below it (wake side); may be repeated for other radii",
    )
    analysis.add_argument("--json", action="store_true", help="print JSON instead of tables")
    add_sweep(commands, _number, _rpm, _arc)
    add_wopwop(commands)
    return parser


def _list(options: argparse.Namespace) -> None:
    from propmdao.catalog import catalog_names
    from propmdao.propeller import load_propeller

    propellers = [load_propeller(name) for name in catalog_names()]
    if options.json:
        keys = ("name", "diameter", "n_blades", "source")
        _print_json([{key: getattr(propeller, key) for key in keys} for propeller in propellers])
    else:
        from propmdao import report

        report.print_catalog(propellers)


def _analyze(options: argparse.Namespace) -> None:
    observers = [observer for arc in options.arc for observer in _arc(arc)]
    # Slow to import, so only once the arguments are known to be good.
    from propmdao.analysis import analyze
    from propmdao.propeller import load_propeller

    propeller = load_propeller(options.propeller)
    analyses = [
        analyze(
            propeller,
            rpm=rpm,
            thrust=options.thrust,
            speed=options.speed,
            density=options.rho,
            twist_offset_deg=options.twist_offset,
            observers=observers,
        ).to_dict()
        for rpm in _rpm_values(options.rpm)
    ]
    if options.json:
        _print_json(analyses if _is_sweep(options.rpm) else analyses[0])
    else:
        from propmdao import report

        report.print_analyses(propeller, options.twist_offset, analyses)


def _number(text: str) -> float:
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


def _rpm(text: str) -> float | list[float]:
    """Value of ``--rpm``: a number, or the numbers of a range."""
    if ":" not in text:
        return _number(text)
    parts = text.split(":")
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f"{text!r} is not a range START:STOP:STEP")
    start, stop, step = map(_number, parts)
    if step <= 0.0 or stop < start:
        raise argparse.ArgumentTypeError(
            f"{text!r}: STEP of a range must be positive and STOP not below START"
        )
    # A step that fits the range up to rounding ends on STOP.
    n_steps = math.floor((stop - start) / step * (1.0 + 1e-12))
    if n_steps >= MAX_RPM_VALUES:
        raise argparse.ArgumentTypeError(
            f"{text!r} has {n_steps + 1} values, at most {MAX_RPM_VALUES} are allowed"
        )
    return [start + i * step for i in range(n_steps + 1)]


def _rpm_values(given: list[float | list[float]] | None) -> list[float | None]:
    """All rpm in the order given; one None where thrust is given instead."""
    if given is None:
        return [None]
    return [rpm for item in given for rpm in (item if isinstance(item, list) else [item])]


def _is_sweep(given: list[float | list[float]] | None) -> bool:
    return given is not None and (len(given) > 1 or isinstance(given[0], list))


def _arc(values: list[float]) -> list[tuple[float, float]]:
    """Observers (radius, elevation) of one ``--arc``."""
    if len(values) < 2:
        raise ValueError(
            f"--arc {values[0]:g} has no elevation: it needs a radius and at least one elevation,"
            " as in --arc 1.905 -45 0"
        )
    radius, *elevations = values
    return [(radius, elevation) for elevation in elevations]


def _print_json(value: Any) -> None:
    json.dump(_plain(value), sys.stdout, indent=2, allow_nan=False)
    print()


def _plain(value: Any) -> Any:
    """Copy with null for what JSON has no number for, and 0 for a zero that has a sign."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None
    return value


if __name__ == "__main__":
    sys.exit(main())

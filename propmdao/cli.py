"""Command line: ``propmdao list``, ``analyze``, ``sweep`` and ``wopwop``.

Written with argparse because ``--arc RADIUS ELEVATION...`` takes any number of values, negative
ones among them, which parsers that give every option a fixed number of values cannot read.
"""

from __future__ import annotations

import argparse
import contextlib
import math
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

import propmdao
from propmdao.analyze_command import add_analyze
from propmdao.json_output import print_json
from propmdao.sweep_command import add_sweep
from propmdao.wopwop_command import add_wopwop

MAX_RPM_VALUES = 1000


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

    add_analyze(commands, _number, _rpm, _arc)
    add_sweep(commands, _number, _rpm, _arc)
    add_wopwop(commands)
    return parser


def _list(options: argparse.Namespace) -> None:
    from propmdao.catalog import catalog_names
    from propmdao.propeller import load_propeller

    propellers = [load_propeller(name) for name in catalog_names()]
    if options.json:
        keys = ("name", "diameter", "n_blades", "source")
        print_json([{key: getattr(propeller, key) for key in keys} for propeller in propellers])
    else:
        from propmdao import report

        report.print_catalog(propellers)


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


def _arc(values: list[float]) -> list[tuple[float, float]]:
    """Observers (radius, elevation) of one ``--arc``."""
    if len(values) < 2:
        raise ValueError(
            f"--arc {values[0]:g} has no elevation: it needs a radius and at least one elevation,"
            " as in --arc 1.905 -45 0"
        )
    radius, *elevations = values
    return [(radius, elevation) for elevation in elevations]


if __name__ == "__main__":
    sys.exit(main())

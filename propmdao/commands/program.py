"""Command line: ``propmdao list`` and the commands that have files of their own.

Written with argparse because ``--arc RADIUS ELEVATION...`` takes any number of values, negative
ones among them, which parsers that give every option a fixed number of values cannot read.
"""

from __future__ import annotations

import argparse
import contextlib
import os
import sys
from collections.abc import Sequence
from typing import NoReturn

import propmdao
from propmdao.commands.analyze_command import add_analyze
from propmdao.commands.export_command import add_export
from propmdao.commands.flyover_command import add_flyover
from propmdao.commands.json_output import print_json
from propmdao.commands.sweep_command import add_sweep
from propmdao.commands.wopwop_command import add_wopwop


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

    add_analyze(commands)
    add_sweep(commands)
    add_flyover(commands)
    add_export(commands)
    add_wopwop(commands)
    return parser


def _list(options: argparse.Namespace) -> None:
    from propmdao.formats.propellers import load_propeller
    from propmdao.propeller.catalog import catalog_names

    propellers = [load_propeller(name) for name in catalog_names()]
    if options.json:
        keys = ("name", "diameter", "n_blades", "source")
        print_json([{key: getattr(propeller, key) for key in keys} for propeller in propellers])
    else:
        from propmdao.commands import report

        report.print_catalog(propellers)

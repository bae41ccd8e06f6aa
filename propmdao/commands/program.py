"""The command line: all commands, and what becomes of errors.

Written with argparse because ``--arc RADIUS ELEVATION...`` takes any number of values, negative
ones among them, which parsers that give every option a fixed number of values cannot read.
"""

from __future__ import annotations

import argparse
import atexit
import contextlib
import gc
import io
import os
import sys
from collections.abc import Sequence
from typing import Any, NoReturn

import propmdao
from propmdao.commands.analyze_command import add_analyze
from propmdao.commands.designs.bench_command import add_bench
from propmdao.commands.designs.compare_command import add_compare
from propmdao.commands.designs.optimise_command import add_optimise
from propmdao.commands.exchange.export_command import add_export
from propmdao.commands.exchange.wopwop_command import add_wopwop
from propmdao.commands.flyover_command import add_flyover
from propmdao.commands.inventory.catalogue_command import add_list, add_show
from propmdao.commands.inventory.completion_command import add_completion
from propmdao.commands.inventory.doctor_command import add_doctor
from propmdao.commands.inventory.warm_up_command import add_warm_up
from propmdao.commands.output.progress import tell_progress, telling_of_compilation
from propmdao.commands.sweep_command import add_sweep
from propmdao.runtime.caches import keep_programs
from propmdao.runtime.output_files import reason_of
from propmdao.runtime.terminal import print_line, printable


class _Parser(argparse.ArgumentParser):
    """Parser whose errors are one line, without the usage."""

    def error(self, message: str) -> NoReturn:
        self.exit(2, printable(f"{self.prog}: error: {message}") + "\n")

    def _print_message(self, message: str, file: Any = None) -> None:
        """Print help; argparse itself says nothing when it cannot be written."""
        if file is sys.stdout:
            file.write(message)
        else:
            super()._print_message(message, file)


def main(arguments: Sequence[str] | None = None) -> int:
    """Run the command line.

    Parameters
    ----------
    arguments : sequence of str, optional
        Arguments after the program's name; those of the process by default.

    Returns
    -------
    int
        Exit status: 0, or 2 after one line on stderr about bad input or output that cannot be
        written; 130 when interrupted, 1 when nobody reads the output any more.
    """
    if arguments is None:  # a process of its own
        keep_programs()
        _collect_seldom()
    parser = build_parser()
    name = parser.prog
    if sys.stdout is None:  # closed by who started the program
        return _refuse(name, "standard output is closed")
    for stream in (sys.stdout, sys.stderr):
        if isinstance(stream, io.TextIOWrapper):  # a name may hold what its encoding does not
            stream.reconfigure(errors="backslashreplace")
    try:
        try:
            options = parser.parse_args(arguments)
            name = f"{parser.prog} {options.name}"
            tell_progress(getattr(options, "quiet", False))
            options.arguments = sys.argv[1:] if arguments is None else list(arguments)
            with telling_of_compilation(name):
                options.command(options)
        finally:  # here, where its errors are caught: also after --help
            sys.stdout.flush()
    except ValueError as error:
        return _refuse(name, str(error))
    except KeyboardInterrupt:
        return 130
    except BrokenPipeError:
        _drop_output()
        return 1
    except OSError as error:
        _drop_output()
        place = "output" if error.filename is None else f"{error.filename}:"
        return _refuse(name, f"{place} cannot be written: {reason_of(error)}")
    return 0


def _collect_seldom() -> None:
    """Look for unused objects after 20,000 new ones, not 700, and not at the end of the process.

    Imports and tracing make a great many objects that stay: looking through them again and again
    takes a sixth of the time of a short command.
    """
    gc.set_threshold(20_000, 50, 10)
    atexit.register(gc.freeze)


def _refuse(name: str, reason: str) -> int:
    """Say in one line on stderr what is wrong; the exit status."""
    with contextlib.suppress(OSError):  # then there is nobody to tell
        print_line(f"{name}: error: {reason}", error=True)
    return 2


def _drop_output() -> None:
    """Send what is still to be printed nowhere: Python tries once more on exit, and complains."""
    with open(os.devnull, "w") as nowhere, contextlib.suppress(ValueError, OSError):
        os.dup2(nowhere.fileno(), sys.stdout.fileno())


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

    add_list(commands)
    add_show(commands)
    add_analyze(commands)
    add_compare(commands)
    add_optimise(commands)
    add_bench(commands)
    add_sweep(commands)
    add_flyover(commands)
    add_export(commands)
    add_wopwop(commands)
    add_doctor(commands)
    add_warm_up(commands)
    add_completion(commands, build_parser)
    return parser

"""What commands share: how they are set up, the propeller, its operating point, values."""

from __future__ import annotations

import argparse
import math
import re
from collections.abc import Callable, Iterable
from typing import Any

from propmdao.formats.endings import PROPELLER_READERS, described
from propmdao.records.quantities import ASKED

MOST_VALUES = 1000
#: Turbulence that flows in, of commands with broadband noise.
TURBULENCE_OPTIONS = ("turbulence_intensity", "turbulence_length_scale")


def add_command(
    commands: argparse._SubParsersAction[Any],
    name: str,
    run: Callable[[argparse.Namespace], None],
    summary: str,
    description: str,
    examples: str,
) -> argparse.ArgumentParser:
    """Add a command to the program.

    Parameters
    ----------
    commands : argparse subparsers
        Commands of the program.
    name : str
        Name of the command, as it is typed.
    run : callable
        Function of the arguments that were typed; raises ValueError on bad input.
    summary : str
        Line of the command in the help of the program.
    description, examples : str
        Help of the command, before and after the options, with the line breaks as they are.

    Returns
    -------
    argparse.ArgumentParser
        Parser to add arguments to; values such as -2:4:0.5 may follow its options.
    """
    command = commands.add_parser(
        name,
        help=summary,
        description=description,
        epilog=examples,
        formatter_class=argparse.RawDescriptionHelpFormatter,
        allow_abbrev=False,
    )
    take_negative_ranges(command)
    command.add_argument(
        "--quiet", action="store_true", help="without progress on stderr; warnings are said"
    )
    command.set_defaults(command=run)
    return command


def number(text: str) -> float:
    """Value of an option that is a number.

    Parameters
    ----------
    text : str
        As typed.

    Returns
    -------
    float
        Finite.

    Raises
    ------
    argparse.ArgumentTypeError
        When it is none.
    """
    try:
        value = float(text)
    except ValueError:
        value = math.nan
    if not math.isfinite(value):
        raise argparse.ArgumentTypeError(f"{text!r} is not a number")
    return value


def number_or_range(text: str) -> float | list[float]:
    """Value of an option that is a number or a range.

    Parameters
    ----------
    text : str
        As typed; a range is START:STOP:STEP.

    Returns
    -------
    float or list of float
        The number, or the numbers of the range, STOP among them.

    Raises
    ------
    argparse.ArgumentTypeError
        When it is neither.
    """
    if ":" not in text:
        return number(text)
    parts = text.split(":")
    if len(parts) != 3:
        raise argparse.ArgumentTypeError(f"{text!r} is not a range START:STOP:STEP")
    start, stop, step = map(number, parts)
    if step <= 0.0 or stop < start:
        raise argparse.ArgumentTypeError(
            f"{text!r}: STEP of a range must be positive and STOP not below START"
        )
    # A step that fits the range up to rounding ends on STOP.
    n_steps = (stop - start) / step * (1.0 + 1e-12)  # which may be infinite
    if n_steps >= MOST_VALUES:
        raise argparse.ArgumentTypeError(
            f"{text!r} has more than the {MOST_VALUES} values that are allowed"
        )
    return [start + i * step for i in range(math.floor(n_steps) + 1)]


def take_negative_ranges(command: argparse.ArgumentParser) -> None:
    """Let values such as -2:4:0.5 follow options.

    Parameters
    ----------
    command : argparse parser
        Parser of a command. argparse takes -2 for a value and -2:4:0.5 for an option that it does
        not know.
    """
    command._negative_number_matcher = re.compile(r"-\.?\d")


def add_propeller(command: argparse.ArgumentParser) -> None:
    """Add the propeller that a command is about.

    Parameters
    ----------
    command : argparse parser
        What it is added to.
    """
    command.add_argument(
        "propeller",
        metavar="PROPELLER",
        help=f"name from 'propmdao list', or path of a file: {described(PROPELLER_READERS)}",
    )


def add_asked(
    command: argparse._ActionsContainer,
    names: Iterable[str],
    several_rpm: bool = False,
    required: bool = True,
) -> None:
    """Add options for what may be asked, as the table of quantities has them.

    Parameters
    ----------
    command : argparse parser or group
        What they are added to; `asked_of` reads them.
    names : iterable of str
        Names in the table.
    several_rpm : bool
        Whether there may be ranges and several values of rpm: then it is a list of both.
    required : bool
        Whether rpm or thrust has to be given, where they are among the names.
    """
    drive: argparse._ActionsContainer | None = None
    for name in names:
        quantity = ASKED[name]
        parser, settings = command, dict[str, Any](dest=name, default=quantity.default)
        text = quantity.help
        if name in ("rpm", "thrust"):
            drive = drive or command.add_mutually_exclusive_group(required=required)
            parser = drive
        if not quantity.placeholder:
            settings |= {"action": "store_const", "const": not quantity.default}
        elif quantity.placeholder.startswith("{"):
            settings["choices"] = quantity.placeholder.strip("{}").split(",")
        else:
            settings |= {"metavar": quantity.placeholder, "type": number}
        if name == "rpm" and several_rpm:
            settings |= {"type": number_or_range, "action": "append"}
            text += (
                ", or a range START:STOP:STEP that includes STOP; may be repeated. Ranges and"
                " repetition give a list, of one result per value"
            )
        parser.add_argument(quantity.option, help=text, **settings)


def asked_of(options: argparse.Namespace) -> dict[str, Any]:
    """Values of all options of `add_asked` that a command has.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Returns
    -------
    dict
        By the names of `propmdao.analyze`.
    """
    return {name: getattr(options, name) for name in ASKED if hasattr(options, name)}

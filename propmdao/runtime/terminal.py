"""Text on a terminal: what files and users call things is shown, never obeyed."""

from __future__ import annotations

import sys
from typing import TYPE_CHECKING

if TYPE_CHECKING:
    from rich.console import Console


def printable(text: object) -> str:
    """Show text on one line without anything that a terminal would act on.

    Parameters
    ----------
    text : object
        Text, or what has one.

    Returns
    -------
    str
        The text; line breaks, escape sequences, marks that turn the direction of writing and all
        else that is no printable character are written as in Python's strings.
    """
    return "".join(
        character if character.isprintable() else character.encode("unicode_escape").decode()
        for character in str(text)
    )


def print_line(text: object, *, error: bool = False) -> None:
    """Print text as `printable` has it, on a line of its own.

    Parameters
    ----------
    text : object
        Text, or what has one.
    error : bool
        Whether it goes to standard error, not to standard output. A stream that is closed gets
        nothing.
    """
    stream = sys.stderr if error else sys.stdout
    if stream is not None:
        print(printable(text), file=stream)


def plain_console() -> Console:
    """Console for tables, on standard output, to which brackets and colons mean nothing.

    Returns
    -------
    rich.console.Console
        Console that takes "[bold]" and ":smile:" for the text that they are. Text of users still
        has to pass `printable`.
    """
    from rich.console import Console  # slow to import, and not needed for a line

    return Console(markup=False, emoji=False)

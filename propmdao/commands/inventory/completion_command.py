"""Command line: ``propmdao completion``."""

from __future__ import annotations

import argparse
import importlib.util
from collections.abc import Callable
from typing import Any

from propmdao.commands.options import add_command

SHELLS = ("bash", "zsh", "tcsh")
DESCRIPTION = """\
Words for the shell, so that the tab key completes commands and options: a script on standard
output. Needs shtab: pip install 'propmdao[completion]'.
"""
EXAMPLES = """\
examples:
  propmdao completion bash > ~/.local/share/bash-completion/completions/propmdao
  propmdao completion zsh > ~/.zfunc/_propmdao

Exit status: 0, or 2 with one line on stderr.
"""


def add_completion(
    commands: argparse._SubParsersAction[Any], parser: Callable[[], argparse.ArgumentParser]
) -> None:
    """Add the command to a command line.

    Parameters
    ----------
    commands : argparse subparsers
        What it is added to.
    parser : callable
        Function that makes the parser of the whole command line.
    """

    def write(options: argparse.Namespace) -> None:
        if importlib.util.find_spec("shtab") is None:
            raise ValueError("completion needs shtab: pip install 'propmdao[completion]'")
        shtab: Any = importlib.import_module("shtab")
        print(shtab.complete(parser(), shell=options.shell))

    command = add_command(
        commands, "completion", write, "a script that completes words in the shell",
        DESCRIPTION, EXAMPLES,
    )  # fmt: skip
    command.add_argument("shell", choices=SHELLS, help="shell that the script is for")

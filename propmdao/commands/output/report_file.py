"""The option ``--report``: results as a page for the browser."""

from __future__ import annotations

import argparse
import datetime
import importlib.util
import shlex
from collections.abc import Sequence
from pathlib import Path
from typing import TYPE_CHECKING

from propmdao.commands.output.output_files import require_output

if TYPE_CHECKING:
    from propmdao.figures.pages.parts import Origin, Page

_LIBRARIES = ("jinja2", "plotly")


def add_report(command: argparse._ActionsContainer, contents: str) -> None:
    """Add the option.

    Parameters
    ----------
    command : argparse parser or group
        What it is added to.
    contents : str
        What the page holds, for the help.
    """
    command.add_argument(
        "--report",
        type=Path,
        metavar="FILE.html",
        help=f"a page for the browser, one file that needs no network: {contents}",
    )


def require_report(options: argparse.Namespace) -> None:
    """Refuse a report that cannot be written, before the work.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed.

    Raises
    ------
    ValueError
        If the file cannot be written, or what the page is made with is not installed.
    """
    if options.report is None:
        return
    require_output("--report", options.report, ".html")
    if not all(map(importlib.util.find_spec, _LIBRARIES)):
        raise ValueError("--report needs Jinja and Plotly: pip install 'propmdao[report]'")


def origin_of(options: argparse.Namespace, warnings: Sequence[str] = ()) -> Origin:
    """Where the numbers of a page come from.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed, with the `arguments`.
    warnings : sequence of str
        What was warned of on the way.

    Returns
    -------
    Origin
        Command, time, versions, warnings.
    """
    from propmdao.commands.output.results_folder import versions
    from propmdao.figures.pages.parts import Origin

    return Origin(
        shlex.join(["propmdao", *options.arguments]),
        f"{datetime.datetime.now(datetime.UTC):%Y-%m-%d %H:%M} UTC",
        versions(),
        tuple(warnings),
    )


def write_report(options: argparse.Namespace, page: Page) -> str:
    """Write a page.

    Parameters
    ----------
    options : argparse.Namespace
        What was typed, with the file.
    page : Page
        The page.

    Returns
    -------
    str
        The file.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    from propmdao.figures.pages.rendering import write_page  # needs Jinja and Plotly

    write_page(options.report, page)
    return str(options.report)

"""Directives of the site: what pages take from the program, so that they cannot differ from it."""

from __future__ import annotations

import argparse
from typing import Any
from unittest import mock

from docutils import nodes
from docutils.parsers.rst import Directive
from sphinx.application import Sphinx

from propmdao.commands.program import build_parser
from propmdao.formats import endings

HELP_COLUMNS = "88"


def commands() -> dict[str, argparse.ArgumentParser]:
    """Parsers of the commands.

    Returns
    -------
    dict of str to argparse.ArgumentParser
        By name, in the order of the program's help.
    """
    (choices,) = (a for a in build_parser()._actions if isinstance(a, argparse._SubParsersAction))
    return dict(choices.choices)


class FileFormats(Directive):
    """Formats of one of the tables of `propmdao.formats.endings`, a row for each."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Table of the formats.

        Returns
        -------
        list of nodes.Node
            One table.
        """
        formats = getattr(endings, self.arguments[0])
        rows = [(ending or "any other", form.contents) for ending, form in formats.items()]
        group = nodes.tgroup("", *(nodes.colspec(colwidth=w) for w in (1, 4)), cols=2)
        group += nodes.thead("", _row(("ending", "contents")))
        group += nodes.tbody("", *map(_row, rows))
        return [nodes.table("", group)]


def _row(cells: tuple[str, ...]) -> nodes.row:
    return nodes.row("", *(nodes.entry("", nodes.paragraph(text=text)) for text in cells))


class CommandHelp(Directive):
    """Help of every command as it is printed, a section for each."""

    def run(self) -> list[nodes.Node]:
        """Sections of the page.

        Returns
        -------
        list of nodes.Node
            One for each command.
        """
        sections: list[nodes.Node] = []
        for name, parser in commands().items():
            section = nodes.section(ids=[f"propmdao-{name}"], names=[f"propmdao {name}"])
            section += nodes.title(text=f"propmdao {name}")
            with mock.patch.dict("os.environ", COLUMNS=HELP_COLUMNS):
                text = parser.format_help()
            section += nodes.literal_block(text, text, language="text")
            sections.append(section)
        return sections


def setup(app: Sphinx) -> dict[str, Any]:
    """Add the directives to Sphinx."""
    app.add_directive("command-help", CommandHelp)
    app.add_directive("file-formats", FileFormats)
    return {"parallel_read_safe": True, "parallel_write_safe": True}

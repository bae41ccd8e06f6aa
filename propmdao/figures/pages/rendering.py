"""Pages as HTML: one file that opens without a network and runs no script but its own two.

Text is escaped by Jinja, data by its JSON filter. The page's policy names the hashes of its script
and of Plotly, so that a browser runs no other, and nothing is loaded from anywhere.
"""

from __future__ import annotations

import base64
import functools
import gzip
import hashlib
from collections.abc import Sequence
from importlib.resources import files
from pathlib import Path

from jinja2 import Environment, PackageLoader, StrictUndefined
from plotly.offline import get_plotlyjs

from propmdao.figures.pages.parts import Figure, Page, Panel, Section
from propmdao.runtime.output_files import replacing


def write_page(path: Path, page: Page) -> None:
    """Write a page as a file.

    Parameters
    ----------
    path : Path
        HTML file to write or replace.
    page : Page
        The page.

    Raises
    ------
    OutputError
        If the file cannot be written.
    """
    with replacing(path) as file:
        file.write_text(html(page), encoding="utf-8", newline="\n")


def html(page: Page) -> str:
    """Lay out a page.

    Parameters
    ----------
    page : Page
        The page.

    Returns
    -------
    str
        Text of the HTML file.

    Raises
    ------
    ValueError
        If a number of a figure is none.
    """
    environment = Environment(
        loader=PackageLoader("propmdao.figures.pages"),
        autoescape=True,
        undefined=StrictUndefined,
        trim_blocks=True,
        lstrip_blocks=True,
    )
    environment.policies["json.dumps_kwargs"] = {"allow_nan": False, "separators": (",", ":")}
    environment.filters["base64"] = lambda content: base64.b64encode(content).decode()
    own, style = (_own_file(name) for name in ("page.js", "page.css"))
    panels = _panels(page.sections)
    numbers = {id(panel): number for number, panel in enumerate(panels)}
    packed, plotly_hash = _plotly()
    return environment.get_template("page.html").render(
        page=page,
        number_of=lambda panel: numbers[id(panel)],
        figures=[{"data": panel.data, "layout": panel.layout} for panel in panels],
        script=own,
        style=style,
        plotly=packed,
        hashes=[_hash(own), plotly_hash],
    )


def _own_file(name: str) -> str:
    return (files("propmdao.figures.pages") / "templates" / name).read_text(encoding="utf-8")


@functools.cache
def _plotly() -> tuple[str, str]:
    """Plotly, packed, and its hash."""
    # Line ends as browsers read them, of which the hash is taken.
    script = get_plotlyjs().replace("\r\n", "\n").replace("\r", "\n")
    packed = gzip.compress(script.encode(), 9, mtime=0)
    return base64.b64encode(packed).decode(), _hash(script)


def _hash(script: str) -> str:
    """Hash of a script as the policy of a page names it."""
    return "sha256-" + base64.b64encode(hashlib.sha256(script.encode()).digest()).decode()


def _panels(sections: Sequence[Section]) -> list[Panel]:
    """All diagrams in the order of the page."""
    return [
        panel
        for section in sections
        for part in section.parts
        if isinstance(part, Figure)
        for panels in part.panels.values()
        for panel in panels
    ]

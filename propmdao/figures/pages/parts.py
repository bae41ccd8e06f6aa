"""What a page is made of: sections of tables, figures and players."""

from __future__ import annotations

import dataclasses
from collections.abc import Mapping, Sequence
from typing import Any, ClassVar


@dataclasses.dataclass(frozen=True)
class Table:
    """Rows of text.

    Attributes
    ----------
    caption : str
        Caption, above the table.
    head : sequence of str
        Heads of the columns.
    rows : sequence of sequence of str
        Cells of each row; a row that has text in its first cell alone is a heading within the
        table.
    n_words : int
        Leading columns that hold words; numbers stand to the right.
    """

    kind: ClassVar[str] = "table"
    caption: str
    head: Sequence[str]
    rows: Sequence[Sequence[str]]
    n_words: int = 1


@dataclasses.dataclass(frozen=True)
class Panel:
    """A diagram.

    Attributes
    ----------
    label : str
        Name, above the diagram.
    data : list of dict
        Traces, as Plotly has them.
    layout : dict
        Layout, as Plotly has it.
    """

    label: str
    data: list[dict[str, Any]]
    layout: dict[str, Any]

    @property
    def is_space(self) -> bool:
        """Whether it is a body in space, to be turned around."""
        return "scene" in self.layout


@dataclasses.dataclass(frozen=True)
class Figure:
    """Diagrams that belong together.

    Attributes
    ----------
    title : str
        Title.
    alternative : str
        What is to be seen, in words, for who does not see it.
    panels : mapping of str to sequence of Panel
        Diagrams by the word with which they are chosen, the first of which is shown; where there
        is one, nothing is to be chosen.
    choice : str
        Name of what is chosen.
    note : str
        Sentence below the diagrams.
    """

    kind: ClassVar[str] = "figure"
    title: str
    alternative: str
    panels: Mapping[str, Sequence[Panel]]
    choice: str = ""
    note: str = ""


@dataclasses.dataclass(frozen=True)
class Player:
    """A sound.

    Attributes
    ----------
    label : str
        Name.
    detail : str
        Words on what is heard.
    flac : bytes
        The sound, as a file of FLAC.
    repeats : bool
        Whether it is made to be repeated without a click.
    """

    kind: ClassVar[str] = "player"
    label: str
    detail: str
    flac: bytes
    repeats: bool = True


@dataclasses.dataclass(frozen=True)
class Section:
    """A part of a page with a heading.

    Attributes
    ----------
    heading : str
        Heading.
    parts : sequence of Table, Figure or Player
        Contents, in their order.
    notes : sequence of str
        Sentences below the heading.
    """

    heading: str
    parts: Sequence[Table | Figure | Player]
    notes: Sequence[str] = ()


@dataclasses.dataclass(frozen=True)
class Origin:
    """Where the numbers of a page come from.

    Attributes
    ----------
    command : str
        What was typed.
    written : str
        Time at which the page is written.
    versions : mapping of str to str
        Versions by the name of the program or library.
    warnings : sequence of str
        What was warned of on the way.
    """

    command: str
    written: str
    versions: Mapping[str, str]
    warnings: Sequence[str] = ()


@dataclasses.dataclass(frozen=True)
class Page:
    """A page.

    Attributes
    ----------
    title : str
        Title.
    subtitle : str
        Line below it: what was asked.
    doubts : sequence of str
        What keeps the numbers from being used.
    numbers : mapping of str to str
        The first numbers that are read, with their units, by name.
    sections : sequence of Section
        Contents.
    origin : Origin
        Where the numbers come from.
    """

    title: str
    subtitle: str
    doubts: Sequence[str]
    numbers: Mapping[str, str]
    sections: Sequence[Section]
    origin: Origin

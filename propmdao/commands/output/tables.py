"""Tables on a terminal, and the numbers in their cells."""

from __future__ import annotations

from rich import box
from rich.table import Table


def narrow_table(padding: int = 1) -> Table:
    """Make an empty table that takes little of a terminal.

    Parameters
    ----------
    padding : int
        Blanks between columns, on either side.

    Returns
    -------
    Table
        Without columns.
    """
    return Table(box=box.SIMPLE, pad_edge=False, collapse_padding=True, padding=(0, padding))


def number_cell(value: float, form: str) -> str:
    """Text of a number.

    Parameters
    ----------
    value : float
        The number; a zero that has a sign is still zero.
    form : str
        Format.

    Returns
    -------
    str
        The number in the format.
    """
    return format(value + 0.0, form)


def level_cell(value: float, form: str = ".1f") -> str:
    """Text of a level.

    Parameters
    ----------
    value : float
        Level [dB].
    form : str
        Format.

    Returns
    -------
    str
        The level, or a dash for silence, which is -200 dB.
    """
    return number_cell(value, form) if value > -199.0 else "-"

"""Write the nomenclature of docs/conventions.md from the table of quantities."""

import dataclasses
import re
from pathlib import Path

from propmdao.records.quantities import (
    ASKED,
    BROADBAND_LEVELS,
    HUB_LOADS,
    LEVELS,
    MOTOR,
    MOTOR_RESULTS,
    RESULTS,
)
from propmdao.records.units import Quantity, Range

PAGE = Path(__file__).with_name("conventions.md")
HEADS = ("name", "unit", "default", "range", "meaning", "JSON, column", "component", "option")


def table() -> str:
    """Nomenclature as a Markdown table.

    Returns
    -------
    str
        A line for each quantity: what may be asked, what is found, levels at an observer.
    """
    parts = {
        "**asked**": ASKED,
        "**found**": RESULTS | HUB_LOADS,
        "**motor and battery**": MOTOR | MOTOR_RESULTS,
        "**levels**": LEVELS | BROADBAND_LEVELS,
    }
    rows = [HEADS, ("---",) * len(HEADS)]
    for title, quantities in parts.items():
        rows.append((title, *[""] * (len(HEADS) - 1)))
        rows += [_row(quantity) for quantity in quantities.values()]
    return "\n".join(f"| {' | '.join(row)} |" for row in rows)


def _row(quantity: Quantity) -> tuple[str, ...]:
    default = "" if quantity.default is None else f"`{quantity.default}`"
    return (
        f"`{quantity.name}`",
        quantity.unit,
        default,
        _range(quantity.allowed),
        quantity.meaning,
        _columns(quantity),
        f"`{quantity.variable}`" if quantity.variable != quantity.name else "",
        f"`{quantity.option}`" if quantity.option else "",
    )


def _columns(quantity: Quantity) -> str:
    """Key in JSON where it is not the name, and columns of tables where they are not the key."""
    names = [quantity.json] if quantity.json != quantity.name else []
    names += [name for name in quantity.columns if quantity.axes]
    return ", ".join(f"`{name}`" for name in names)


def _range(allowed: Range | None) -> str:
    """Range of a number; its unit has a column of its own, as OpenMDAO writes it."""
    return (
        "" if allowed is None else str(dataclasses.replace(allowed, unit="")).replace("within ", "")
    )


def page(text: str) -> str:
    """Page with the table as it is now.

    Parameters
    ----------
    text : str
        The page as it stands.

    Returns
    -------
    str
        The page with a new table between its marks.
    """
    start, end = "<!-- table: nomenclature -->", "<!-- end of table -->"
    return re.sub(f"{start}.*?{end}", lambda _: f"{start}\n{table()}\n{end}", text, flags=re.S)


if __name__ == "__main__":
    PAGE.write_text(page(PAGE.read_text(encoding="utf-8")), encoding="utf-8")

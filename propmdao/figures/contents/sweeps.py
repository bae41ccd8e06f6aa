"""What varies in a sweep, and what is drawn of it."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

from propmdao.records.quantities import VARIABLES

#: What is drawn, by column, with its label.
SHOWN = {"CT": "CT", "CP": "CP", "eta": "efficiency", "figure_of_merit": "figure of merit"}
#: What a map shows from 0 on: a rotor that brakes is of no use, however much it brakes.
OF_USE = ("eta", "figure_of_merit")


def varied_columns(points: Sequence[Mapping[str, float]]) -> tuple[str, ...]:
    """Columns that have more than one value, those with most values first.

    Parameters
    ----------
    points : sequence of dict
        Values of a sweep's variables.

    Returns
    -------
    tuple of str
        Columns of `VARIABLES`, one or two.

    Raises
    ------
    ValueError
        If nothing varies, more than two do, or two are not every combination of their values.
    """
    values = {
        name: {point[name] for point in points if name in point}
        for name in VARIABLES
        if any(name in point for point in points)
    }
    varied = sorted((n for n in values if len(values[n]) > 1), key=lambda n: -len(values[n]))
    if len(varied) not in (1, 2):
        raise ValueError(
            f"figures of a sweep are over one or two variables; {len(varied)} vary"
            + (f": {', '.join(varied)}" if varied else "")
        )
    if len(varied) == 2 and len(points) != len(values[varied[0]]) * len(values[varied[1]]):
        raise ValueError(
            f"figures of a sweep over {varied[0]} and {varied[1]} need every combination of their"
            " values"
        )
    return tuple(varied)


def column_label(column: str) -> str:
    """Name of a variable with its unit.

    Parameters
    ----------
    column : str
        Column of `VARIABLES`.

    Returns
    -------
    str
        The words.
    """
    quantity = VARIABLES[column]
    name = quantity.meaning.split(",")[0]
    return f"{name}, {quantity.unit}" if quantity.unit else name

"""Quantities that users give: what they are, the ranges they have to be in, units computed in."""

from __future__ import annotations

import dataclasses
import math
import reprlib
from typing import Any

#: One revolution per minute [rad/s].
RAD_PER_S = math.pi / 30.0


@dataclasses.dataclass(frozen=True)
class Range:
    """Values that a number may have: wide, but such that something of the kind can exist.

    Attributes
    ----------
    lowest, highest : float
        Ends of the range, which belong to it.
    unit : str
        Unit of the number, as messages have it; empty where there is none.
    or_zero : bool
        Whether 0, which is below the range, is allowed beside it.
    """

    lowest: float
    highest: float
    unit: str = ""
    or_zero: bool = False

    def __str__(self) -> str:
        """Describe the range in words that follow "must be"."""
        zero = "0 or " if self.or_zero else ""
        unit = f" {self.unit}" if self.unit else ""
        return f"{zero}within {self.lowest:.10g} ... {self.highest:.10g}{unit}"

    def __contains__(self, value: float) -> bool:
        """Whether a number is allowed; what is no number is not."""
        return self.lowest <= value <= self.highest or (self.or_zero and value == 0.0)

    def require(self, name: str, value: Any, error: type[ValueError] = ValueError) -> None:
        """Refuse a value that is not in the range.

        Parameters
        ----------
        name : str
            Name of the value in the message.
        value : float
            The value.
        error : type
            Exception that is raised, a ValueError.

        Raises
        ------
        ValueError
            If the value is no number or outside the range; an exception of the type `error`.
        """
        try:
            number = float(value)
            if isinstance(value, str | bytes):
                raise TypeError
        except (TypeError, ValueError):
            raise error(f"{name} must be a number; it is {reprlib.repr(value)}") from None
        except OverflowError:  # a whole number of hundreds of digits
            number = math.inf
        if number not in self:
            raise error(f"{name} must be {self}; it is {number:.10g}")


@dataclasses.dataclass(frozen=True)
class Quantity:
    """A quantity and its names.

    Attributes
    ----------
    name : str
        Name in Python and of the variable of a component.
    unit : str
        Unit as OpenMDAO writes it; empty where there is none.
    meaning : str
        Meaning of the quantity, one line.
    record : str
        Record of the request that holds the quantity, as a dotted path; empty for a result.
    default : object
        Value where the user gives none; None where the propeller or another quantity decides.
    json : str
        Key in JSON and column in tables; by default the name.
    variable : str
        Name in OpenMDAO; by default the name.
    per_node : bool
        Whether the quantity belongs to an operating point, and so has the axis of nodes in
        components.
    option : str
        Option of the command line; empty where there is none. A switch turns the default over.
    placeholder : str
        Word that stands for the value of the option in its help; empty for a switch.
    help : str
        Help of the option; by default the meaning with the unit.
    allowed : Range or None
        Values that are allowed; None for words, switches and results.
    axes : tuple of str
        Axes of a vector's components; empty for a number. In JSON and components a vector is a
        list, in tables a column for each axis.
    """

    name: str
    unit: str
    meaning: str
    record: str = ""
    default: Any = None
    json: str = ""
    variable: str = ""
    per_node: bool = True
    option: str = ""
    placeholder: str = ""
    help: str = ""
    allowed: Range | None = None
    axes: tuple[str, ...] = ()

    def __post_init__(self) -> None:
        """Fill in the names that are the same."""
        # The attribute of a frozen dataclass can only be set this way.
        for attribute in ("json", "variable"):
            if not getattr(self, attribute):
                object.__setattr__(self, attribute, self.name)
        if not self.help:
            unit = f" [{self.unit}]" if self.unit else ""
            object.__setattr__(self, "help", self.meaning + unit)

    @property
    def columns(self) -> tuple[str, ...]:
        """Columns in tables: one, or one for each axis of a vector."""
        return tuple(f"{self.json}_{axis}" for axis in self.axes) or (self.json,)

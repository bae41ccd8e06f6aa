"""Numbers that users give: the ranges they have to be in, units that the program computes in."""

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

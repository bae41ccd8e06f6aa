"""Groups of PSU-WOPWOP's namelists, with every key accounted for."""

from __future__ import annotations

import math
import warnings
from collections.abc import Iterable, Mapping
from dataclasses import dataclass
from pathlib import Path
from typing import Any

from propmdao.formats.wopwop.binary import WopwopFileError
from propmdao.formats.wopwop.namelists.keys import not_done, without_effect
from propmdao.formats.wopwop.namelists.syntax import formatted, parse
from propmdao.runtime.input_files import read_text
from propmdao.runtime.output_files import replacing

#: Largest of numbers that count groups, which a file has to hold one by one.
MOST = 100_000
# No case has larger lengths [m], times [s], speeds [m/s], angles or frequencies in it, and the
# squares of larger ones overflow.
_LARGEST = 1e12
_SHOWN = 60
_BYTE_ORDER_MARK = "\xef\xbb\xbf"


@dataclass(frozen=True)
class Group:
    """One namelist group.

    Attributes
    ----------
    name : str
        Name in lower case, without the ampersand.
    values : mapping
        Lower-case keys to numbers, texts, logicals or lists of them.
    path : Path
        Namelist file that the group is in.
    """

    name: str
    values: Mapping[str, Any]
    path: Path

    def __str__(self) -> str:
        title = self.values.get("title")
        return f"{self.path}: &{self.name}" + (f" {title!r}" if title else "")

    def error(self, message: str) -> WopwopFileError:
        """Return the error to raise about this group."""
        return WopwopFileError(f"{self}: {message}")

    def number(self, key: str, default: float | None = None) -> float:
        """Return a number, or the default; refuse the file if there is neither."""
        value = self.values.get(key, default)
        if value is None or (key in self.values and not _is_number(value)):
            raise self.error(f"{key} must be a number; " + _it_is(value))
        if key in self.values and not abs(value) <= _LARGEST:
            raise self.error(f"{key} must be {-_LARGEST:g} ... {_LARGEST:g}; it is {value:g}")
        return float(value)

    def count(self, key: str, default: int | None = None, least: int = 0, most: int = MOST) -> int:
        """Return a whole number in its range, or the default."""
        value = self.values.get(key, default)
        if isinstance(value, bool) or not isinstance(value, int) or not least <= value <= most:
            raise self.error(f"{key} must be a whole number, {least} ... {most}; " + _it_is(value))
        return value

    def vector(self, key: str) -> tuple[float, float, float]:
        """Return three numbers, zeros if they are not given."""
        value = self.values.get(key, [0.0, 0.0, 0.0])
        row = [0.0 if x is None else x for x in value] if isinstance(value, list) else []
        if len(row) != 3 or not all(_is_number(x) and abs(x) <= _LARGEST for x in row):
            raise self.error(
                f"{key} must be three numbers, {-_LARGEST:g} ... {_LARGEST:g}; " + _it_is(value)
            )
        return float(row[0]), float(row[1]), float(row[2])

    def flag(self, key: str) -> bool:
        """Return a logical, false if it is not given."""
        value = self.values.get(key, False)
        if not isinstance(value, bool):
            raise self.error(f"{key} must be .true. or .false.; " + _it_is(value))
        return value

    def text(self, key: str) -> str | None:
        """Return a text or None."""
        value = self.values.get(key)
        if value is not None and not isinstance(value, str):
            raise self.error(f"{key} must be one text; " + _it_is(value))
        return value


def read_namelists(path: str | Path) -> list[Group]:
    """Read the groups of a namelist file.

    Parameters
    ----------
    path : str or Path
        Namelist file.

    Returns
    -------
    list of Group
        The groups in order. A `UserWarning` names every key that is set and has no effect.

    Raises
    ------
    WopwopFileError
        If the file is missing, holds no namelist (the message has the line), or asks for what is
        not done.
    """
    path = Path(path)
    text = read_text(path, WopwopFileError, complaint=str(path), encoding="latin-1")
    try:
        parsed = parse(text.removeprefix(_BYTE_ORDER_MARK))
    except ValueError as error:
        raise WopwopFileError(f"{path}: not a Fortran namelist file: {error}") from None
    if not parsed:
        raise WopwopFileError(f"{path}: not a Fortran namelist file: there is no &group in it")
    groups = []
    for name, values, line, closed in parsed:
        group = Group(name, values, path)
        groups.append(group)
        if (refusal := next(not_done(name, values), None)) is not None:
            raise group.error(refusal)
        complaints = [*without_effect(name, values)]
        if not closed:
            complaints.insert(0, f"in line {line}, it ends where the next begins, without a /")
        for complaint in complaints:
            warnings.warn(f"{group}: {complaint}", stacklevel=2)
    return groups


def write_namelists(path: str | Path, groups: Iterable[tuple[str, Mapping[str, Any]]]) -> None:
    """Write a namelist file.

    Parameters
    ----------
    path : str or Path
        File to write.
    groups : iterable of (str, mapping)
        Names and values of the groups, in the order of the file; names may repeat.
    """
    text = "".join(formatted(name, values) for name, values in groups)
    with replacing(path) as file:
        file.write_text(text, encoding="latin-1")


def _is_number(value: Any) -> bool:
    return isinstance(value, int | float) and not isinstance(value, bool) and math.isfinite(value)


def _it_is(value: Any) -> str:
    if value is None:
        return "it is missing"
    shown = repr(value)
    return f"it is {shown if len(shown) <= _SHOWN else shown[:_SHOWN] + '...'}"

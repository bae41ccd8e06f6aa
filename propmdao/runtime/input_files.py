"""Files that users name, read so that whatever is wrong with one is a single line."""

from __future__ import annotations

import codecs
import math
import os
import re
from pathlib import Path

#: Largest magnitude that a number of a file has unless it is said otherwise: the product of some of
#: them does not overflow.
LARGEST = 1e30
_LEAST = 1e-300
_LONGEST_QUOTE = 60
_NUMBER = re.compile(
    r"[-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?|[-+]?(?:nan|inf|infinity)", re.I | re.A
)
_DECIMAL_COMMA = re.compile(r"[-+]?\d*,\d+", re.A)
_COMMENT = re.compile(r"[#!].*")
#: Encodings that a byte order mark at the beginning of a file declares.
_MARKS = {
    codecs.BOM_UTF8: "utf-8",
    codecs.BOM_UTF16_LE: "utf-16-le",
    codecs.BOM_UTF16_BE: "utf-16-be",
}


def read_text(
    path: str | os.PathLike[str],
    error: type[ValueError],
    *,
    complaint: str | None = None,
    encoding: str = "utf-8",
    undecodable: str = "strict",
) -> str:
    """Read a text file.

    Parameters
    ----------
    path : path
        The file.
    error : type
        Exception that is raised, a ValueError.
    complaint : str, optional
        Beginning of the message; ``PATH: cannot be read`` by default.
    encoding : str
        Encoding of the text, where no byte order mark declares another.
    undecodable : str
        Treatment of bytes that are no text, as `bytes.decode` takes it: "strict" refuses the file,
        "replace" serves where only titles and comments can hold them.

    Returns
    -------
    str
        The text; its lines end in one newline character each.

    Raises
    ------
    ValueError
        If the file cannot be read or is no such text; an exception of the type `error`.
    """
    complaint = f"{path}: cannot be read" if complaint is None else complaint
    content = read_bytes(path, error, complaint=complaint)
    mark = next((mark for mark in _MARKS if content.startswith(mark)), b"")
    try:
        text = content.removeprefix(mark).decode(_MARKS.get(mark, encoding), errors=undecodable)
    except UnicodeDecodeError as reason:
        name = encoding.upper().removesuffix("-SIG")
        raise error(f"{complaint}: it is not text in {name}") from reason
    return text.replace("\r\n", "\n").replace("\r", "\n")


def read_bytes(
    path: str | os.PathLike[str], error: type[ValueError], *, complaint: str | None = None
) -> bytes:
    """Read a binary file.

    Parameters
    ----------
    path : path
        The file.
    error : type
        Exception that is raised, a ValueError.
    complaint : str, optional
        Beginning of the message; ``PATH: cannot be read`` by default.

    Returns
    -------
    bytes
        The whole file.

    Raises
    ------
    ValueError
        If the file cannot be read; an exception of the type `error`.
    """
    complaint = f"{path}: cannot be read" if complaint is None else complaint
    try:
        return Path(path).read_bytes()
    except OSError as reason:
        raise error(f"{complaint}: {reason.strerror or reason}") from reason
    except ValueError as reason:  # a character that no path can hold
        shown = complaint.replace("\0", r"\0")
        raise error(f"{shown}: {reason} in its path") from reason


def clipped(text: str) -> str:
    """Cut what a message quotes from a file to a length that a line can hold.

    Parameters
    ----------
    text : str
        Words of a file.

    Returns
    -------
    str
        The words without blanks around them and without characters that cannot be shown; beyond
        60 characters their beginning.
    """
    shown = "".join(letter if letter.isprintable() else " " for letter in text.strip())
    return shown if len(shown) <= _LONGEST_QUOTE else f"{shown[: _LONGEST_QUOTE - 3]}..."


def is_number(text: str) -> bool:
    """Tell a number from any other word of a file.

    Parameters
    ----------
    text : str
        Word of the file.

    Returns
    -------
    bool
        True for a number, one that is not finite, too.
    """
    return _NUMBER.fullmatch(text) is not None


def finite_number(
    text: str, error: type[ValueError], where: str, largest: float = LARGEST
) -> float:
    """Take one number out of a file.

    Parameters
    ----------
    text : str
        Word of the file.
    error : type
        Exception that is raised, a ValueError.
    where : str
        Name of the file, line and column, with which the message begins.
    largest : float
        Largest magnitude.

    Returns
    -------
    float
        The number; 0 for one whose inverse overflows.

    Raises
    ------
    ValueError
        If the word is no number, or one that is not finite or beyond the largest; an exception of
        the type `error`.
    """
    if not is_number(text.strip()):
        raise error(f"{where}: '{clipped(text)}' is no number")
    value = float(text)
    if not math.isfinite(value):
        raise error(f"{where}: '{clipped(text)}' is not finite")
    if abs(value) > largest:
        raise error(
            f"{where}: '{clipped(text)}' is out of range; a number must be within "
            f"{-largest:g}..{largest:g}"
        )
    return value if abs(value) > _LEAST else 0.0


def fields_of(line: str) -> list[str] | None:
    """Split a line that holds nothing but numbers.

    Parameters
    ----------
    line : str
        Numbers separated by blanks, commas or semicolons. A comma is a decimal point where each
        word between blanks or semicolons has one inside, as in "0,95 0,012".

    Returns
    -------
    list of str or None
        The numbers, not finite ones, too, as `finite_number` takes them; None where a word is none.
    """
    words = line.replace(";", " ").split()
    if len(words) > 1 and all(_DECIMAL_COMMA.fullmatch(word) for word in words):
        fields = [word.replace(",", ".") for word in words]
    else:
        fields = " ".join(words).replace(",", " ").split()
    return fields if fields and all(map(is_number, fields)) else None


def table_rows(
    text: str, n_columns: int, expected: str, error: type[ValueError], label: str
) -> list[list[float]]:
    """Take the numbers out of a table under a title line, which may be missing.

    Parameters
    ----------
    text : str
        Lines of numbers, separated by blanks, commas or semicolons; empty lines are skipped, and
        what follows # or !.
    n_columns : int
        Number of numbers in a row.
    expected : str
        Name of a row in the message, as "two numbers x z".
    error : type
        Exception that is raised, a ValueError.
    label : str
        Name of the file, with which the message begins.

    Returns
    -------
    list of list of float
        The numbers, a list for each row.

    Raises
    ------
    ValueError
        If a line after the first is no such row, the first is one with something else in it, or a
        number is not finite; an exception of the type `error`.
    """
    rows = []
    for number, line in enumerate(text.splitlines(), start=1):
        content = _COMMENT.sub("", line)
        if not content.strip():
            continue
        fields, where = fields_of(content), f"{label}, line {number}"
        if fields is not None and len(fields) == n_columns:
            rows.append([finite_number(field, error, where) for field in fields])
        elif number > 1 or _holds_a_row(content, n_columns):
            raise error(f"{where}: {expected} expected, not '{clipped(line)}'")
    return rows


def _holds_a_row(line: str, n_columns: int) -> bool:
    """Tell a row with a word or a number too many, or a damaged number, from a title."""
    words = line.replace(",", " ").replace(";", " ").split()
    numbers = [is_number(word) for word in words]
    whole = any(all(numbers[k : k + n_columns]) for k in range(len(words) - n_columns + 1))
    return whole or (len(words) == n_columns and sum(numbers) == n_columns - 1)

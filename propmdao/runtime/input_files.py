"""Files that users name, read so that whatever is wrong with one is a single line."""

from __future__ import annotations

import os
from pathlib import Path


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
        Encoding of the text.
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
    try:
        return Path(path).read_text(encoding=encoding, errors=undecodable)
    except OSError as reason:
        raise error(f"{complaint}: {reason.strerror or reason}") from reason
    except UnicodeDecodeError as reason:
        name = encoding.upper().removesuffix("-SIG")
        raise error(f"{complaint}: it is not text in {name}") from reason


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


def table_rows(
    text: str, n_columns: int, expected: str, error: type[ValueError], label: str
) -> list[list[float]]:
    """Take the numbers out of a table under a title line, which may be missing.

    Parameters
    ----------
    text : str
        Lines of numbers, separated by blanks or commas; empty lines are skipped.
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
        If a line after the first is no such row; an exception of the type `error`.
    """
    rows = []
    for number, line in enumerate(text.splitlines(), start=1):
        if not line.strip():
            continue
        try:
            row = [float(field) for field in line.replace(",", " ").split()]
        except ValueError:
            row = []
        if len(row) == n_columns:
            rows.append(row)
        elif number > 1:
            raise error(f"{label}, line {number}: {expected} expected, not '{line.strip()}'")
    return rows

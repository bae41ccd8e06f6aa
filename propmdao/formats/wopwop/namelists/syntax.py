"""Text of Fortran namelists: groups of keys with their values, and the line each begins in.

As Fortran reads it: case does not matter, ``!`` begins a comment, what stands outside of groups is
passed over. Beyond Fortran, names without quotes are read, and a group may end where the next
begins, for VSPAERO writes both.
"""

from __future__ import annotations

import re
from collections.abc import Mapping
from typing import Any, NamedTuple

_OPENING = re.compile(r"^[ \t]*[&$]([a-z]\w*)", re.MULTILINE | re.IGNORECASE)
_TOKEN = re.compile(
    r"(?P<skip>\s+|![^\n]*)"
    r"|(?P<quoted>'(?:[^'\n]|'')*'|\"(?:[^\"\n]|\"\")*\")"
    r"|(?P<end>/(?=[\s,!]|\Z)|[&$]end\b)"
    r"|(?P<opening>[&$][a-z])"
    r"|(?P<key>[a-z]\w*)[ \t]*(?:\([ \t]*(?P<place>\d+)[ \t]*\)[ \t]*)?="
    r"|(?P<comma>,)"
    r"|(?P<word>[^\s,!'\"=]+)",
    re.IGNORECASE,
)
_WHOLE = re.compile(r"[+-]?\d{1,18}")
_REAL = re.compile(
    r"[+-]?(?:(?:\d+\.?\d*|\.\d+)(?:[ed][+-]?\d+)?|inf(?:inity)?|nan)", re.IGNORECASE
)
_LOGICAL = re.compile(r"\.?(?:t|f|true|false)\.?", re.IGNORECASE)
_REPEATED = re.compile(r"(\d{1,18})\*(.*)")
_MOST_VALUES = 1000


class TextGroup(NamedTuple):
    """A group of a namelist file.

    Attributes
    ----------
    name : str
        Name in lower case, without the ampersand.
    values : dict
        Lower-case keys to numbers, texts, logicals or lists of them; the last of equal keys counts.
    line : int
        Line in which the group begins, counted from 1.
    closed : bool
        False if the group ends where the next one begins, without a slash.
    """

    name: str
    values: dict[str, Any]
    line: int
    closed: bool


class _Word(str):
    """A text without quotes."""


def parse(text: str) -> list[TextGroup]:
    """Groups of a namelist file.

    Parameters
    ----------
    text : str
        Contents of the file.

    Returns
    -------
    list of TextGroup
        The groups in order; none if the text is no namelist.

    Raises
    ------
    ValueError
        If a group breaks off or holds what is no key and no value; the message has the line.
    """
    groups = []
    position, line = 0, 1
    while opening := _OPENING.search(text, position):
        line += text.count("\n", position, opening.start(1))
        position, values, closed = _group(text, opening)
        groups.append(TextGroup(opening[1].lower(), values, line, closed))
        line += text.count("\n", opening.start(1), position)
    return groups


def formatted(name: str, values: Mapping[str, Any]) -> str:
    """Text of a group.

    Parameters
    ----------
    name : str
        Name of the group.
    values : mapping
        Keys to numbers, texts, logicals or lists of them.

    Returns
    -------
    str
        Lines of the group.
    """
    lines = [
        f"    {key} = " + ", ".join(map(_formatted, value if isinstance(value, list) else [value]))
        for key, value in values.items()
    ]
    return "\n".join([f"&{name}", *lines, "/", ""])


def _formatted(value: Any) -> str:
    if isinstance(value, bool):
        return ".true." if value else ".false."
    return "'" + value.replace("'", "''") + "'" if isinstance(value, str) else repr(value)


class _Token(NamedTuple):
    """A value as it is written, and what it means."""

    raw: str
    value: Any


# A comma between values.
_COMMA = _Token(",", None)


def _group(text: str, opening: re.Match[str]) -> tuple[int, dict[str, Any], bool]:
    """Return where a group ends, its values, and whether a slash ends it."""
    entries: list[tuple[str, int | None, list[_Token]]] = []
    position = opening.end()
    while position < len(text):
        token = _TOKEN.match(text, position)
        try:
            if token is None:
                wrong = "'=' without a key" if text[position] == "=" else "a text without its end"
                raise ValueError(wrong)
            kind = _kind(token)
            if kind == "opening":
                return position, _values(entries), False
            if kind == "key":
                entries.append((token["key"].lower(), _place(token["place"]), []))
            elif kind in ("quoted", "word", "last", "comma"):
                if not entries:
                    raise ValueError(f"{token[0][:40]!r} stands before any key")
                entries[-1][2].extend(_tokens(token[0], kind))
        except ValueError as error:
            raise ValueError(f"line {_line(text, position)}: {error}") from None
        position = token.end()
        if kind in ("end", "last"):
            return position, _values(entries), True
    raise ValueError(f"line {_line(text, opening.start(1))}: &{opening[1]} has no / at its end")


def _kind(token: re.Match[str]) -> str:
    if token["key"]:
        return "key"
    raw, kind = token[0], str(token.lastgroup)
    # A number, and the slash that ends the group right behind it.
    return "last" if kind == "word" and raw.endswith("/") and not _is_word(raw[:-1]) else kind


def _line(text: str, position: int) -> int:
    return text.count("\n", 0, position) + 1


def _place(digits: str | None) -> int | None:
    return None if digits is None else _few(digits, "the place of a value")


def _few(digits: str, name: str) -> int:
    number = int(digits[:18])
    if not 1 <= number <= _MOST_VALUES:
        raise ValueError(f"{name} must be 1 ... {_MOST_VALUES}; it is {number}")
    return number


def _tokens(raw: str, kind: str) -> list[_Token]:
    """Values of a token: one, or several as in 3*0.0."""
    if kind == "comma":
        return [_COMMA]
    if kind == "quoted":
        return [_Token(raw, _printable(raw[1:-1].replace(2 * raw[0], raw[0])))]
    raw = raw.removesuffix("/") if kind == "last" else raw
    repeated = _REPEATED.fullmatch(raw)
    if repeated is None or _is_word(repeated[2]):
        return [_Token(raw, _value(raw))]
    times = _few(repeated[1], "the number of equal values")
    return [_Token(repeated[2], _value(repeated[2]))] * times


def _value(raw: str) -> Any:
    if _WHOLE.fullmatch(raw):
        return int(raw)
    if _REAL.fullmatch(raw):
        return float(raw.lower().replace("d", "e"))
    if _LOGICAL.fullmatch(raw):
        return raw.strip(".").lower().startswith("t")
    return _Word(_printable(raw))


def _is_word(raw: str) -> bool:
    return isinstance(_value(raw), _Word)


def _printable(text: str) -> str:
    # Titles are printed, and must not move the terminal's cursor.
    return "".join(c if c.isprintable() else "?" for c in text)


def _values(entries: list[tuple[str, int | None, list[_Token]]]) -> dict[str, Any]:
    values: dict[str, Any] = {}
    for key, place, tokens in entries:
        value = _together(tokens)
        if place is None or (place == 1 and key not in values):
            values[key] = value
            continue
        before = values.get(key, [])
        row = list(before) if isinstance(before, list) else [before]
        row += [None] * (place - len(row))
        row[place - 1] = value
        values[key] = row
    return values


def _together(tokens: list[_Token]) -> Any:
    """Value of a key: one, a list of several, None if there is none."""
    parts: list[list[_Token]] = [[]]
    for token in tokens:
        if token is _COMMA:
            parts.append([])
        else:
            parts[-1].append(token)
    if len(parts) > 1 and not parts[-1]:
        parts.pop()  # a comma at the end of the line
    values: list[Any] = []
    for part in parts:
        if any(isinstance(token.value, _Word) for token in part):
            # Several words without quotes are one text.
            values.append(_printable(" ".join(token.raw for token in part)))
        else:
            values += [token.value for token in part] or [None]
    return values[0] if len(values) == 1 else values

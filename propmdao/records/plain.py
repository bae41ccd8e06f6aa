"""Records as plain dictionaries, for JSON, and back."""

from __future__ import annotations

import dataclasses
import types
import typing
from typing import Any, TypeVar

import numpy as np

from propmdao.records.quantities import ASKED

T = TypeVar("T")

_KEYS = {name: quantity.json for name, quantity in ASKED.items()}


def to_plain(value: Any) -> Any:
    """Turn a record into dictionaries, lists and numbers.

    Parameters
    ----------
    value : record
        A dataclass of numbers, text, arrays and other such dataclasses; each field is keyed by the
        name that the table of quantities has for JSON.

    Returns
    -------
    dict
        The record's fields by their JSON names, ready for JSON.
    """
    if dataclasses.is_dataclass(value):
        return {
            _KEYS.get(field.name, field.name): to_plain(getattr(value, field.name))
            for field in dataclasses.fields(value)
        }
    if isinstance(value, tuple | list):
        return [to_plain(item) for item in value]
    if hasattr(value, "shape"):
        return np.asarray(value).tolist()
    return value


def from_plain(record: type[T], values: Any) -> T:
    """Rebuild the record that `to_plain` has turned into a dictionary.

    Parameters
    ----------
    record : type
        Class of the record.
    values : dict
        Fields of the record by their JSON names.

    Returns
    -------
    record
        Record with the values that it had before `to_plain`.

    Raises
    ------
    ValueError
        If a key is unknown, or a value is out of range.
    """
    hints = typing.get_type_hints(record)
    names = {_KEYS.get(name, name): name for name in hints}
    for key in values:
        if key not in names:
            raise ValueError(f"{record.__name__} has no '{key}'; it has {', '.join(sorted(names))}")
    fields = {names[key]: _restored(hints[names[key]], value) for key, value in values.items()}
    return record(**fields)


def _restored(hint: Any, value: Any) -> Any:
    """A field's value, of its type."""
    united = typing.get_origin(hint) in (types.UnionType, typing.Union)
    options = typing.get_args(hint) if united else (hint,)
    if value is None:
        return None
    for option in options:
        if isinstance(value, dict) and dataclasses.is_dataclass(option):
            return from_plain(typing.cast(type, option), value)
        if typing.get_origin(option) is tuple and not isinstance(value, str):
            item = typing.get_args(option)[0]
            return tuple(_restored(item, entry) for entry in value)
        if isinstance(value, list) and typing.get_origin(option) is np.ndarray:
            return np.array(value, float).reshape(-1, 3)
    return value

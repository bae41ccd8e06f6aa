"""Results as JSON on standard output."""

from __future__ import annotations

import json
from typing import Any


def print_json(value: Any) -> None:
    """Print a value.

    Parameters
    ----------
    value : Any
        Dictionaries, lists, strings and numbers.

    Raises
    ------
    NotFiniteError
        If a number is none, or infinite, which JSON has no word for; nothing is printed then.
    """
    print(json.dumps(_plain(value, "result"), indent=2, allow_nan=False))


def _plain(value: Any, name: str) -> Any:
    """Copy with 0 for a zero that has a sign."""
    if isinstance(value, dict):
        return {key: _plain(item, key) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item, name) for item in value]
    if isinstance(value, float):
        from propmdao.runtime.finite import require_finite  # numpy: not for --help

        require_finite(name, value)
        return value + 0.0
    return value

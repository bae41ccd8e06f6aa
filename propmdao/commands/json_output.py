"""Results as JSON on standard output."""

from __future__ import annotations

import json
import math
import sys
from typing import Any


def print_json(value: Any) -> None:
    """Print a value; null stands for what JSON has no number for.

    Parameters
    ----------
    value : Any
        Dictionaries, lists, strings and numbers.
    """
    json.dump(_plain(value), sys.stdout, indent=2, allow_nan=False)
    print()


def _plain(value: Any) -> Any:
    """Copy with null for what JSON has no number for, and 0 for a zero that has a sign."""
    if isinstance(value, dict):
        return {key: _plain(item) for key, item in value.items()}
    if isinstance(value, list):
        return [_plain(item) for item in value]
    if isinstance(value, float):
        return value + 0.0 if math.isfinite(value) else None
    return value

"""Lines on how marches in time have gone: thrust and torque of their revolutions."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

_MOST_SHOWN = 8  # revolutions, the last ones: what the first ones had is in JSON


def march_lines(results: Sequence[dict[str, Any]]) -> list[str]:
    """Thrust and torque of the revolutions of marches, and how far they repeat, in words.

    Parameters
    ----------
    results : sequence of dict
        Results with the keys of ``propmdao analyze --json``.

    Returns
    -------
    list of str
        Three lines for each march; none where nothing was marched.
    """
    return [line for result in results if "revolutions" in result for line in _lines(result)]


def _lines(result: dict[str, Any]) -> list[str]:
    turns = result["revolutions"]
    shown = turns[-_MOST_SHOWN:]
    first = len(turns) - len(shown) + 1
    which = f"revolutions {first} to {len(turns)}" if len(turns) > 1 else "its revolution"
    lines = [
        f"March at {result['rpm']:.1f} rpm, {which}: thrust {_numbers(shown, 'thrust', 1.0)} N,",
        f"  torque {_numbers(shown, 'torque', 1.0)} N m,",
    ]
    tolerance = 100.0 * result["model"]["loads"]["unsteady"]["tolerance"]
    known = [turn for turn in shown if turn["change"] is not None]
    if not known:
        return [*lines, "  no revolution before it to compare with."]
    changed = f"  change of the thrust from one to the next {_numbers(known, 'change', 100.0)} %"
    return [*lines, f"{changed}; {tolerance:g} % counts as none."]


def _numbers(turns: Sequence[dict[str, Any]], key: str, factor: float) -> str:
    form = "#.4g" if factor == 1.0 else ".2g"
    return ", ".join(format(factor * turn[key], form) for turn in turns)

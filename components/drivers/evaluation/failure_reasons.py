"""Why designs of a search have failed: how often for which reason."""

from __future__ import annotations

import re
from collections import Counter

MOST_NAMED = 3  # reasons in a line of text
LONGEST_REASON = 100

_CALLER = re.compile(r"^(?:'(?P<component>[^']*)' )?<class \w+>: Error calling \w+\(\), ")
_NUMBER = re.compile(r"\d+(?:\.\d*)?(?:[eE][-+]?\d+)?")


class FailureReasons:
    """Reasons of failed designs with their counts.

    Reasons that differ in their numbers only are one, told as it was at first: a message that says
    how much is missing has other numbers at every design.
    """

    def __init__(self) -> None:
        self._counts: Counter[str] = Counter()
        self._told: dict[str, str] = {}

    def add(self, failure: str) -> None:
        """Count a failure by its message, which may have several lines."""
        reason = _shortened(failure)
        kind = _NUMBER.sub("#", reason)
        self._told.setdefault(kind, reason)
        self._counts[kind] += 1

    def counts(self) -> dict[str, int]:
        """Return the number of designs by reason, most frequent first."""
        return {self._told[kind]: count for kind, count in self._counts.most_common()}

    def text(self) -> str:
        """Return the most frequent reasons as part of a line, empty when nothing failed."""
        counts = list(self.counts().items())
        parts = [f"{count}: {reason}" for reason, count in counts[:MOST_NAMED]]
        if others := counts[MOST_NAMED:]:
            parts.append(f"{sum(count for _, count in others)}: other reasons")
        return "; ".join(parts)


def _shortened(failure: str) -> str:
    """First line of a failure, with the component alone of what OpenMDAO says in front."""
    line = next((line.strip() for line in failure.splitlines() if line.strip()), failure)
    line = _CALLER.sub(lambda match: f"{match['component']}: " if match["component"] else "", line)
    return line if len(line) <= LONGEST_REASON else line[: LONGEST_REASON - 3].rstrip() + "..."

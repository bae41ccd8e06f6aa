"""Equality constraints that are loose at first: no design of a first population meets one."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

from propmdao.components.drivers.evaluation.candidate import Array, Candidate

SHARE_OF_GENERATIONS = 0.6  # in which the slack shrinks to nothing
POWER = 2.0
FIRST_SHARE = 0.2  # of the first population meets an equality with its first slack


class EqualitySlack:
    """Slack of every constraint element by generation (Takahama and Sakai 2006).

    The first slack of an equality is a quantile of its violations in the first population. It
    shrinks as ``(1 - generation / n_shrinking) ** POWER`` and then is zero, which leaves the
    tolerance of the user. Other constraints have none.

    Parameters
    ----------
    equalities : (n_constraints,) array of bool
        Which constraint elements are equalities.
    max_generations : int
        Number of generations after the first population.

    Attributes
    ----------
    n_shrinking : int
        Number of generations with a slack, 0 where there is no equality.
    """

    def __init__(self, equalities: NDArray[np.bool_], max_generations: int) -> None:
        self._equalities = equalities
        self._first: Array = np.zeros(equalities.size)
        self.n_shrinking = int(SHARE_OF_GENERATIONS * max_generations) if equalities.any() else 0

    def begin(self, candidates: list[Candidate]) -> None:
        """Take the first slack from the first population."""
        violations = [candidate.violation for candidate in candidates if not candidate.failure]
        if violations:
            first = np.quantile(np.stack(violations), FIRST_SHARE, axis=0)
            self._first = np.where(self._equalities, first, 0.0)

    def at(self, generation: int) -> Array:
        """Slack (n_constraints,) of a generation."""
        if generation >= self.n_shrinking:
            return np.zeros_like(self._first)
        remains: Array = self._first * (1.0 - generation / self.n_shrinking) ** POWER
        return remains

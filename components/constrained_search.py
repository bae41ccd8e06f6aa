"""Differential evolution in which constraints hold and every design is evaluated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from typing import Any

import numpy as np
from scipy.optimize import NonlinearConstraint, OptimizeResult, differential_evolution
from tqdm import tqdm

from propmdao.components.candidate import Array, Candidate


@dataclasses.dataclass(frozen=True)
class Generation:
    """The search at the end of one generation: a row of a convergence figure.

    Attributes
    ----------
    generation : int
        0 for the initial population.
    evaluations : int
        Designs evaluated so far.
    best_objective : float
        Objective of the best feasible design so far, in its own units; nan while there is none.
    max_violation : float
        Largest constraint violation of the best design so far in driver scaling, 0 when feasible.
    failed : int
        Designs so far whose analysis failed.
    """

    generation: int
    evaluations: int
    best_objective: float
    max_violation: float
    failed: int


class ConstrainedSearch:
    """``scipy.optimize.differential_evolution`` on candidates that know their violation.

    Parameters
    ----------
    evaluate : callable
        Takes a position (n_variables,) and returns its `Candidate`, with at least one violation.
    improved : callable
        Called with every candidate that is better than all before it and the number of
        evaluations so far, right after its evaluation.
    progress : tqdm
        Bar that counts the evaluations.

    Attributes
    ----------
    best : Candidate or None
        Best candidate so far.
    evaluations, failed : int
        Candidates evaluated, and how many of them failed.
    last_failure : str
        Reason of the latest failure, empty when there was none.
    history : list of Generation
        State after each generation.
    """

    def __init__(
        self,
        evaluate: Callable[[Array], Candidate],
        improved: Callable[[Candidate, int], None],
        progress: tqdm,
    ) -> None:
        self.best: Candidate | None = None
        self.evaluations = 0
        self.failed = 0
        self.last_failure = ""
        self.history: list[Generation] = []
        self._evaluate = evaluate
        self._improved = improved
        self._progress = progress
        self._memo: dict[bytes, Candidate] = {}

    def run(self, population: Array, **scipy_options: Any) -> tuple[Candidate, bool]:
        """Search from an initial population.

        Parameters
        ----------
        population : (n_candidates, n_variables) array
            Initial positions.
        **scipy_options
            Options of scipy's ``differential_evolution``: bounds, maxiter, rng, ...

        Returns
        -------
        best : Candidate
            Best candidate of all that were evaluated.
        converged : bool
            True when the population converged on a feasible candidate.
        """
        # `vectorized` hands over a whole generation at once. There is always a constraint and scipy
        # calls it first, so that exceptions of the model do not pass through the objective call,
        # which would rename them. Its own count of evaluations leaves out the infeasible ones.
        result = differential_evolution(
            self._energies,
            init=population,
            constraints=NonlinearConstraint(self._violations, -np.inf, 0.0),
            vectorized=True,
            updating="deferred",
            polish=False,
            callback=self._end_generation,
            **scipy_options,
        )
        assert self.best is not None
        return self.best, bool(result.success)

    def summary(self, converged: bool) -> str:
        """Return one line: what was found, and after how much."""
        best = self.best
        assert best is not None
        if best.feasible:
            found = f"best objective {best.objective:.8g}"
        elif best.failure:
            found = f"every analysis failed, last with: {self.last_failure}"
        else:
            found = f"no feasible design, smallest total violation {best.violation.sum():.3g}"
        return (
            f"{found}; {'converged' if converged else 'stopped'} after {len(self.history) - 1} "
            f"generations, {self.evaluations} designs, {self.failed} of them failed"
        )

    def _energies(self, positions: Array) -> Array:
        """Objectives at the columns of ``positions`` (n_variables, n_candidates)."""
        return np.array([self._candidate(position).energy for position in positions.T])

    def _violations(self, positions: Array) -> Array:
        """Violations (n_constraints, n_candidates) at the columns of ``positions``, or at one."""
        if positions.ndim == 1:
            return self._candidate(positions).violation
        violations = np.stack([self._candidate(p).violation for p in positions.T], axis=-1)
        if not self.history:  # scipy does not call back after the initial population
            self._record_generation()
        return violations

    def _candidate(self, position: Array) -> Candidate:
        """Evaluate a position at its first use only.

        Scipy asks again for the best one every generation, and for the whole population as long as
        none of it is feasible.
        """
        key = position.tobytes()
        if key not in self._memo:
            candidate = self._memo[key] = self._evaluate(position)
            self.evaluations += 1
            if candidate.failure:
                self.failed += 1
                self.last_failure = candidate.failure
            if self.best is None or candidate.rank < self.best.rank:
                self.best = candidate
                self._improved(candidate, self.evaluations)
            self._progress.update()
        return self._memo[key]

    def _end_generation(self, intermediate_result: OptimizeResult) -> None:
        # Only members of the population are asked for again.
        kept = (position.tobytes() for position in intermediate_result.population)
        self._memo = {key: self._memo[key] for key in kept}
        self._record_generation()

    def _record_generation(self) -> None:
        best = self.best
        assert best is not None
        self.history.append(
            Generation(
                generation=len(self.history),
                evaluations=self.evaluations,
                best_objective=best.objective if best.feasible else np.nan,
                max_violation=float(best.violation.max()),
                failed=self.failed,
            )
        )
        self._progress.set_postfix(best=self.history[-1].best_objective, failed=self.failed)

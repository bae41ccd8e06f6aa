"""Differential evolution in which constraints hold and every design is evaluated once."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable, Iterator
from typing import Any

import numpy as np
from scipy.optimize import NonlinearConstraint, OptimizeResult, differential_evolution
from tqdm import tqdm

from propmdao.components.drivers.evaluation.candidate import Array, Candidate
from propmdao.components.drivers.evaluation.failure_reasons import FailureReasons
from propmdao.components.drivers.evolution.equality_slack import EqualitySlack


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


class SearchStopped(Exception):
    """Exception of an evaluation that ends the search; its message says why."""


class ConstrainedSearch:
    """``scipy.optimize.differential_evolution`` on candidates that know their violation.

    Parameters
    ----------
    evaluate : callable
        Function that takes a list of positions (n_variables,) and yields their candidates in that
        order, each with at least one violation.
    slack : EqualitySlack
        How loose the equality constraints are in each generation. The best candidate, the history
        and what is improved know of none.
    improved : callable
        Function that is called with every candidate that is better than all before it and the
        number of evaluations so far, right after its evaluation.
    progress : tqdm
        Bar that counts the evaluations.
    watch : callable, optional
        Function that is called with every `Generation` when it has ended.

    Attributes
    ----------
    best : Candidate or None
        Best candidate so far.
    evaluations, failed : int
        Number of candidates evaluated, and number of those that failed.
    reasons : FailureReasons
        Why candidates have failed.
    last_failure : str
        Reason of the latest failure, empty when there was none.
    history : list of Generation
        State after each generation.
    stopped : bool
        Whether a `SearchStopped` has ended the search.
    """

    def __init__(
        self,
        evaluate: Callable[[list[Array]], Iterator[Candidate]],
        slack: EqualitySlack,
        improved: Callable[[Candidate, int], None],
        progress: tqdm,
        watch: Callable[[Generation], None] | None = None,
    ) -> None:
        self.best: Candidate | None = None
        self.evaluations = 0
        self.failed = 0
        self.reasons = FailureReasons()
        self.last_failure = ""
        self.history: list[Generation] = []
        self.stopped = False
        self._evaluate = evaluate
        self._slack = slack
        self._improved = improved
        self._progress = progress
        self._watch = watch
        self._memo: dict[bytes, Candidate] = {}

    def run(
        self, population: Array, max_generations: int, **scipy_options: Any
    ) -> tuple[Candidate, str]:
        """Search from an initial population.

        Parameters
        ----------
        population : (n_candidates, n_variables) array
            Initial positions.
        max_generations : int
            Number of generations after the initial one.
        **scipy_options
            Further options of scipy's ``differential_evolution``: bounds, rng, ...

        Returns
        -------
        best : Candidate
            Best candidate of all that were evaluated.
        ending : str
            "converged" when the population converged on a feasible candidate, "stopped" after the
            last generation, or the message of a `SearchStopped`.
        """
        n_shrinking = self._slack.n_shrinking
        try:
            # Scipy compares with violations that it has kept. So it begins anew, with a population
            # whose candidates are all known, whenever the slack has changed.
            for _ in range(n_shrinking):
                population = self._scipy_run(population, 1, scipy_options).population
            result = self._scipy_run(population, max_generations - n_shrinking, scipy_options)
            ending = "converged" if result.success else "stopped"
        except SearchStopped as stop:
            self.stopped = True
            ending = str(stop)
        assert self.best is not None
        return self.best, ending

    def trial(self, position: Array) -> Candidate:
        """Evaluate one more position, outside of any generation.

        Parameters
        ----------
        position : (n_variables,) array
            The position.

        Returns
        -------
        Candidate
            What is there; it is the best one from now on if it is better.
        """
        (candidate,) = self._evaluate([position])
        self._count(candidate)
        return candidate

    def _scipy_run(
        self, population: Array, max_generations: int, options: dict[str, Any]
    ) -> OptimizeResult:
        # `vectorized` hands over a whole generation at once. There is always a constraint and scipy
        # calls it first, so that exceptions of the model do not pass through the objective call,
        # which would rename them. Its own count of evaluations leaves out the infeasible ones.
        return differential_evolution(
            self._energies,
            init=population,
            maxiter=max_generations,
            constraints=NonlinearConstraint(self._violations, -np.inf, 0.0),
            vectorized=True,
            updating="deferred",
            polish=False,
            callback=self._end_generation,
            **options,
        )

    def summary(self, ending: str) -> str:
        """Return one line on the best candidate, the ending and the number of evaluations."""
        best = self.best
        assert best is not None
        if best.feasible:
            result = f"best objective {best.objective:.8g}"
        elif best.failure:
            result = "every analysis failed"
        else:
            result = f"no feasible design, smallest total violation {best.violation.sum():.3g}"
        if not np.isnan(best.deviation):
            result += f", off its equalities by up to {best.deviation:.3g} (driver scaling)"
        reasons = f" ({self.reasons.text()})" if self.failed else ""
        return (
            f"{result}; {ending} after {self._n_ended} generations, "
            f"{self.evaluations} designs, {self.failed} of them failed{reasons}"
        )

    @property
    def _n_ended(self) -> int:
        """Number of generations after the initial one that have ended."""
        return max(len(self.history) - 1, 0)

    def _energies(self, positions: Array) -> Array:
        """Objectives at the columns of ``positions`` (n_variables, n_candidates)."""
        return np.array([candidate.energy for candidate in self._candidates(positions.T)])

    def _violations(self, positions: Array) -> Array:
        """Violations (n_constraints, n_candidates) at the columns of ``positions``, or at one."""
        if positions.ndim == 1:
            (candidate,) = self._candidates(positions[None])
            return candidate.relaxed_violation(self._slack.at(self._n_ended))
        candidates = self._candidates(positions.T)
        if not self.history:  # scipy does not call back after the initial population
            self._slack.begin(candidates)
            self._record_generation()
        slack = self._slack.at(self._n_ended)
        return np.stack([candidate.relaxed_violation(slack) for candidate in candidates], axis=-1)

    def _candidates(self, positions: Array) -> list[Candidate]:
        """Evaluate those of the positions (n_candidates, n_variables) that are new, in one call.

        Scipy asks again for the best one every generation, and for the whole population as long as
        none of it is feasible.
        """
        keys = [position.tobytes() for position in positions]
        new = {
            key: position
            for key, position in zip(keys, positions, strict=True)
            if key not in self._memo
        }
        if new:
            evaluated = self._evaluate(list(new.values()))
            for key, candidate in zip(new, evaluated, strict=True):
                self._memo[key] = candidate
                self._count(candidate)
        return [self._memo[key] for key in keys]

    def _count(self, candidate: Candidate) -> None:
        self.evaluations += 1
        if candidate.failure:
            self.failed += 1
            self.last_failure = candidate.failure
            self.reasons.add(candidate.failure)
        if self.best is None or candidate.rank < self.best.rank:
            self.best = candidate
            self._improved(candidate, self.evaluations)
        self._progress.update()

    def _end_generation(self, intermediate_result: OptimizeResult) -> None:
        # Only members of the population are asked for again.
        members = (position.tobytes() for position in intermediate_result.population)
        self._memo = {key: self._memo[key] for key in members}
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
        if self._watch is not None:
            self._watch(self.history[-1])

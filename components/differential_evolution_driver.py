"""Differential evolution with constraints that hold, as an OpenMDAO driver."""

from __future__ import annotations

import os
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.core.driver import Driver, RecordingDebugging
from scipy.stats import qmc
from tqdm import tqdm

from propmdao.components.best_design_file import write_best_design
from propmdao.components.candidate import Array, Candidate, constraint_violations
from propmdao.components.constrained_search import ConstrainedSearch, Generation

STRATEGIES = tuple(
    mutation + crossover
    for mutation in ("best1", "best2", "rand1", "rand2", "randtobest1", "currenttobest1")
    for crossover in ("bin", "exp")
)
SAMPLERS = {"latinhypercube": qmc.LatinHypercube, "sobol": qmc.Sobol, "halton": qmc.Halton}
SMALLEST_POPULATION = 5  # what strategies with two differences draw from
CANDIDATES_PER_VARIABLE = 15  # scipy's default


class DifferentialEvolutionDriver(Driver):
    """Global optimisation by differential evolution (Storn and Price 1997).

    The search is ``scipy.optimize.differential_evolution`` with Lampinen's constraint handling:
    a feasible design beats an infeasible one, of two feasible designs the lower objective wins,
    and an infeasible one gives way only to a design that violates no constraint more.

    - The model runs once per design, for the objective and all constraints, and once more at the
      end to leave the Problem at the best design. Every run starts from the output values that
      the model held when the driver started, so no result depends on what ran before it.
    - Every element of every constraint counts: lower, upper, both, or ``equals`` within
      ``equality_tolerance``. Violations are compared in driver scaling (``ref``, ``scaler``).
    - A design whose analysis raises ``om.AnalysisError``, or whose objective or constraints are
      not finite, loses against every other and the search goes on. Any other exception is an
      error in the model and ends the run.
    - The first member of the initial population is the current design, clipped to its bounds.
    - After an interrupt (Ctrl-C) the model is run once at the best design found so far, then
      ``KeyboardInterrupt`` propagates.

    When no feasible design was found, ``fail`` is True and the Problem is left at the design with
    the smallest total violation, or where every analysis failed at the initial design.

    Parameters
    ----------
    **kwargs : dict
        Values of the options.

    Attributes
    ----------
    fail : bool
        True when no feasible design was found.
    message : str
        Why the search ended.
    """

    def __init__(self, **kwargs: Any) -> None:
        super().__init__(**kwargs)
        for feature in (
            "optimization",
            "inequality_constraints",
            "equality_constraints",
            "two_sided_constraints",
            "linear_constraints",
        ):
            self.supports[feature] = True
        self.supports["integer_design_vars"] = False
        self.supports["distributed_design_vars"] = False
        self.supports._read_only = True

        self.fail = True
        self.message = ""
        self._search: ConstrainedSearch | None = None
        self._case_failure = ""

    @property
    def history(self) -> list[Generation]:
        """State after each generation."""
        return self._search.history if self._search else []

    @property
    def failed_candidates(self) -> int:
        """Number of designs whose analysis failed."""
        return self._search.failed if self._search else 0

    @property
    def last_failure(self) -> str:
        """Reason of the latest failure, empty when there was none."""
        return self._search.last_failure if self._search else ""

    def _declare_options(self) -> None:
        declare = self.options.declare
        declare("max_gen", 100, types=int, lower=0, desc="Generations after the initial one.")
        declare("pop_size", 0, types=int, lower=0, desc="Designs per generation; 0: 15 a variable.")
        declare(
            "tol",
            1e-3,
            lower=0.0,
            desc="Converged when the standard deviation of the population's scaled objectives is "
            "below tol times the magnitude of their mean.",
        )
        declare("seed", None, types=int, allow_none=True, desc="Same seed, same search.")
        declare("strategy", "best1bin", values=STRATEGIES, desc="Mutation and crossover.")
        declare("init", "latinhypercube", values=tuple(SAMPLERS), desc="Initial population.")
        declare(
            "mutation",
            (0.5, 1.0),
            types=(float, tuple),
            desc="Differential weight in [0, 2); of a pair each generation draws one in between.",
        )
        declare("recombination", 0.7, lower=0.0, upper=1.0, desc="Crossover probability.")
        declare(
            "equality_tolerance",
            1e-4,
            lower=0.0,
            desc="Largest deviation from `equals` that counts as met, in driver scaling.",
        )
        declare(
            "best_file",
            "best_design.json",
            types=(str, os.PathLike),
            allow_none=True,
            desc="JSON file that holds the best feasible design so far at any time; a relative "
            "path lies in the Problem's outputs directory; None: no file.",
        )
        declare("progress", True, types=bool, desc="Progress bar on stderr, if it is a terminal.")
        declare("disp", True, types=bool, desc="Print a summary at the end.")

    def _get_name(self) -> str:
        return "DifferentialEvolution"

    def _setup_driver(self, problem: om.Problem) -> None:
        super()._setup_driver(problem)
        n_objectives = sum(meta["size"] for meta in self._objs.values())
        if n_objectives > 1:
            raise RuntimeError(
                f"{self.msginfo} minimises one scalar objective; the model has {n_objectives}: "
                f"{', '.join(self._objs)}"
            )
        for name, meta in self._designvars.items():
            lower, upper = meta["lower"], meta["upper"]
            # OpenMDAO keeps None for a bound that was not given; users also write 1e30.
            if any(bound is None or not np.all(np.abs(bound) < 1e30) for bound in (lower, upper)):
                need = "finite bounds"
            elif np.any(np.greater(lower, upper)):
                need = "lower <= upper"
            else:
                continue
            raise ValueError(
                f"{self.msginfo} needs {need}; design variable '{name}' has "
                f"lower={lower}, upper={upper}"
            )

    def run(self) -> bool:
        """Search, and leave the Problem at the best design.

        Returns
        -------
        bool
            True when no feasible design was found.
        """
        self.result.reset()
        self.fail, self.message, self._search = True, "", None
        self.iter_count = 0
        self._check_for_missing_objective()
        self._check_for_invalid_desvar_values()
        if not self._designvars:
            raise RuntimeError(f"{self.msginfo} needs a design variable; the model has none")

        self._read_problem()
        rng = np.random.default_rng(self.options["seed"])
        population = self._initial_population(rng)
        with tqdm(
            total=len(population) * (self.options["max_gen"] + 1),
            desc=self._get_name(),
            unit="design",
            disable=None if self.options["progress"] else True,
        ) as progress:
            search = self._search = ConstrainedSearch(
                self._evaluate_position, self._improved, progress
            )
            passed_on = ("strategy", "mutation", "recombination", "tol")
            try:
                best, converged = search.run(
                    population,
                    # A fixed variable has one position, so that no design is run twice.
                    bounds=[(0.0, float(free)) for free in self._upper > self._lower],
                    maxiter=self.options["max_gen"],
                    rng=rng,
                    **{name: self.options[name] for name in passed_on},
                )
            except KeyboardInterrupt:
                if search.best is not None:
                    self._evaluate(search.best.design)
                raise
        self._evaluate(best.design)
        self.fail = not best.feasible
        self.message = search.summary(converged)
        if self.options["disp"]:
            print(f"{self._get_name()}: {self.message}")
        return self.fail

    def _read_problem(self) -> None:
        """Take the bounds and the initial state from the Problem."""
        metas = self._designvars.values()
        self._lower, self._upper = (
            np.concatenate([np.broadcast_to(meta[side], meta["size"]) for meta in metas])
            for side in ("lower", "upper")
        )
        self._n_constraints = sum(meta["size"] for meta in self._cons.values())
        self._initial_outputs = self._outputs().asarray(copy=True)

    def _outputs(self) -> Any:
        return self._problem().model.get_nonlinear_vectors()[1]

    def _initial_population(self, rng: np.random.Generator) -> Array:
        """Return positions in the unit cube (pop_size, n_variables), the current design first."""
        n_variables = self._lower.size
        size = self.options["pop_size"] or max(
            SMALLEST_POPULATION, CANDIDATES_PER_VARIABLE * n_variables
        )
        if size < SMALLEST_POPULATION:
            raise ValueError(
                f"{self.msginfo}: pop_size must be at least {SMALLEST_POPULATION}; it is {size}"
            )
        population = SAMPLERS[self.options["init"]](n_variables, rng=rng).random(size)
        current = np.concatenate(list(self.get_design_var_values(driver_scaling=False).values()))
        span = self._upper - self._lower
        from_lower = np.clip(current, self._lower, self._upper) - self._lower
        population[0] = from_lower / np.where(span > 0.0, span, 1.0)
        return population

    def _evaluate_position(self, position: Array) -> Candidate:
        design = self._lower + position * (self._upper - self._lower)
        return self._evaluate(np.clip(design, self._lower, self._upper))

    def _evaluate(self, design: Array) -> Candidate:
        """Run the model at a design, as one driver case."""
        # Every run starts alike: states of a diverged solver would spoil the runs after it.
        self._outputs().set_val(self._initial_outputs)
        start = 0
        for name, meta in self._designvars.items():
            stop = start + meta["size"]
            self._set_design_var(name, design[start:stop], units=meta["units"])
            start = stop
        with RecordingDebugging(self._get_name(), self.iter_count, self):
            try:
                self._run_solve_nonlinear()
                candidate = self._read_responses(design)
            except om.AnalysisError as error:
                reason = str(error) or "AnalysisError without a message"
                candidate = Candidate.failed(design, 1 + self._n_constraints, reason)
            self._case_failure = candidate.failure
        self.iter_count += 1
        return candidate

    def _read_responses(self, design: Array) -> Candidate:
        """Take objective and violations from the model that has just run."""
        objectives = self.get_objective_values(driver_scaling=False)
        energies = self.get_objective_values()
        constraints = self.get_constraint_values(driver_scaling=False)
        for name, value in {**objectives, **constraints}.items():
            if not np.isfinite(value).all():
                raise om.AnalysisError(f"{name} is not finite: {value}")
        violations = [
            constraint_violations(constraints[name], meta, self.options["equality_tolerance"])
            for name, meta in self._cons.items()
        ]
        # The leading zero is the constraint that the analysis succeeds.
        violation = np.concatenate([[0.0], *violations])
        (objective,), (energy,) = (v for values in (objectives, energies) for v in values.values())
        return Candidate(design, float(objective), float(energy), violation)

    def _improved(self, candidate: Candidate, evaluations: int) -> None:
        if candidate.feasible and self.options["best_file"] is not None:
            # Joined to an absolute path the folder drops out.
            path = self._problem().get_outputs_dir() / self.options["best_file"]
            path.parent.mkdir(parents=True, exist_ok=True)
            write_best_design(path, self, evaluations)

    def _get_recorder_metadata(self, case_name: str) -> dict[str, Any]:
        metadata = super()._get_recorder_metadata(case_name)
        metadata.update(success=int(not self._case_failure), msg=self._case_failure)
        return metadata

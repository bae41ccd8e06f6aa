"""Differential evolution with constraints that hold, as an OpenMDAO driver."""

from __future__ import annotations

import contextlib
import math
import time
from collections.abc import Callable, Iterator, Sequence
from pathlib import Path
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.core.driver import Driver, RecordingDebugging

from propmdao.components.drivers.best_design_file import write_best_design
from propmdao.components.drivers.checkpoint import Checkpoint
from propmdao.components.drivers.evaluation.candidate import Array, Candidate
from propmdao.components.drivers.evaluation.design_problem import DesignProblem, require_bounds
from propmdao.components.drivers.evaluation.model_run import ModelRun, put_outputs
from propmdao.components.drivers.evaluation.model_runner import (
    ModelRunner,
    declare_runner_options,
    model_runner,
)
from propmdao.components.drivers.evolution.constrained_search import (
    ConstrainedSearch,
    Generation,
    SearchStopped,
)
from propmdao.components.drivers.evolution.equality_slack import EqualitySlack
from propmdao.components.drivers.evolution.gradient_polish import polish
from propmdao.components.drivers.progress import declare_progress, progress_bar
from propmdao.components.drivers.search_options import (
    SAMPLERS,
    declare_file_options,
    declare_search_options,
)
from propmdao.runtime.locks import locked
from propmdao.runtime.output_files import make_folder, require_writable
from propmdao.runtime.terminal import print_line
from propmdao.runtime.worker_processes import WorkerLostError

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
    - Equalities are loose at first and tighten to that tolerance within 60 % of ``max_gen``
      generations (Takahama and Sakai 2006), before which the search does not end as converged.
    - With ``polish`` SLSQP goes on from the best design with the model's total derivatives, for one
      more run of the model in this process each. It meets several equalities, which evolution alone
      misses; its designs count, are recorded and are in the checkpoint as the others. A search that
      is ended by its time budget is not polished.
    - A design whose analysis raises ``om.AnalysisError``, or whose objective or constraints are
      not finite, loses against every other and the search goes on. Any other exception is an
      error in the model and ends the run.
    - The first member of the initial population is the current design, clipped to its bounds.
    - After an interrupt (Ctrl-C) the model is run once at the best design found so far, then
      ``KeyboardInterrupt`` propagates. The same holds when a worker dies (``WorkerLostError``).
    - With ``checkpoint`` every design is on disk once it is evaluated. Run again after whatever
      ended it, even a kill, the search goes on from there to the same end, or beyond it. It is
      locked meanwhile: a second search on it ends at once in an ``InUseError``.
    - With ``n_workers`` or ``executor`` the designs of a generation run side by side, on Problems
      that the workers build by ``problem_factory`` and that start from the values of this one.
      The search, its files and its recorded cases are the same, whatever the number of workers,
      if the model computes the same numbers on one thread as on several. Each worker has one; an
      executor of your own needs `runtime.worker_processes.use_one_thread` as its initializer.
    - With ``design_time_limit`` a process that takes longer over a design is ended and replaced;
      the design has failed. So has one whose process dies.
    - With ``designs_at_once`` the components of this package evaluate so many designs in one
      compiled call, which is what an accelerator is for, shared out to all devices that JAX has; on
      two cores eight are a third faster than one after the other and workers twice as fast. A blade
      takes some 20 MB; more than a device has is refused before the work. Other components,
      ``ExecComp`` say, run at one design after the other. The numbers are those of single runs to
      rounding, so that a long search may take another path.
    - Cases from a checkpoint are recorded again; outputs that it does not hold are nan, which are
      all but independent variables, objective and constraints.

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
        Result of the search in a line, and why it ended; with the deviation left from equalities.
    watch : callable or None
        Function of yours that is called with every `Generation` when it has ended.
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
        self.watch: Callable[[Generation], None] | None = None
        # The state of a run, which `run` makes anew.
        self._search: ConstrainedSearch | None = None
        self._design_problem: DesignProblem  # from the final model
        self._checkpoint: Checkpoint | None = None
        self._runner = ModelRunner(self)
        self._deadline = math.inf  # of the time budget, on the monotonic clock
        self._case_failure = ""  # of the case that is recorded

    @property
    def history(self) -> list[Generation]:
        """State after each generation."""
        return self._search.history if self._search else []

    @property
    def failed_candidates(self) -> int:
        """Number of designs whose analysis failed."""
        return self._search.failed if self._search else 0

    @property
    def failure_reasons(self) -> dict[str, int]:
        """Number of failed designs by reason, shortened, most frequent first."""
        return self._search.reasons.counts() if self._search else {}

    @property
    def last_failure(self) -> str:
        """Reason of the latest failure, empty when there was none."""
        return self._search.last_failure if self._search else ""

    def _declare_options(self) -> None:
        declare_search_options(self.options)
        declare_runner_options(self.options)
        declare_file_options(self.options)
        declare_progress(self.options)

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
        require_bounds(self)

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
        if self.options["polish"] and self.options["design_time_limit"] is not None:
            raise ValueError(
                f"{self.msginfo}: polish runs the model in this process, where design_time_limit"
                " ends nothing; give one of the two"
            )
        self._design_problem = DesignProblem(self, self.options["equality_tolerance"])
        if self.options["best_file"] is not None:
            require_writable(self._output_file("best_file"))
        if self.options["checkpoint"] is None:
            self._checkpoint = None
            return self._run_seeded(self.options["seed"])
        file = self._output_file("checkpoint")
        with locked(file):
            self._checkpoint = self._open_checkpoint(file)
            return self._run_seeded(self._checkpoint.seed)

    def _run_seeded(self, seed: int | None) -> bool:
        budget = self.options["time_budget"]
        self._deadline = math.inf if budget is None else time.monotonic() + budget
        with model_runner(self) as self._runner:
            return self._run_search(np.random.default_rng(seed))

    def _run_search(self, rng: np.random.Generator) -> bool:
        population = self._initial_population(rng)
        slack = EqualitySlack(self._design_problem.equalities(), self.options["max_gen"])
        most_designs = len(population) * (self.options["max_gen"] + 1)
        with progress_bar(self, most_designs, "design") as progress:
            search = self._search = ConstrainedSearch(
                self._evaluate_positions, slack, self._improved, progress, self.watch
            )
            # A fixed variable has one position, so that no design is run twice.
            free = self._design_problem.upper > self._design_problem.lower
            passed_on = ("strategy", "mutation", "recombination", "tol")
            try:
                _, ending = search.run(
                    population,
                    self.options["max_gen"],
                    bounds=[(0.0, float(is_free)) for is_free in free],
                    rng=rng,
                    **{name: self.options[name] for name in passed_on},
                )
                ending = self._polished(search, ending)
            except (KeyboardInterrupt, WorkerLostError) as error:
                if search.best is not None:
                    self._run_here(search.best.design, ModelRunner(self))
                if self._checkpoint:
                    error.add_note(
                        f"The {search.evaluations} designs evaluated so far are in"
                        f" '{self._checkpoint.path}': run again to go on from there."
                    )
                raise
        best = search.best
        assert best is not None
        # Not here, where nothing would end a design that took too long: they may all have.
        limited = self.options["design_time_limit"] is not None
        self._run_here(best.design, self._runner if limited else ModelRunner(self))
        self.fail = not best.feasible
        self.message = search.summary(ending)
        if self.options["disp"]:
            print_line(f"{self._get_name()}: {self.message}")
        return self.fail

    def _polished(self, search: ConstrainedSearch, ending: str) -> str:
        """Polish the best design of a search that has come to its end; how it ended then."""
        best = search.best
        if not self.options["polish"] or search.stopped or best is None or best.failure:
            return ending
        begun = search.evaluations
        with contextlib.suppress(SearchStopped):
            polish(self, self._design_problem, search.trial, best)
        return f"{ending} and polished by {search.evaluations - begun} designs"

    def _initial_population(self, rng: np.random.Generator) -> Array:
        """Return positions in the unit cube (pop_size, n_variables), the current design first."""
        n_variables = self._design_problem.lower.size
        sampler = SAMPLERS[self.options["init"]](n_variables, rng=rng)
        population: Array = sampler.random(self._population_size())
        population[0] = self._design_problem.current_position()
        return population

    def _population_size(self) -> int:
        size = self.options["pop_size"] or max(
            SMALLEST_POPULATION, CANDIDATES_PER_VARIABLE * self._design_problem.lower.size
        )
        if size < SMALLEST_POPULATION:
            raise ValueError(
                f"{self.msginfo}: pop_size must be at least {SMALLEST_POPULATION}; it is {size}"
            )
        return int(size)

    def _open_checkpoint(self, file: Path) -> Checkpoint:
        # When to stop is no part of it: a search may be resumed with more generations, unless they
        # determine how fast the slack of its equalities shrinks or when the polishing begins.
        options = ("seed", "strategy", "init", "mutation", "recombination", "equality_tolerance")
        search = {name: self.options[name] for name in options}
        if self._design_problem.equalities().any() or self.options["polish"]:
            search["max_gen"] = self.options["max_gen"]
        if self.options["polish"]:
            search["polish"] = True
        search |= {"pop_size": self._population_size(), **self._design_problem.description()}
        checkpoint = Checkpoint(file, search)
        entry = checkpoint.first_success()
        if entry is not None:
            self._design_problem.set_design(np.array(entry["design"]))
            self._run_solve_nonlinear()
            checkpoint.require_same_model(entry, self._design_problem.responses())
        return checkpoint

    def _output_file(self, option: str) -> Path:
        """Path that an option gives, in the Problem's outputs directory unless it is absolute."""
        path: Path = self._problem().get_outputs_dir() / self.options[option]
        make_folder(path.parent)
        return path

    def _evaluate_positions(self, positions: Sequence[Array]) -> Iterator[Candidate]:
        """Evaluate designs in their order: those of the checkpoint, then the new ones."""
        designs = [self._design_problem.at_position(position) for position in positions]
        entries = self._checkpoint.replay(designs) if self._checkpoint else []
        replayed, new = designs[: len(entries)], designs[len(entries) :]
        replays = self._replay(replayed, entries)
        for design in replayed:
            yield self._next_case(design, replays)
        with contextlib.closing(self._runner.run(map(self._design_problem.start_at, new))) as runs:
            for design in new:
                if time.monotonic() > self._deadline and self.iter_count > 0:
                    raise SearchStopped("stopped at the end of its time budget")
                candidate = self._next_case(design, runs)
                if self._checkpoint:
                    responses = {} if candidate.failure else self._design_problem.responses()
                    self._checkpoint.append(design, candidate.failure, responses)
                yield candidate

    def _replay(
        self, designs: Sequence[Array], entries: Sequence[dict[str, Any]]
    ) -> Iterator[ModelRun]:
        """Runs as the checkpoint tells of them; the model is left as each of them left it."""
        for design, entry in zip(designs, entries, strict=True):
            outputs = self._design_problem.outputs_from(design, entry["outputs"])
            put_outputs(self._problem().model, outputs)
            yield ModelRun(outputs, entry["failure"])

    def _run_here(self, design: Array, runner: ModelRunner) -> None:
        """Run the model at a design and leave that of the Problem there."""
        self._next_case(design, runner.run([self._design_problem.start_at(design)]))

    def _next_case(self, design: Array, runs: Iterator[ModelRun]) -> Candidate:
        """Take the next run, which is the one at the design, and read it: one driver case."""
        self._design_problem.set_design(design)  # which debug_print shows before the run
        self._case_failure = "not finished"  # of an interrupted case
        with RecordingDebugging(self._get_name(), self.iter_count, self):
            run = next(runs)
            if run.error is not None:
                raise run.error
            candidate = self._design_problem.candidate(design, run.failure)
            self._case_failure = candidate.failure
        self.iter_count += 1
        return candidate

    def _improved(self, candidate: Candidate, evaluations: int) -> None:
        if candidate.feasible and self.options["best_file"] is not None:
            write_best_design(self._output_file("best_file"), self, evaluations)

    def _get_recorder_metadata(self, case_name: str) -> dict[str, Any]:
        metadata = super()._get_recorder_metadata(case_name)
        metadata.update(success=int(not self._case_failure), msg=self._case_failure)
        return metadata

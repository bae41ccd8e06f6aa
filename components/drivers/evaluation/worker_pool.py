"""A model in other processes, on any executor of `concurrent.futures`."""

from __future__ import annotations

import contextlib
import dataclasses
import pickle
import threading
import traceback
from collections.abc import Callable, Iterable, Iterator
from concurrent.futures import BrokenExecutor, Executor
from functools import partial
from typing import Any

import openmdao.api as om
from openmdao.core.constants import _SetupStatus
from openmdao.core.driver import Driver

from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.model_run import ModelRun, record_run
from propmdao.runtime.worker_processes import results_in_order

# An executor may run tasks on threads; a Problem serves one at a time.
_WORKER = threading.local()


class WorkerPool:
    """Models on the workers of an executor, each run from the output values it is sent.

    Values travel, structure does not: every worker builds its Problem once, and what the outputs
    vector holds before a run, independent variables and initial states alike, comes from the
    Problem that asks. So a run gives what it would have given there.

    Parameters
    ----------
    factory : callable
        Function without arguments that returns a Problem, set up, with the same model as `model`.
        It has to pickle, which functions of a module do and nested ones and lambdas do not. It
        should not attach recorders, whose file every worker would open anew.
    model : om.Group
        Model of the Problem that asks, after its final setup.
    executor : concurrent.futures.Executor
        Executor whose workers run the model.

    Raises
    ------
    ValueError
        When the factory does not pickle.
    """

    def __init__(
        self, factory: Callable[[], om.Problem], model: om.Group, executor: Executor
    ) -> None:
        self._task = pickled_task(factory, model)
        self._executor = executor

    def build_ahead(self, n_workers: int) -> None:
        """Have so many idle workers build the model, side by side instead of one by one."""
        with contextlib.suppress(BrokenExecutor):  # of which the first run tells
            for _ in range(n_workers):
                self._executor.submit(build_model, self._task)

    def run(self, starts: Iterable[Array]) -> Iterator[ModelRun]:
        """Run the model from each of several outputs vectors.

        Parameters
        ----------
        starts : iterable of (n,) arrays
            Values of all outputs before each run.

        Yields
        ------
        ModelRun
            Runs in the order of `starts`.

        Raises
        ------
        WorkerLostError
            When a worker dies.
        Exception
            Any exception of the factory.
        """
        for run in results_in_order(self._executor, partial(run_model, self._task), starts):
            raise_unless_built(run)
            yield run


def raise_unless_built(run: ModelRun) -> None:
    """Raise the error that has kept a worker from building its model."""
    if run.error is not None and not run.built:
        raise run.error


def pickled_task(factory: Callable[[], om.Problem], model: om.Group) -> bytes:
    """Return what a worker needs to build its Problem, or a ValueError if it does not pickle."""
    try:
        return pickle.dumps((factory, _layout(model)))
    except Exception as error:  # pickle raises whatever an object's methods raise
        raise ValueError(
            f"problem_factory {factory!r} does not pickle ({error}); use a function that stands at"
            " the top of a module, or functools.partial of one"
        ) from error


def _layout(model: om.Group) -> dict[str, int]:
    """Sizes of all outputs in the order of the outputs vector."""
    return {name: meta["size"] for name, meta in model._var_allprocs_abs2meta["output"].items()}


def run_model(task: bytes, start: Array) -> ModelRun:
    """Run the model of a task in this worker."""
    try:
        model = _problem(task).model
    except Exception as error:
        return ModelRun(start, error=_portable(error), built=False)
    outputs = model.get_nonlinear_vectors()[1]
    outputs.set_val(start)
    run = record_run(model.run_solve_nonlinear, outputs)
    return run if run.error is None else dataclasses.replace(run, error=_portable(run.error))


def _problem(task: bytes) -> om.Problem:
    """Problem of this worker for a task, built on first use."""
    if getattr(_WORKER, "task", None) != task:
        _WORKER.problem = _build(task)
        _WORKER.task = task
    problem: om.Problem = _WORKER.problem
    return problem


def build_model(task: bytes) -> None:
    """Build the Problem of a task in this worker; of an error the first run tells."""
    with contextlib.suppress(Exception):
        _problem(task)


def _build(task: bytes) -> om.Problem:
    factory, expected = pickle.loads(task)
    problem = factory()
    if not isinstance(problem, om.Problem) or not _is_set_up(problem):
        raise ValueError(
            f"problem_factory must return a Problem that has been set up; it returns {problem!r}"
        )
    # Its driver is never run, but its recorder would open the file of the driver that is.
    problem.driver = Driver()
    problem.final_setup()
    built = _layout(problem.model)
    if list(built.items()) != list(expected.items()):
        different = sorted(dict(built.items() ^ expected.items())) or ["the order of outputs"]
        raise ValueError(
            f"problem_factory builds another model than the driver's Problem has: they differ in"
            f" {', '.join(different[:3])}"
        )
    return problem


def _is_set_up(problem: om.Problem) -> bool:
    metadata = problem._metadata
    return metadata is not None and metadata["setup_status"] >= _SetupStatus.POST_SETUP


def _portable(error: Exception) -> Exception:
    """Return the error with the worker's traceback, or its message where it does not pickle."""
    note = "In a worker:\n" + "".join(traceback.format_exception(error))
    error.__cause__ = error.__context__ = None
    try:
        error.add_note(note)
        copy: Any = pickle.loads(pickle.dumps(error))
        return copy
    except Exception:
        plain = RuntimeError(f"{type(error).__name__}: {error}")
        plain.add_note(note)
        return plain

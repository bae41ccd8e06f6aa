"""Where a driver's model runs: here, on workers, or at several designs at once."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Callable, Iterator
from concurrent.futures import Executor

import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.components.drivers.evaluation.design_batches import DesignBatches
from propmdao.components.drivers.evaluation.worker_pool import WorkerPool
from propmdao.runtime.worker_processes import start_workers

ModelRunner = WorkerPool | DesignBatches


def declare_runner_options(options: OptionsDictionary) -> None:
    """Declare where the model runs, as `model_runner` reads it."""
    declare = options.declare
    declare(
        "n_workers", 1, types=int, lower=1, desc="Processes that run the model; 1: only this one."
    )
    declare(
        "executor",
        None,
        types=Executor,
        allow_none=True,
        recordable=False,
        desc="Executor of concurrent.futures that runs the model instead; it stays open.",
    )
    declare(
        "problem_factory",
        None,
        types=Callable,
        allow_none=True,
        recordable=False,
        desc="Function that returns the Problem, set up; the workers build theirs with it.",
    )
    declare(
        "designs_at_once",
        1,
        types=int,
        lower=1,
        desc="Designs that the components of JAX evaluate in one call of this process.",
    )


@contextlib.contextmanager
def model_runner(model: om.Group, options: OptionsDictionary) -> Iterator[ModelRunner | None]:
    """What runs a driver's model, as the driver's options ask for it.

    Parameters
    ----------
    model : om.Group
        Model of the driver's Problem.
    options : OptionsDictionary
        Those of `declare_runner_options`. Processes are ended when the context is left, an executor
        is left open.

    Yields
    ------
    WorkerPool, DesignBatches or None
        None when the model is to be run as it is, one design after the other.

    Raises
    ------
    ValueError
        When there is no factory for workers, or it does not pickle; when the model has nothing to
        evaluate several designs at once; or when more than one way to run is asked for.
    """
    n_workers, executor = options["n_workers"], options["executor"]
    factory, at_once = options["problem_factory"], options["designs_at_once"]
    asked = [
        f"{name} {value}"
        for name, value in (("n_workers", n_workers), ("designs_at_once", at_once))
        if value > 1
    ]
    asked += ["an executor"] if executor is not None else []
    if len(asked) > 1:
        raise ValueError(f"the model runs in one way; given are {' and '.join(asked)}")
    if not asked:
        yield None
        return
    if at_once > 1:
        yield DesignBatches(model, at_once)
        return
    if factory is None:
        raise ValueError(
            "workers build their own Problem: give problem_factory, a function of a module that"
            " returns the Problem, set up"
        )
    if executor is not None:
        yield WorkerPool(factory, model, executor)
        return
    with contextlib.ExitStack() as stack:
        # A Problem that is set up clears the reports of its name: they would be this process's.
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        workers = stack.enter_context(start_workers(n_workers, {"OPENMDAO_WORKDIR": folder}))
        pool = WorkerPool(factory, model, workers)
        pool.build_ahead(n_workers)
        yield pool

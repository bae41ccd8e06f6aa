"""The runner of a driver's model: here, on workers, or at several designs at once."""

from __future__ import annotations

import contextlib
import tempfile
from collections.abc import Callable, Generator, Iterable, Iterator
from concurrent.futures import Executor

from openmdao.core.driver import Driver
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.design_batches import DesignBatches
from propmdao.components.drivers.evaluation.model_run import ModelRun, put_outputs, record_run
from propmdao.components.drivers.evaluation.time_limited_workers import TimeLimitedWorkers
from propmdao.components.drivers.evaluation.worker_pool import WorkerPool
from propmdao.runtime.worker_processes import start_workers

LONGEST_TIME_LIMIT = 1_000_000  # s; the system waits no longer than 24 days in one piece


class ModelRunner:
    """Runs of a driver's model, which is left as each of them leaves it.

    Parameters
    ----------
    driver : Driver
        Driver of a Problem after its final setup; its result counts the runs.
    backend : WorkerPool, TimeLimitedWorkers, DesignBatches or None
        Runs several designs at a time. None: the model runs here, at one design after the other.
    """

    def __init__(
        self,
        driver: Driver,
        backend: WorkerPool | TimeLimitedWorkers | DesignBatches | None = None,
    ) -> None:
        self._driver, self._backend = driver, backend

    def run(self, starts: Iterable[Array]) -> Generator[ModelRun, None, None]:
        """Run the model from each of several outputs vectors.

        Parameters
        ----------
        starts : iterable of (n,) arrays
            Values of all outputs before each run. Whoever makes them may use the model, which no
            run needs while they are made.

        Yields
        ------
        ModelRun
            Runs in the order of `starts`.

        Raises
        ------
        WorkerLostError
            When a worker dies.
        Exception
            Any exception of the factory of the workers.
        """
        model = self._driver._problem().model
        if self._backend is None:
            outputs = model.get_nonlinear_vectors()[1]
            for start in starts:
                outputs.set_val(start)
                yield record_run(self._driver._run_solve_nonlinear, outputs)
        else:
            for run in self._backend.run(starts):
                put_outputs(model, run.outputs)
                self._driver.result.model_evals += not run.ended_early  # as OpenMDAO counts here
                yield run


def declare_runner_options(options: OptionsDictionary) -> None:
    """Declare the options of `model_runner`."""
    declare = options.declare
    declare(
        "n_workers",
        1,
        types=int,
        lower=1,
        desc="Number of processes that run the model; 1: only this one.",
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
        desc="Number of designs that components of JAX evaluate in one call of this process, "
        "shared out to all of its devices.",
    )
    declare(
        "design_time_limit",
        None,
        types=(int, float),
        allow_none=True,
        check_valid=_require_time,
        desc="Seconds after which the process that runs the model is ended and the design has "
        "failed; None: no limit. Compilation does not count: the first design of a process may "
        "take as much longer as the slowest first one before it took, the very first 300 s. With "
        "n_workers 1 the model runs in one process beside this one.",
    )


def _require_time(name: str, value: float | None) -> None:
    if value is not None and not 0.0 < value <= LONGEST_TIME_LIMIT:
        raise ValueError(
            f"{name} is {value}; it is a number of seconds above 0, at most {LONGEST_TIME_LIMIT}"
        )


@contextlib.contextmanager
def model_runner(driver: Driver) -> Iterator[ModelRunner]:
    """Runner of a driver's model, as the driver's options ask for it.

    Processes are ended when the context is left, an executor of the user's is left open.

    Parameters
    ----------
    driver : Driver
        Driver of a Problem after its final setup, with the options of `declare_runner_options`.

    Yields
    ------
    ModelRunner
        Runner that serves until the context is left.

    Raises
    ------
    ValueError
        When there is no factory for workers, or it does not pickle; when the model has nothing to
        evaluate several designs at once; or when more than one way to run is asked for.
    """
    options, model = driver.options, driver._problem().model
    n_workers, executor = options["n_workers"], options["executor"]
    factory, at_once = options["problem_factory"], options["designs_at_once"]
    requested = [
        f"{name} {value}"
        for name, value in (("n_workers", n_workers), ("designs_at_once", at_once))
        if value > 1
    ]
    requested += ["an executor"] if executor is not None else []
    if len(requested) > 1:
        raise ValueError(f"the model runs in one way; given are {' and '.join(requested)}")
    limit = options["design_time_limit"]
    if limit is not None and (executor is not None or at_once > 1):
        raise ValueError(
            f"design_time_limit {limit} ends processes of the driver's own, not {requested[0]};"
            " give n_workers"
        )
    if not requested and limit is None:
        yield ModelRunner(driver)
        return
    if at_once > 1:
        yield ModelRunner(driver, DesignBatches(model, at_once))
        return
    if factory is None:
        raise ValueError(
            "workers build their own Problem: give problem_factory, a function of a module that"
            " returns the Problem, set up"
        )
    if executor is not None:
        yield ModelRunner(driver, WorkerPool(factory, model, executor))
        return
    with contextlib.ExitStack() as stack:
        # A Problem that is set up clears the reports of its name: they would be this process's.
        folder = stack.enter_context(tempfile.TemporaryDirectory())
        environment = {"OPENMDAO_WORKDIR": folder}
        if limit is not None:
            limited = TimeLimitedWorkers(factory, model, n_workers, limit, environment)
            yield ModelRunner(driver, stack.enter_context(contextlib.closing(limited)))
            return
        workers = stack.enter_context(start_workers(n_workers, environment))
        pool = WorkerPool(factory, model, workers)
        pool.build_ahead(n_workers)
        yield ModelRunner(driver, pool)

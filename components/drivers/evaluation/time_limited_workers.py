"""A model in processes of which each is ended when a design takes it too long."""

from __future__ import annotations

import contextlib
import threading
import time
from collections.abc import Callable, Iterable, Iterator, Mapping
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess

import openmdao.api as om

from propmdao.components.drivers.evaluation.candidate import Array
from propmdao.components.drivers.evaluation.model_run import ModelRun
from propmdao.components.drivers.evaluation.worker_pool import (
    build_model,
    pickled_task,
    raise_unless_built,
    run_model,
)
from propmdao.runtime.worker_processes import results_in_order, start_process

#: Time that the first design of a process may take beside the limit, while none has ended [s].
COMPILING = 300.0


class TimeLimitedWorkers:
    """Models in processes of their own, each run from the output values it is sent.

    A thread here waits for each process. A pool of processes would not do: it does not tell when a
    task has begun, and ends all of its processes when one is ended.

    Parameters
    ----------
    factory, model
        As of a `WorkerPool`.
    n_workers : int
        Number of processes.
    time_limit : float
        Seconds that a design may take. The building of a model does not count. Nor does
        compilation: the first design of a process may take as much longer as the slowest first
        design before it took, or `COMPILING` where there is none yet.
    environment : mapping of str to str
        Environment variables set in every process.

    Raises
    ------
    ValueError
        When the factory does not pickle.
    """

    def __init__(
        self,
        factory: Callable[[], om.Problem],
        model: om.Group,
        n_workers: int,
        time_limit: float,
        environment: Mapping[str, str],
    ) -> None:
        self._task = pickled_task(factory, model)
        self._time_limit = time_limit
        self._environment = environment
        self._threads = ThreadPoolExecutor(n_workers)
        self._of_thread = threading.local()
        self._lock = threading.Lock()
        self._processes: list[BaseProcess] = []
        self._closed = False
        self._first_designs: list[float] = []  # how long they took

    def run(self, starts: Iterable[Array]) -> Iterator[ModelRun]:
        """Run the model from each of several outputs vectors, as `WorkerPool.run` does.

        Parameters
        ----------
        starts : iterable of (n,) arrays
            Values of all outputs before each run.

        Yields
        ------
        ModelRun
            Runs in the order of `starts`; one that took too long has failed for that reason, and
            so has one whose process has died.
        """
        for run in results_in_order(self._threads, self._run_one, starts):
            raise_unless_built(run)
            yield run

    def close(self) -> None:
        """End all processes, whatever they do."""
        with self._lock:
            self._closed = True
            for process in self._processes:
                process.kill()
        self._threads.shutdown(cancel_futures=True)
        for process in self._processes:
            process.join()

    def _run_one(self, start: Array) -> ModelRun:
        """Run the model from one outputs vector in the process of this thread."""
        limit, is_first = self._time_limit, getattr(self._of_thread, "worker", None) is None
        if is_first:
            self._of_thread.worker = self._start()
            with self._lock:
                limit += max(self._first_designs, default=COMPILING)
        process, connection = self._of_thread.worker
        begin = time.monotonic()
        try:
            connection.send(start)
            if connection.poll(limit):
                run: ModelRun = connection.recv()
                if is_first:
                    with self._lock:
                        self._first_designs.append(time.monotonic() - begin)
                return run
            failure = f"took longer than {limit:g} s"
        except (EOFError, OSError):  # nobody is there at the other end
            failure = "its process ended without a result: killed, out of memory or crashed"
        self._of_thread.worker = None
        process.kill()
        process.join()
        connection.close()
        return ModelRun(start, failure=failure)

    def _start(self) -> tuple[BaseProcess, Connection]:
        """Start a process and wait until it has built its model, or has failed to."""
        with self._lock:
            if self._closed:
                raise RuntimeError("the workers have been ended")
            process, connection = start_process(_serve, (self._task,), self._environment)
            self._processes = [known for known in self._processes if known.is_alive()]
            self._processes.append(process)
        connection.recv()
        return process, connection


def _serve(connection: Connection, task: bytes) -> None:
    """Run the model of a task from each outputs vector that comes."""
    build_model(task)
    connection.send("ready")
    with contextlib.suppress(EOFError):  # nobody asks any more
        while True:
            connection.send(run_model(task, connection.recv()))

"""Processes that work side by side on one machine, and results in the order of what was asked."""

from __future__ import annotations

import multiprocessing
import os
import signal
import threading
from collections.abc import Callable, Generator, Iterable, Mapping
from concurrent.futures import Executor, Future, ProcessPoolExecutor
from multiprocessing.connection import Connection
from multiprocessing.process import BaseProcess
from typing import Any, TypeVar

import threadpoolctl

Argument = TypeVar("Argument")
Result = TypeVar("Result")


class WorkerLostError(RuntimeError):
    """A worker ended, or could not be reached, before it had answered."""


def start_workers(
    n_workers: int, environment: Mapping[str, str] | None = None
) -> ProcessPoolExecutor:
    """Start processes that compute on one thread each.

    They are spawned, because a fork of a process with JAX in it may never wake up. The script that
    asks for them is imported by each of them and so has to be guarded by
    ``if __name__ == "__main__":``. They leave Ctrl-C to the process that started them and end with
    it, even when it is killed.

    Parameters
    ----------
    n_workers : int
        Number of processes; more than there are processor cores gain nothing.
    environment : mapping of str to str, optional
        Environment variables set in every worker.

    Returns
    -------
    concurrent.futures.ProcessPoolExecutor
        The workers. Leave its ``with`` block, or call ``shutdown()``, to end them.
    """
    return ProcessPoolExecutor(
        n_workers,
        mp_context=multiprocessing.get_context("spawn"),
        initializer=_begin,
        initargs=(dict(environment or {}),),
    )


def start_process(
    function: Callable[..., None], arguments: tuple[Any, ...], environment: Mapping[str, str]
) -> tuple[BaseProcess, Connection]:
    """Start one process like those of `start_workers`, which may be killed.

    Parameters
    ----------
    function : callable
        Function of a module, called in the process with its end of a connection and the arguments.
    arguments : tuple
        Arguments that pickle.
    environment : mapping of str to str
        Environment variables set in the process.

    Returns
    -------
    process : multiprocessing.process.BaseProcess
        The process.
    connection : multiprocessing.connection.Connection
        This end of the connection, on which an EOFError tells that the process has ended.
    """
    context = multiprocessing.get_context("spawn")
    here, there = context.Pipe()
    process = context.Process(
        target=_begin_with, args=(function, there, arguments, dict(environment)), daemon=True
    )
    process.start()
    there.close()
    return process, here


def use_one_thread() -> None:
    """Keep XLA and BLAS in this process to one thread each.

    For the workers of an executor of your own, as its ``initializer``: workers that use all cores
    each wait for one another. It has to be called before JAX computes anything.
    """
    os.environ["PJRT_NPROC"] = "1"  # XLA's thread pools; read when JAX first computes
    import propmdao.runtime.jax_setup  # noqa: F401 - loads BLAS: only what is loaded has its limit

    threadpoolctl.threadpool_limits(1)


def results_in_order(
    executor: Executor, function: Callable[[Argument], Result], arguments: Iterable[Argument]
) -> Generator[Result, None, None]:
    """Results of a function of one argument, each as soon as it and those before it are there.

    Whoever stops reading, by an error or ``close()``, cancels what has not begun.

    Parameters
    ----------
    executor : concurrent.futures.Executor
        Executor on which the function runs.
    function : callable
        Function that must not raise: it returns its errors, so that what is raised here is lost
        workers.
    arguments : iterable
        Argument of each call.

    Yields
    ------
    object
        Results of the function in the order of the arguments.

    Raises
    ------
    WorkerLostError
        When the executor gives no result.
    """
    tasks = list(arguments)  # first: an error of theirs is no lost worker
    futures: list[Future[Result]] = []
    try:
        futures.extend(executor.submit(function, task) for task in tasks)
        for future in futures:
            yield future.result()
    except Exception as error:
        raise WorkerLostError(
            f"a worker ended without a result ({type(error).__name__}: {error}). It was killed, ran"
            " out of memory or crashed, or its script starts workers when it is imported: put that"
            " under if __name__ == '__main__':"
        ) from error
    finally:
        for future in futures:
            future.cancel()


def _begin_with(
    function: Callable[..., None],
    connection: Connection,
    arguments: tuple[Any, ...],
    environment: dict[str, str],
) -> None:
    _begin(environment)
    function(connection, *arguments)


def _begin(environment: dict[str, str]) -> None:
    """Prepare a new worker."""
    os.environ.update(environment)
    use_one_thread()
    signal.signal(signal.SIGINT, signal.SIG_IGN)
    threading.Thread(target=_end_with_parent, daemon=True).start()


def _end_with_parent() -> None:
    parent = multiprocessing.parent_process()
    assert parent is not None
    parent.join()  # a worker holds both ends of its queue, so it would wait for tasks for ever
    os._exit(1)

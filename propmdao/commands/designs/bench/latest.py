"""One worker thread and one place for what it does next: what is stale is never worked on."""

from __future__ import annotations

import logging
import threading
from collections.abc import Callable, Iterator
from typing import Generic, TypeVar

_LOGGER = logging.getLogger("propmdao")
Job = TypeVar("Job")


class LatestOnly(Generic[Job]):
    """Work on the latest job in a thread of its own.

    A job that comes while another one waits takes its place. What is being worked on is left
    between two steps of it when something newer waits, but not twice in a row: who never pauses
    gets the later steps of every other job.

    Parameters
    ----------
    steps : callable
        Function of a job, an iterator that does a part of the work at each of its steps.
    refused : callable
        Function of a job and of one line, called where a step raises an error.
    """

    def __init__(
        self, steps: Callable[[Job], Iterator[None]], refused: Callable[[Job, str], None]
    ) -> None:
        self._steps, self._refused = steps, refused
        self._changed = threading.Condition()
        self._waiting: list[Job] = []
        self._is_idle, self._is_closed = True, False
        self._has_left = False
        self._thread = threading.Thread(target=self._work, name="bench", daemon=True)
        self._thread.start()

    def ask(self, job: Job) -> None:
        """Put a job in the place of the one that waits, if there is one."""
        with self._changed:
            self._waiting = [job]
            self._is_idle = False
            self._changed.notify_all()

    def wait(self, seconds: float) -> bool:
        """Wait until there is nothing left to do.

        Parameters
        ----------
        seconds : float
            Longest wait [s].

        Returns
        -------
        bool
            Whether there is nothing left to do.
        """
        with self._changed:
            return self._changed.wait_for(lambda: self._is_idle, seconds)

    def close(self, seconds: float = 5.0) -> None:
        """Let the thread end after the step that it is at; wait for it, but not longer [s]."""
        with self._changed:
            self._waiting, self._is_closed = [], True
            self._changed.notify_all()
        self._thread.join(seconds)

    def _work(self) -> None:
        while True:
            with self._changed:
                if not self._waiting:
                    self._is_idle = True
                    self._changed.notify_all()
                self._changed.wait_for(lambda: self._waiting or self._is_closed)
                if self._is_closed:
                    return
                job = self._waiting.pop()
            try:
                self._do(job)
            except ValueError as error:
                self._refused(job, str(error))
            except Exception as error:  # a fault of ours: the bench goes on, and says so
                _LOGGER.exception("propmdao bench: a design could not be analysed")
                self._refused(job, f"{type(error).__name__}: {error}")

    def _do(self, job: Job) -> None:
        """Take the steps of a job, or leave it."""
        for _ in self._steps(job):
            leaves = bool(self._waiting) and not self._has_left
            if leaves or self._is_closed:
                self._has_left = True
                return
        self._has_left = False

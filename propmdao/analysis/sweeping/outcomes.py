"""What becomes of points that are analysed at the same time: results, exceptions and warnings."""

from __future__ import annotations

import contextlib
import threading
import warnings
from collections.abc import Callable, Iterator
from typing import Any, Generic, NamedTuple, ParamSpec, TypeVar

Result = TypeVar("Result")
Given = ParamSpec("Given")


class Outcome(NamedTuple, Generic[Result]):
    """What has become of a point.

    Attributes
    ----------
    result : Analysis or Exception
        The analysis, or why there is none.
    warnings : list of str
        What was warned of, each once.
    """

    result: Result | Exception
    warnings: list[str]

    def said(self) -> Result:
        """Return the analysis, or raise why there is none, and warn of what was warned of."""
        for message in self.warnings:
            warnings.warn(message, stacklevel=2)
        if isinstance(self.result, Exception):
            raise self.result
        return self.result


class _Said(threading.local):
    """What a thread warns of, at the point that it is at."""

    def __init__(self) -> None:
        self.messages: list[str] = []


_SAID = _Said()


@contextlib.contextmanager
def hearing_warnings() -> Iterator[None]:
    """Let `outcome_of` hear what is warned of within the block, on its thread alone."""
    with warnings.catch_warnings():
        warnings.simplefilter("always")
        warnings.showwarning = _hear
        yield


def _hear(message: Warning | str, *_: Any, **__: Any) -> None:
    _SAID.messages.append(" ".join(str(message).split()))


def outcome_of(
    function: Callable[Given, Result], *args: Given.args, **kwargs: Given.kwargs
) -> Outcome[Result]:
    """Call a function within `hearing_warnings`.

    Parameters
    ----------
    function : callable
        The function, and its arguments.

    Returns
    -------
    Outcome
        Result of the function, or the exception that it raises, and what it warns of.
    """
    result: Result | Exception
    said: list[str] = []
    _SAID.messages = said
    try:
        result = function(*args, **kwargs)
    except Exception as error:  # a survey of thousands of points does not end at one of them
        result = error
    return Outcome(result, list(dict.fromkeys(said)))

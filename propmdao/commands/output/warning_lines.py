"""Warnings of a command as lines on stderr, none twice."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator

from propmdao.runtime.terminal import print_line


@contextlib.contextmanager
def warning_lines(command: str) -> Iterator[list[str]]:
    """Print what is warned of within the block, when it has ended.

    Parameters
    ----------
    command : str
        Name of the command.

    Yields
    ------
    list of str
        The warnings, once the block has ended.
    """
    messages: list[str] = []
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            yield messages
        finally:
            messages += dict.fromkeys(str(warning.message) for warning in caught)
            for message in messages:
                print_line(f"propmdao {command}: warning: {message}", error=True)

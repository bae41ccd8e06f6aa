"""Warnings of a command as lines on stderr, none twice."""

from __future__ import annotations

import contextlib
import warnings
from collections.abc import Iterator

from propmdao.runtime.terminal import print_line


@contextlib.contextmanager
def warning_lines(command: str) -> Iterator[None]:
    """Print what is warned of within the block, when it has ended.

    Parameters
    ----------
    command : str
        Name of the command.
    """
    with warnings.catch_warnings(record=True) as caught:
        warnings.simplefilter("always")
        try:
            yield
        finally:
            for message in dict.fromkeys(str(warning.message) for warning in caught):
                print_line(f"propmdao {command}: warning: {message}", error=True)

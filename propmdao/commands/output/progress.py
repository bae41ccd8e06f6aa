"""What a command tells of its way: lines on stderr, as log records of the logger ``propmdao``."""

from __future__ import annotations

import contextlib
import logging
import sys
import threading
from collections.abc import Iterator

from propmdao.runtime.terminal import print_line

_PATIENCE = 2.0  # s
LOGGER = logging.getLogger("propmdao")


class _Lines(logging.Handler):
    """Log records as lines on stderr."""

    def emit(self, record: logging.LogRecord) -> None:
        """Print a record."""
        print_line(record.getMessage(), error=True)


def tell_progress(is_quiet: bool) -> None:
    """Show progress on stderr, or not.

    Parameters
    ----------
    is_quiet : bool
        Whether progress is left out; warnings and errors are said all the same.
    """
    if not any(isinstance(handler, _Lines) for handler in LOGGER.handlers):
        LOGGER.addHandler(_Lines())
    LOGGER.setLevel(logging.WARNING if is_quiet else logging.INFO)


def progress(text: str) -> None:
    """Tell how far a command is.

    Parameters
    ----------
    text : str
        One line.
    """
    LOGGER.info("%s", text)


@contextlib.contextmanager
def telling_of_long_work(name: str) -> Iterator[None]:
    """Tell somebody at a terminal after two seconds that work goes on, and what may take so long.

    Parameters
    ----------
    name : str
        Name of the command, with which the line begins.
    """
    text = f"{name}: working; what a machine runs for the first time is compiled, up to a minute"
    timer = threading.Timer(_PATIENCE, progress, [text])
    timer.daemon = True
    if sys.stderr is not None and sys.stderr.isatty():
        timer.start()
    try:
        yield
    finally:
        timer.cancel()

"""What a command tells of its way: lines on stderr, as log records of the logger ``propmdao``."""

from __future__ import annotations

import logging

from propmdao.runtime.terminal import print_line

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

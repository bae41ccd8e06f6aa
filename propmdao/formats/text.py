"""Text files, read so that whatever is wrong with one is a single line."""

from __future__ import annotations

import os
from pathlib import Path


def read_text(path: str | os.PathLike[str], error: type[ValueError]) -> str:
    """Read a text file in UTF-8.

    Parameters
    ----------
    path : path
        The file.
    error : type
        Exception that is raised, a ValueError.

    Returns
    -------
    str
        Its text.

    Raises
    ------
    ValueError
        If it cannot be read or is no such text; the message begins with the path.
    """
    try:
        return Path(path).read_text(encoding="utf-8")
    except OSError as reason:
        raise error(f"{path}: cannot be read: {reason.strerror}") from reason
    except UnicodeDecodeError as reason:
        raise error(f"{path}: is not text in UTF-8") from reason

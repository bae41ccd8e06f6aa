"""The user's cache folder: what costs time to make again, and nothing else, is kept there."""

from __future__ import annotations

import contextlib
import hashlib
import io
import os
import tempfile
from collections.abc import Callable, Mapping
from pathlib import Path
from typing import TYPE_CHECKING

import platformdirs

from propmdao.runtime.output_files import OutputError, replacing

if TYPE_CHECKING:
    import numpy.typing as npt

#: Variable of the environment that puts the caches elsewhere.
FOLDER_VARIABLE = "PROPMDAO_CACHE_DIR"
# A file begins with this many bytes, the checksum of the archive behind them: an archive that is
# damaged here or there fails in many ways, or is read without a part.
_DIGEST = hashlib.sha256().digest_size
_of_process = {"programs": False}


def cache_folder(name: str) -> Path | None:
    """Folder of a cache, made where there is none.

    Parameters
    ----------
    name : str
        Name of the cache.

    Returns
    -------
    pathlib.Path or None
        Folder below ``PROPMDAO_CACHE_DIR``, or else below the platform's own place for caches
        (``~/.cache/propmdao`` on Linux); None where no folder can be written.
    """
    place = os.environ.get(FOLDER_VARIABLE)
    folder = Path(place or platformdirs.user_cache_dir("propmdao", appauthor=False)) / name
    try:
        folder.mkdir(parents=True, exist_ok=True)
        with tempfile.TemporaryFile(dir=folder):  # permission bits do not tell a read-only disk
            pass
    except OSError:
        return None
    return folder


def keep_programs() -> None:
    """Keep whole the programs that this process compiles from now on, and load those that are.

    They are found without a look at what their functions have become in a running process
    (`propmdao.runtime.kept_programs`), so this is for processes in which nothing but propmdao
    runs: those of the command line.
    """
    _of_process["programs"] = True


def programs_are_kept() -> bool:
    """Whether this process keeps its programs whole.

    Returns
    -------
    bool
        Whether `keep_programs` has been called.
    """
    return _of_process["programs"]


def kept_arrays(
    name: str, key: bytes, make: Callable[[], Mapping[str, npt.NDArray]]
) -> dict[str, npt.NDArray]:
    """Arrays of a cache, made where it does not have them.

    Processes that miss the same arrays at once all make them; files are replaced whole, so none
    reads half of one. A file that is damaged is made again, and where none can be written the
    arrays are made each time.

    Parameters
    ----------
    name : str
        Name of the cache.
    key : bytes
        All that the arrays depend on.
    make : callable
        Makes the arrays.

    Returns
    -------
    dict of arrays
        The arrays by name.
    """
    import numpy as np  # here: the command line asks for the rest of this module first

    folder = cache_folder(name)
    if folder is None:
        return dict(make())
    file = folder / hashlib.sha256(key).hexdigest()
    with contextlib.suppress(OSError):  # there is none yet
        content = file.read_bytes()
        digest, archive = content[:_DIGEST], content[_DIGEST:]
        if hashlib.sha256(archive).digest() == digest:
            with np.load(io.BytesIO(archive)) as members:
                return dict(members)
    arrays, stream = dict(make()), io.BytesIO()
    np.savez_compressed(stream, allow_pickle=False, **arrays)
    archive = stream.getvalue()
    with contextlib.suppress(OutputError), replacing(file) as new:  # a full disk
        new.write_bytes(hashlib.sha256(archive).digest() + archive)
    return arrays

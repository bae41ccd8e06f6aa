"""Files that are written whole or not at all: beside the old one, which is then replaced."""

from __future__ import annotations

import contextlib
import errno
import os
import secrets
import shutil
import tempfile
from collections.abc import Iterator
from pathlib import Path

_PREFIX = ".propmdao-"
_LONGEST_ENDING = 20


class OutputError(ValueError):
    """A file or folder cannot be written; the message is one line that begins with its path."""


@contextlib.contextmanager
def replacing(path: str | os.PathLike[str]) -> Iterator[Path]:
    """Write a file beside the one that it replaces at the end of the block.

    Whatever goes wrong, a file that was there is left as it was. What is no ordinary file, as
    ``/dev/stdout``, cannot be replaced and is written itself.

    Parameters
    ----------
    path : path
        The file; its folder must exist.

    Yields
    ------
    pathlib.Path
        File to write instead, in the same folder and with the same ending.

    Raises
    ------
    OutputError
        If the file cannot be written, also by an OSError within the block.
    """
    with _one_line(path):
        target = _target(path)
        if target.exists() and not target.is_file():
            yield target
            return
        temporary = _new_file(target)
        try:
            yield temporary
            _bring_to_disk(temporary)
            os.replace(temporary, target)
        finally:
            temporary.unlink(missing_ok=True)


@contextlib.contextmanager
def replacing_in(folder: str | os.PathLike[str]) -> Iterator[Path]:
    """Write files of a folder that belong together, none of them before all are whole.

    Parameters
    ----------
    folder : path
        The folder, made where there is none; files that are not written again are left alone.

    Yields
    ------
    pathlib.Path
        Empty folder to write the files to instead.

    Raises
    ------
    OutputError
        If a file cannot be written, also by an OSError within the block.
    """
    with _one_line(folder):
        place = Path(folder)
        is_new = not place.exists()
        place.mkdir(parents=True, exist_ok=True)
        try:
            with tempfile.TemporaryDirectory(prefix=_PREFIX, dir=place) as made:
                yield Path(made)
                files = sorted(Path(made).iterdir())
                for file in files:
                    _bring_to_disk(file)
                for file in files:
                    os.replace(file, place / file.name)
        except BaseException:
            if is_new:
                with contextlib.suppress(OSError):
                    place.rmdir()
            raise


def require_writable(path: str | os.PathLike[str]) -> None:
    """Refuse a file that `replacing` could not write, before the work.

    Parameters
    ----------
    path : path
        The file.

    Raises
    ------
    OutputError
        If it is a folder or cannot be written, or its folder is missing or cannot be written to.
    """
    with _one_line(path):
        target = _target(path)
        if target.exists() and not target.is_file():
            return
        if not target.parent.is_dir():
            raise OutputError(f"{path}: there is no folder {Path(path).parent}")
        _new_file(target).unlink()  # permission bits do not tell a read-only disk


def require_folder(folder: str | os.PathLike[str]) -> None:
    """Refuse a folder that cannot be made or written to, before the work; it is not made.

    Parameters
    ----------
    folder : path
        The folder.

    Raises
    ------
    OutputError
        If it is a file, lies below one, or it or what it lies in cannot be written to.
    """
    with _one_line(folder):
        place = Path(os.path.realpath(folder))
        while not _exists(place):
            place = place.parent
        if not place.is_dir():
            raise OutputError(f"{folder}: {place} is a file, not a folder")
        _new_file(place / "any").unlink()


def make_folder(folder: str | os.PathLike[str]) -> None:
    """Make a folder and those it lies in, where there is none.

    Parameters
    ----------
    folder : path
        The folder.

    Raises
    ------
    OutputError
        If it cannot be made.
    """
    with _one_line(folder):
        Path(folder).mkdir(parents=True, exist_ok=True)


def append(path: str | os.PathLike[str], content: bytes) -> None:
    """Add to the end of a file, which is as long as before when that fails.

    Parameters
    ----------
    path : path
        The file.
    content : bytes
        What is added: it is in the hands of the system when this returns.

    Raises
    ------
    OutputError
        If it cannot be written.
    """
    with _one_line(path), open(path, "ab", buffering=0) as file:
        before, left = file.tell(), memoryview(content)
        try:
            while left:  # a disk that becomes full takes the first part without a word
                left = left[file.write(left) :]
        except OSError:
            with contextlib.suppress(OSError):  # a device has no length
                file.truncate(before)
            raise


def reason_of(error: Exception) -> str:
    """Reason why a file could not be read or written, without its name.

    Parameters
    ----------
    error : Exception
        An OSError, or what stands for one.

    Returns
    -------
    str
        The system's words.
    """
    return getattr(error, "strerror", None) or str(error)


@contextlib.contextmanager
def _one_line(path: str | os.PathLike[str]) -> Iterator[None]:
    """Turn an OSError into an OutputError that names the path."""
    if "\0" in os.fspath(path):
        raise OutputError(f"{os.fspath(path)!r}: no file has a name with a NUL in it")
    try:
        yield
    except OSError as error:
        raise OutputError(f"{path}: cannot be written: {reason_of(error)}") from error


def _target(path: str | os.PathLike[str]) -> Path:
    """File behind links, unless it can never be written."""
    target = Path(os.path.realpath(path))
    if _exists(target):
        if target.is_dir():
            raise IsADirectoryError(errno.EISDIR, "it is a folder")
        if not os.access(target, os.W_OK):
            raise PermissionError(errno.EACCES, os.strerror(errno.EACCES))
    return target


def _exists(path: Path) -> bool:
    """Whether there is such a file or folder; an OSError where there can be none."""
    # Path.exists takes a name that is too long for one that is free, from Python 3.14 on.
    try:
        path.stat()
    except (FileNotFoundError, NotADirectoryError):
        return False
    return True


def _new_file(target: Path) -> Path:
    """Make an empty file beside a file, with its ending and rights."""
    ending = target.suffix if len(target.suffix) < _LONGEST_ENDING else ""
    temporary = target.with_name(f"{_PREFIX}{secrets.token_hex(6)}{ending}")
    os.close(os.open(temporary, os.O_CREAT | os.O_EXCL | os.O_WRONLY, 0o666))
    if target.exists():
        shutil.copymode(target, temporary)
    return temporary


def _bring_to_disk(file: Path) -> None:
    """Wait until a file is on the disk: a name must not be given to what is not there yet."""
    with file.open("rb+") as stream:
        os.fsync(stream.fileno())

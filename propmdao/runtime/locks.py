"""One process at a time on a file that grows: a lock file beside it."""

from __future__ import annotations

import contextlib
import os
import socket
import sys
import warnings
from collections.abc import Iterator
from pathlib import Path

from propmdao.runtime.output_files import reason_of

if sys.platform == "win32":
    import msvcrt
else:
    import errno
    import fcntl

# The system refuses to let others read what is locked on Windows, so that is not where the text is.
_LOCKED_BYTE = 1 << 30
_LONGEST_NOTE = 200


class InUseError(ValueError):
    """A file is in use by another run, here or in another process; the message is one line."""


@contextlib.contextmanager
def locked(path: str | os.PathLike[str]) -> Iterator[None]:
    """Keep everybody else off a file within the block.

    The lock is the operating system's own lock of a second file, ``PATH.lock``, so it ends with the
    process that holds it, even one that is killed: a lock file that is left behind locks nothing.
    Only those who ask for the lock are kept off.

    Parameters
    ----------
    path : path
        The file, which need not exist yet; its folder must.

    Raises
    ------
    InUseError
        If somebody else holds the lock; the message says who.
    ValueError
        If the lock file cannot be made.
    """
    lock = Path(f"{os.fspath(path)}.lock")
    handle = _opened(lock, path)
    try:
        try:
            os.ftruncate(handle, 0)
            os.lseek(handle, 0, os.SEEK_SET)
            os.write(handle, f"process {os.getpid()} on {socket.gethostname()}\n".encode())
        except OSError as error:  # a full disk: there is no room for the file either
            raise ValueError(f"'{path}' cannot be locked: {reason_of(error)}") from None
        yield
    finally:
        # Windows removes no open file, elsewhere it has to go before somebody else can lock it.
        if sys.platform == "win32":
            os.close(handle)
        with contextlib.suppress(OSError):
            lock.unlink()
        if sys.platform != "win32":
            os.close(handle)


def _opened(lock: Path, path: str | os.PathLike[str]) -> int:
    """Handle of the lock file, locked."""
    while True:
        try:
            handle = os.open(lock, os.O_RDWR | os.O_CREAT, 0o666)
        except (OSError, ValueError) as error:
            raise ValueError(f"'{path}' cannot be locked: {reason_of(error)}") from None
        try:
            if not _taken(handle, path):
                raise InUseError(
                    f"'{path}' is in use by {_holder(handle)}; wait until it has ended, or name"
                    " another file"
                )
            # Who held it may have removed it between our opening and our locking it.
            with contextlib.suppress(FileNotFoundError):
                if os.path.samestat(os.fstat(handle), lock.stat()):
                    return handle
        except BaseException:
            os.close(handle)
            raise
        os.close(handle)


def _taken(handle: int, path: str | os.PathLike[str]) -> bool:
    """Lock an open file; whether nobody else had."""
    try:
        if sys.platform == "win32":
            os.lseek(handle, _LOCKED_BYTE, os.SEEK_SET)
            msvcrt.locking(handle, msvcrt.LK_NBLCK, 1)
        else:
            # Not lockf: its lock is the process', which could then open the file twice.
            fcntl.flock(handle, fcntl.LOCK_EX | fcntl.LOCK_NB)
    except OSError as error:
        if sys.platform != "win32" and error.errno in (
            errno.ENOSYS,
            errno.ENOTSUP,
            errno.ENOLCK,
        ):
            warnings.warn(
                f"'{path}' is on a disk without locks ({error.strerror}): do not run two at once"
                " on it",
                stacklevel=4,
            )
            return True
        return False
    return True


def _holder(handle: int) -> str:
    """Name of the process that has locked an open file."""
    os.lseek(handle, 0, os.SEEK_SET)
    note = os.read(handle, _LONGEST_NOTE).decode(errors="replace").strip()
    # It is empty for a moment before it is written; what is not ours is not repeated.
    return note if note.startswith("process ") and note.isprintable() else "another process"

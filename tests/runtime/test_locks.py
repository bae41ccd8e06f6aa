"""One at a time: who comes second is told who is first, and nobody waits for the dead."""

from __future__ import annotations

import os
import signal
import subprocess
import sys
import threading
from pathlib import Path

import pytest

from propmdao.runtime.locks import InUseError, locked

HOLD = """
import sys
from propmdao.runtime.locks import locked
with locked(sys.argv[1]):
    print("held", flush=True)
    sys.stdin.read()
"""


@pytest.fixture
def path(tmp_path: Path) -> Path:
    return tmp_path / "table.csv"


def holder(path: Path) -> subprocess.Popen[str]:
    """A process that holds the lock until it reads the end of its input."""
    process = subprocess.Popen(
        [sys.executable, "-c", HOLD, str(path)],
        stdin=subprocess.PIPE,
        stdout=subprocess.PIPE,
        text=True,
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "held\n"
    return process


def test_another_process_is_told_who_holds_the_file(path: Path) -> None:
    with holder(path) as process:
        told = rf"table.csv' is in use by process {process.pid} on "
        with pytest.raises(InUseError, match=told), locked(path):
            pass
        assert process.stdin is not None
        process.stdin.close()
        assert process.wait(20) == 0
    with locked(path):
        assert Path(f"{path}.lock").exists()
    assert list(path.parent.iterdir()) == []


@pytest.mark.skipif(not hasattr(signal, "SIGKILL"), reason="no such signal on Windows")
def test_the_lock_of_a_killed_process_holds_nobody_up(path: Path) -> None:
    with holder(path) as process:
        process.kill()
        process.wait(20)
    assert Path(f"{path}.lock").exists()  # left behind
    with locked(path):
        pass


def test_the_same_process_cannot_lock_twice(path: Path) -> None:
    with locked(path):
        with pytest.raises(InUseError, match=f"process {os.getpid()} on"), locked(path):
            pass
        with pytest.raises(InUseError), locked(path):  # the refusal has not unlocked it
            pass
    with locked(path):
        pass


def test_the_lock_ends_with_the_block_also_after_an_error(path: Path) -> None:
    with pytest.raises(RuntimeError, match="within"), locked(path):
        raise RuntimeError("within")
    with locked(path):
        pass


def test_never_two_are_in_the_block(path: Path) -> None:
    """Locking and removing race with each other; a second file of that name is no second lock."""
    inside, most, times = [0], [0], [0]

    def often() -> None:
        for _ in range(200):
            try:
                with locked(path):
                    inside[0] += 1
                    most[0] = max(most[0], inside[0])
                    times[0] += 1
                    inside[0] -= 1
            except InUseError:
                continue

    threads = [threading.Thread(target=often) for _ in range(4)]
    for thread in threads:
        thread.start()
    for thread in threads:
        thread.join()
    assert most[0] == 1
    assert times[0] > 0


@pytest.mark.parametrize("name", ["no_folder/table.csv", "a\0b.csv", "x" * 300 + ".csv"])
def test_what_cannot_be_locked_is_one_line(tmp_path: Path, name: str) -> None:
    with (
        pytest.raises(ValueError, match="cannot be locked: ") as caught,
        locked(f"{tmp_path}/{name}"),
    ):
        pass
    assert "\n" not in str(caught.value)


def test_a_full_disk_is_one_line(path: Path) -> None:
    resource = pytest.importorskip("resource", reason="limits of processes are POSIX")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (0, hard))
    try:
        with pytest.raises(ValueError, match="cannot be locked: ") as caught, locked(path):
            pytest.fail("it is not locked")
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert "\n" not in str(caught.value) and list(path.parent.iterdir()) == []

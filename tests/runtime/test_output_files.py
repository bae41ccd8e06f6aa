"""Files whole or not at all: whatever goes wrong, what was there is left as it was."""

from __future__ import annotations

import os
import re
import stat
import sys
from collections.abc import Iterator
from pathlib import Path

import pytest

from propmdao.runtime.output_files import (
    OutputError,
    append,
    make_folder,
    replacing,
    replacing_in,
    require_folder,
    require_writable,
)

ROOM = 100_000  # bytes


@pytest.fixture
def full_disk() -> Iterator[None]:
    """No file grows beyond `ROOM`: the system refuses it in the middle, as a full disk does."""
    resource = pytest.importorskip("resource", reason="limits of processes are POSIX")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (ROOM, hard))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))


def names(folder: Path) -> list[str]:
    return sorted(file.name for file in folder.iterdir())


def test_a_file_is_replaced_at_the_end_of_the_block(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    with replacing(path) as file:
        file.write_text("new")
        assert path.read_text() == "old"
        assert file.parent == tmp_path and file.suffix == ".csv"
    assert path.read_text() == "new" and names(tmp_path) == ["a.csv"]


def test_an_error_leaves_the_old_file_and_nothing_else(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    with pytest.raises(KeyboardInterrupt), replacing(path) as file:
        file.write_text("half")
        raise KeyboardInterrupt
    assert path.read_text() == "old" and names(tmp_path) == ["a.csv"]


def test_a_full_disk_is_one_line_and_leaves_the_old_file(tmp_path: Path, full_disk: None) -> None:
    path = tmp_path / "a.csv"
    path.write_text("old")
    with (
        pytest.raises(OutputError, match=r"a\.csv: cannot be written: \w[^\n]*$"),
        replacing(path) as file,
    ):
        file.write_bytes(bytes(2 * ROOM))
    assert path.read_text() == "old" and names(tmp_path) == ["a.csv"]


def test_rights_and_links_stay(tmp_path: Path) -> None:
    path, link = tmp_path / "a.csv", tmp_path / "link.csv"
    path.write_text("old")
    path.chmod(0o640)
    link.symlink_to(path)
    with replacing(link) as file:
        file.write_text("new")
    assert link.is_symlink() and path.read_text() == "new"
    assert sys.platform == "win32" or stat.S_IMODE(path.stat().st_mode) == 0o640


@pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")
def test_a_device_is_written_itself(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    path.symlink_to("/dev/full")
    require_writable(path)
    with pytest.raises(OutputError, match="No space left on device"), replacing(path) as file:
        file.write_text("new")
    with pytest.raises(OutputError, match="No space left on device"):
        append(path, b"new")
    assert stat.S_ISCHR(os.stat("/dev/full").st_mode)


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        (".", "it is a folder"),
        ("no/a.csv", "there is no folder "),
        ("file/a.csv", "there is no folder "),
        ("x" * 300 + ".csv", "cannot be written: "),
        ("x/" * 5000 + "a.csv", "cannot be written: "),
        ("a\0b.csv", "no file has a name with a NUL in it"),
    ],
)
def test_what_cannot_be_written_is_one_line_before_the_work(
    tmp_path: Path, name: str, reason: str
) -> None:
    (tmp_path / "file").write_text("")
    path = f"{tmp_path}/{name}"
    with pytest.raises(OutputError, match=re.escape(reason)) as before:
        require_writable(path)
    with pytest.raises(OutputError) as after, replacing(path):
        pytest.fail("there is nothing to write to")
    assert "\n" not in str(before.value) + str(after.value)
    assert names(tmp_path) == ["file"]


def test_asking_writes_nothing(tmp_path: Path) -> None:
    path = tmp_path / "a.csv"
    require_writable(path)
    require_folder(tmp_path / "new" / "folder")
    assert names(tmp_path) == []
    path.write_text("old")
    require_writable(path)
    assert path.read_text() == "old"


@pytest.mark.parametrize(
    ("name", "reason"),
    [
        ("file", "is a file, not a folder"),
        ("file/below", "is a file, not a folder"),
        ("x" * 300, "cannot be written: "),
        ("a\0b", "no file has a name with a NUL in it"),
    ],
)
def test_folders_that_cannot_be_made(tmp_path: Path, name: str, reason: str) -> None:
    (tmp_path / "file").write_text("")
    for refuse in (require_folder, make_folder):
        with pytest.raises(OutputError) as caught:
            refuse(f"{tmp_path}/{name}")
        assert "\n" not in str(caught.value)
        assert refuse is make_folder or reason in str(caught.value)


@pytest.mark.skipif(
    sys.platform == "win32" or os.geteuid() == 0, reason="nothing is forbidden to root"
)
def test_what_is_forbidden_is_known_before_the_work(tmp_path: Path) -> None:
    folder = tmp_path / "folder"
    folder.mkdir(mode=0o500)
    for refuse in (require_folder, require_writable):
        with pytest.raises(OutputError, match="Permission denied"):
            refuse(folder / "a")


def test_files_of_a_folder_are_replaced_together(tmp_path: Path, full_disk: None) -> None:
    folder = tmp_path / "new" / "folder"
    with replacing_in(folder) as files:
        (files / "a").write_text("old")
        (files / "b").write_text("old")
        assert not (folder / "a").exists()
    (folder / "kept").write_text("of somebody")
    with pytest.raises(OutputError, match="folder: cannot be written: "), replacing_in(folder) as f:
        (f / "a").write_text("new")
        (f / "b").write_bytes(bytes(2 * ROOM))
    assert names(folder) == ["a", "b", "kept"] and (folder / "a").read_text() == "old"
    with pytest.raises(RuntimeError), replacing_in(tmp_path / "other"):
        raise RuntimeError
    assert names(tmp_path) == ["new"]


def test_what_cannot_be_added_leaves_no_piece(tmp_path: Path, full_disk: None) -> None:
    path = tmp_path / "a.csv"
    append(path, b"first\n")
    with pytest.raises(OutputError, match=r"a\.csv: cannot be written: "):
        append(path, bytes(2 * ROOM))
    append(path, b"second\n")
    assert path.read_bytes() == b"first\nsecond\n"

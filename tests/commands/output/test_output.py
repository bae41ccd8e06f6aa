"""What is written: known to be possible before the work, and one line when it is not."""

from __future__ import annotations

import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

PROPELLER = "apcsf_11x4.7"
full_device = pytest.mark.skipif(not Path("/dev/full").exists(), reason="no such device")


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("analyze {p} --rpm 4000 --arc 2 0 --wav folder.wav", "--wav folder.wav: cannot be"),
        ("analyze {p} --rpm 4000 --arc 2 0 --wav file/a.wav", "there is no folder file"),
        ("analyze {p} --rpm 4000 --arc 2 0 --figures file", "file is a file, not a folder"),
        ("analyze {p} --rpm 4000 --arc 2 0 --figures file/a", "file is a file, not a folder"),
        ("analyze {p} --rpm 4000 --arc 2 0 --wav {long}.wav", ".wav: cannot be written: "),
        ("flyover {p} --rpm 4000 --speed 8 --height 9 --out folder.csv", "it is a folder"),
        ("flyover {p} --rpm 4000 --speed 8 --height 9 --wav folder.wav", "it is a folder"),
        ("flyover {p} --rpm 4000 --speed 8 --height 9 --figures file", "not a folder"),
        ("export {p} --to folder.stl", "it is a folder"),
        ("export {p} --rpm 4000 --arc 2 0 --to file", "file is a file, not a folder"),
        ("export {p} --rpm 4000 --arc 2 0 --to file/case", "file is a file, not a folder"),
        ("sweep {p} --rpm 4000 --out folder.csv", "folder.csv: cannot be written: it is a folder"),
        ("sweep {p} --rpm 4000 --out file/a/b.csv", "file/a: cannot be written: Not a directory"),
        ("sweep {p} --rpm 4000 --out file/b.csv", "file: cannot be written: File exists"),
        ("sweep {p} --rpm 4000 --out {long}.csv", ".csv"),
        ("wopwop {p} --out folder.csv", "--out folder.csv: cannot be written: it is a folder"),
        ("wopwop {p} --out file/a.csv", "there is no folder file"),
    ],
)
def test_what_cannot_be_written_is_known_before_the_analysis(
    recorder: Any,
    refused: Callable[..., str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    arguments: str,
    message: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    (tmp_path / "file").write_text("kept")
    for ending in (".wav", ".csv", ".stl"):
        (tmp_path / f"folder{ending}").mkdir()
    line = arguments.format(p=PROPELLER, long="x" * 300)
    assert message in refused(*line.split())
    assert recorder.asked == []
    assert (tmp_path / "file").read_text() == "kept"
    assert sorted(path.name for path in tmp_path.iterdir()) == [
        "file", "folder.csv", "folder.stl", "folder.wav",
    ]  # fmt: skip


@pytest.mark.parametrize("option", ["--wav", "--figures"])
def test_a_nul_in_a_path_is_one_line(
    recorder: Any, refused: Callable[..., str], option: str
) -> None:
    observers = ("--arc", "2", "0")
    name = "a\0b.wav"
    line = refused("analyze", PROPELLER, "--rpm", "4000", *observers, option, name)
    assert "no file has a name with a NUL in it" in line and "\0" not in line
    assert recorder.asked == []


def ended(*arguments: str, **streams: Any) -> tuple[int, str]:
    """Exit status and what is on stderr."""
    result = subprocess.run(
        [sys.executable, "-m", "propmdao", *arguments],
        stderr=subprocess.PIPE,
        text=True,
        check=False,
        **streams,
    )
    return result.returncode, result.stderr


@full_device
@pytest.mark.parametrize("arguments", [["list"], ["list", "--json"], ["--version"], ["--help"]])
@pytest.mark.parametrize("unbuffered", ["", "1"])
def test_output_to_a_full_disk_is_one_line(
    arguments: list[str], unbuffered: str, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("PYTHONUNBUFFERED", unbuffered)
    name = "propmdao list" if arguments[0] == "list" else "propmdao"
    with open("/dev/full", "w") as full:
        assert ended(*arguments, stdout=full) == (
            2,
            f"{name}: error: output cannot be written: No space left on device\n",
        )


@pytest.mark.skipif(sys.platform == "win32", reason="a shell that closes streams")
def test_a_closed_output_is_one_line() -> None:
    result = subprocess.run(
        f"exec '{sys.executable}' -m propmdao list >&-",
        shell=True,
        stderr=subprocess.PIPE,
        text=True,
        check=False,
    )
    assert (result.returncode, result.stderr) == (2, "propmdao: error: standard output is closed\n")


@full_device
def test_a_failed_export_is_one_line_and_leaves_the_file(
    refused: Callable[..., str], tmp_path: Path
) -> None:
    resource = pytest.importorskip("resource")
    path = tmp_path / "blade.stl"
    path.write_text("good")
    soft, hard = resource.getrlimit(resource.RLIMIT_FSIZE)
    resource.setrlimit(resource.RLIMIT_FSIZE, (100_000, hard))
    try:
        line = refused("export", PROPELLER, "--to", str(path))
    finally:
        resource.setrlimit(resource.RLIMIT_FSIZE, (soft, hard))
    assert f"{path}: cannot be written: " in line
    assert path.read_text() == "good" and len(list(tmp_path.iterdir())) == 1


@pytest.mark.parametrize(
    "line",
    [
        "analyze {p} --rpm 4000 --arc 2 0 --figures new",
        "flyover {p} --rpm 4000 --speed 8 --height 9 --figures new",
    ],
)
def test_figures_without_matplotlib_are_one_line_before_the_analysis(
    recorder: Any,
    refused: Callable[..., str],
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
    line: str,
) -> None:
    monkeypatch.chdir(tmp_path)
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    message = refused(*line.format(p=PROPELLER).split())
    assert "--figures needs matplotlib: pip install 'propmdao[plots]'" in message
    assert recorder.asked == [] and not (tmp_path / "new").exists()

"""Names from files in tables, messages and errors: as they are written, and never obeyed."""

from __future__ import annotations

import dataclasses
from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

from propmdao.commands.program import main
from propmdao.formats.propellers import load_propeller
from propmdao.formats.toml_files import write_toml

PROPELLER = load_propeller("apcsf_11x4.7")
NAMES = {
    "[bold]x[/bold][/foo]": "[bold]x[/bold][/foo]",
    "a\x1b[31mb": r"a\x1b[31mb",
    "a\nb\r\tc": r"a\nb\r\tc",
    ":smile: \u202e": r":smile: \u202e",
}


@pytest.fixture(params=NAMES, ids=["markup", "escape", "lines", "emoji"])
def named(request: pytest.FixtureRequest, tmp_path: Path) -> tuple[Path, str]:
    """File of a propeller with such a name, and the name as it is to be shown."""
    path = tmp_path / "p.toml"
    write_toml(path, dataclasses.replace(PROPELLER, name=request.param))
    return path, NAMES[request.param]


def test_a_name_in_tables_is_what_the_file_says(
    recorder: Any, capsys: pytest.CaptureFixture[str], named: tuple[Path, str]
) -> None:
    path, shown = named
    assert main(["analyze", str(path), "--rpm", "4000"]) == 0
    assert capsys.readouterr().out.startswith(f"{shown}: 2 blades, diameter ")


def test_a_name_in_messages_is_what_the_file_says(
    capsys: pytest.CaptureFixture[str], named: tuple[Path, str], tmp_path: Path
) -> None:
    path, shown = named
    out = tmp_path / "section.dat"
    assert main(["export", str(path), "--section", "0.75", "--to", str(out)]) == 0
    assert capsys.readouterr().out.count("\n") == 1
    title, *points = out.read_text().splitlines()
    assert title == f"{shown} at r/R 0.75" and len(points) > 100


@pytest.mark.parametrize("name", NAMES)
def test_errors_show_what_was_typed(refused: Callable[..., str], name: str) -> None:
    line = refused("analyze", f"{name}.toml", "--rpm", "4000")
    assert NAMES[name] in line
    line = refused("analyze", "apcsf_11x4.7", "--rpm", "4000", f"--{name}")
    assert NAMES[name] in line

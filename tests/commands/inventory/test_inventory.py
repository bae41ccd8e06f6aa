"""``show``, ``doctor``, ``completion``, and what is said of long work."""

from __future__ import annotations

import io
import json
import logging
import sys
import time
from collections.abc import Callable
from pathlib import Path

import pytest

from propmdao.commands.inventory.doctor_command import EXTRAS
from propmdao.commands.output import progress as talk
from propmdao.commands.program import build_parser, main
from propmdao.formats.propellers import load_propeller

PROPELLER = "apcsf_11x4.7"


def test_a_propeller_is_shown_in_millimetres_and_in_json(
    capsys: pytest.CaptureFixture[str], tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    propeller = load_propeller(PROPELLER)
    assert main(["show", PROPELLER]) == 0
    lines = capsys.readouterr().out.splitlines()
    (tip,) = (line.split() for line in lines if line.split()[:1] == ["1.000"])
    assert float(tip[1]) == pytest.approx(500.0 * propeller.diameter)
    chord = 500.0 * propeller.diameter * propeller.c_over_R[-1]
    assert float(tip[2]) == pytest.approx(chord, abs=0.01)
    assert float(tip[3]) == pytest.approx(propeller.beta_deg[-1], abs=0.01)
    assert any("e63, polars: catalogue" in line for line in lines)
    assert main(["show", PROPELLER, "--json"]) == 0
    shown = json.loads(capsys.readouterr().out)
    assert shown["beta_deg"] == propeller.beta_deg.tolist()
    assert len(shown["camber_over_chord"]) == propeller.r_over_R.size
    pytest.importorskip("matplotlib")
    assert main(["show", PROPELLER, "--figures", str(tmp_path)]) == 0
    assert {file.name for file in tmp_path.iterdir()} == {"blade.png", "distributions.png"}


def test_doctor_says_what_there_is_and_that_it_works(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["doctor", "--json"]) == 0
    found = json.loads(capsys.readouterr().out)
    assert found["versions"]["python"] == sys.version.split()[0]
    assert found["processor cores"] >= 1 and found["devices"]
    assert set(found["extras"]) == set(EXTRAS)
    assert found["check"]["thrust"] > 1.0
    assert found["compiled code"]["megabytes"] >= 0.0


def test_extras_are_those_of_the_project(checkout: Path) -> None:
    import tomllib

    project = tomllib.loads((checkout / "pyproject.toml").read_text())["project"]
    assert set(EXTRAS) == set(project["optional-dependencies"]) - {"test", "lint", "docs"}


def test_completion_knows_commands_and_options(capsys: pytest.CaptureFixture[str]) -> None:
    pytest.importorskip("shtab")
    assert main(["completion", "bash"]) == 0
    script = capsys.readouterr().out
    assert all(word in script for word in ("analyze", "optimise", "--torque-max", "--hemisphere"))


def test_completion_without_shtab_is_one_line(
    refused: Callable[..., str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("importlib.util.find_spec", lambda name: None)
    assert "pip install 'propmdao[completion]'" in refused("completion", "bash")


def test_every_command_can_be_quiet() -> None:
    (commands,) = (action for action in build_parser()._actions if isinstance(action.choices, dict))
    for name, command in commands.choices.items():
        assert "--quiet" in command.format_help(), name


class Terminal(io.StringIO):
    def isatty(self) -> bool:
        return True


def test_long_work_is_told_to_who_sits_at_a_terminal(monkeypatch: pytest.MonkeyPatch) -> None:
    monkeypatch.setattr(talk, "_PATIENCE", 0.01)

    def said(stream: io.StringIO, is_quiet: bool, seconds: float) -> str:
        monkeypatch.setattr(sys, "stderr", stream)
        talk.tell_progress(is_quiet)
        with talk.telling_of_long_work("propmdao analyze"):
            time.sleep(seconds)
        return stream.getvalue()

    assert said(Terminal(), False, 0.3).startswith("propmdao analyze: working; ")
    assert said(Terminal(), True, 0.3) == ""
    assert said(io.StringIO(), False, 0.3) == ""
    assert logging.getLogger("propmdao").handlers

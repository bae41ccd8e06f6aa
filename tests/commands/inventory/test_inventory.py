"""``show``, ``doctor``, ``warm-up`` and ``completion``."""

from __future__ import annotations

import json
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from propmdao.commands.inventory import warm_up_command
from propmdao.commands.inventory.doctor_command import EXTRAS
from propmdao.commands.program import build_parser, main
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller
from propmdao.runtime.caches import FOLDER_VARIABLE

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


def test_warm_up_tells_what_it_has_compiled(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path))
    seen: list[object] = []

    def works(propeller: Propeller, observers: np.ndarray) -> dict[str, Callable[[], None]]:
        return {"all there is": lambda: seen.append((propeller.name, len(observers)))}

    monkeypatch.setattr(warm_up_command, "_works", works)
    assert main(["warm-up"]) == 0
    assert main(["warm-up", "apce_10x5", "--arc", "2", "-45", "0"]) == 0
    assert seen == [(PROPELLER, 1), ("apce_10x5", 2)]
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].startswith("all there is: 0.0 s")
    assert lines[1].startswith("all: 0.") and lines[1].endswith(f"kept in {tmp_path}")


def test_warm_up_is_refused_where_it_is_for_nothing(
    refused: Callable[..., str], monkeypatch: pytest.MonkeyPatch, tmp_path: Path
) -> None:
    assert "observer 1 is inside the source region" in refused("warm-up", "--arc", "0.1", "0")
    (tmp_path / "file").write_text("")
    monkeypatch.setenv(FOLDER_VARIABLE, str(tmp_path / "file"))
    assert "no cache can be written: PROPMDAO_CACHE_DIR" in refused("warm-up")


@pytest.mark.slow
def test_after_a_warm_up_nothing_is_compiled(tmp_path: Path) -> None:
    environment = {**os.environ, FOLDER_VARIABLE: str(tmp_path)}

    def run(command: str) -> int:
        arguments = [sys.executable, "-m", "propmdao", *command.split()]
        subprocess.run(arguments, env=environment, capture_output=True, check=True)
        return sum(len(list((tmp_path / name).rglob("*"))) for name in ("jax", "programs"))

    n_files = run("warm-up apce_10x5 --arc 2 -45 0")
    assert n_files > 20
    for asked in ("--rpm 5000", "--thrust 1.5", "--rpm 5000 --broadband"):
        assert run(f"analyze apce_10x5 {asked} --speed 8 --arc 1.5 -60 10") == n_files, asked


def test_every_command_can_be_quiet() -> None:
    (commands,) = (action for action in build_parser()._actions if isinstance(action.choices, dict))
    for name, command in commands.choices.items():
        assert "--quiet" in command.format_help(), name

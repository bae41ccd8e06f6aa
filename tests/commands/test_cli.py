"""The command line as a whole: its catalogue, version, and how it ends."""

from __future__ import annotations

import json
import os
import subprocess
import sys
import types

import pytest

import propmdao
from propmdao.commands.program import main
from propmdao.propeller.catalog import catalog_names
from propmdao.propeller.motors import motors

PROPELLER = "apcsf_11x4.7"


def test_list_names_the_whole_catalogue(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    table = capsys.readouterr().out
    assert catalog_names()
    assert all(name in table for name in [*catalog_names(), *motors()])


def test_list_as_json_says_where_the_numbers_come_from(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--json"]) == 0
    propellers = json.loads(capsys.readouterr().out)
    assert [propeller["name"] for propeller in propellers] == catalog_names()
    assert all(propeller["source"] and propeller["diameter"] > 0 for propeller in propellers)


def test_interrupt_ends_quietly(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    module = types.SimpleNamespace(analyze_each=interrupted)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.sweeping.batches", module)
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 130
    output = capsys.readouterr()
    assert output.out == output.err == ""


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_a_closed_pipe_ends_quietly(form: list[str]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as pipe:
        result = subprocess.run(
            [sys.executable, "-m", "propmdao", "list", *form],
            stdout=pipe,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.stderr == ""
    assert result.returncode == 1


def test_version_is_that_of_the_package() -> None:
    command = [sys.executable, "-m", "propmdao", "--version"]
    version = subprocess.run(command, capture_output=True, text=True, check=False)
    assert (version.returncode, version.stderr) == (0, "")
    assert version.stdout == f"propmdao {propmdao.__version__}\n"

"""``propmdao bench``: what it refuses before there is a page, and what it hands on; no physics."""

from __future__ import annotations

import importlib.util
from typing import Any

import numpy as np
import pytest

from propmdao.commands.program import main

BLADE = "apcsf_11x4.7"


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ("--save bent.json", "--save bent.json: the file must end in .toml"),
        ("--save no/bent.toml", "--save no/bent.toml: there is no folder"),
        ("--port 70000", "--port must be within 0 ... 65535; it is 70000"),
        ("--listen-at 2 -95", "elevation of --listen-at must be within -90 ... 90 deg; it is -95"),
        ("--listen-at 0 -45", "radius of --listen-at must be within 0.001 ... 1000000 m"),
        ("--rpm 0", "--rpm 0: the rotor of a bench turns"),
        ("--rpm 4000 --thrust 2", "not allowed with argument"),
    ],
)
def test_bad_input_is_one_line(
    options: str, message: str, tmp_path: Any, monkeypatch: Any, capsys: Any
) -> None:
    monkeypatch.chdir(tmp_path)
    try:
        status = main(["bench", BLADE, *options.split()])
    except SystemExit as end:
        status = end.code
    said = capsys.readouterr().err
    assert status == 2 and message in said and said.count("\n") == 1


def test_what_is_not_installed_is_said(monkeypatch: Any, capsys: Any) -> None:
    known = importlib.util.find_spec
    monkeypatch.setattr(
        importlib.util, "find_spec", lambda name: None if name == "starlette" else known(name)
    )
    assert main(["bench", BLADE]) == 2
    assert capsys.readouterr().err.endswith("pip install 'propmdao[bench]'\n")


def test_the_bench_and_its_address_are_handed_on(
    tmp_path: Any, monkeypatch: Any, capsys: Any
) -> None:
    server = pytest.importorskip("propmdao.commands.designs.bench.server")
    workbench = importlib.import_module("propmdao.commands.designs.bench.workbench")
    made, served = [], []
    monkeypatch.setattr(workbench, "Workbench", lambda *given: made.append(given) or "bench")
    monkeypatch.setattr(server, "serve", lambda *given: served.append(given))
    monkeypatch.chdir(tmp_path)
    assert main(["bench", BLADE, "--no-browser", "--save", "bent.toml"]) == 0
    ((propeller, request, microphone, file),) = made
    ((bench, opened, key, opens_browser),) = served
    # A tip Mach number of 0.2 and five diameters, to two digits.
    assert request.point.rpm == 4700.0 and microphone == (1.4, -45.0)
    assert propeller.name == BLADE and str(file) == "bent.toml"
    assert np.linalg.norm(request.listening.observers) == pytest.approx(1.4)
    assert request.model.noise.broadband is not None
    assert bench == "bench" and opens_browser is False and len(key) >= 20
    assert f"/{key}/ (Ctrl-C ends it)" in capsys.readouterr().out

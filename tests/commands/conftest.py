"""The command line without the physics behind it."""

from __future__ import annotations

import math
import sys
import types
from collections.abc import Callable
from typing import Any

import pytest

from propmdao.commands.program import main


class Recorder:
    """In place of `propmdao.analyze`: keeps what it was asked, answers at once."""

    def __init__(self) -> None:
        self.calls: list[dict[str, Any]] = []

    def analyze(self, propeller: object, **asked: Any) -> types.SimpleNamespace:
        self.calls.append(asked)
        return types.SimpleNamespace(to_dict=lambda: self.found(asked))

    def found(self, asked: dict[str, Any]) -> dict[str, Any]:
        point = dict.fromkeys(["J", "torque", "shaft_power", "CT", "CQ", "CP"], 0.5)
        levels = dict.fromkeys(["spl_bpf_db", "oaspl_db", "oaspl_loading_db", "oaspl_dba"], 50.0)
        return {
            "rpm": 4000.0 if asked["rpm"] is None else asked["rpm"],
            "speed": asked["speed"],
            "rho": asked["density"],
            **point,
            "thrust": 1.5,
            "eta": math.nan,
            "viscous": asked["viscous"],
            "converged": True,
            "failure": None,
            "trip": asked["trip"] if asked["broadband"] else None,
            "observers": [
                {"elevation_deg": elevation, "azimuth_deg": azimuth, "radius": radius, **levels}
                | {"oaspl_thickness_db": -math.inf, "harmonics": [], "third_octave": []}
                for radius, elevation, azimuth in asked["observers"]
            ],
        }


@pytest.fixture
def recorder(monkeypatch: pytest.MonkeyPatch) -> Recorder:
    recorder = Recorder()
    module = types.SimpleNamespace(analyze=recorder.analyze)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.single_point", module)
    return recorder


@pytest.fixture
def refused(capsys: pytest.CaptureFixture[str]) -> Callable[..., str]:
    """Gives the one line on stderr with which the command line refuses arguments."""

    def refuse(*arguments: str) -> str:
        try:
            status = main(arguments)
        except SystemExit as exit_:
            status = exit_.code
        output = capsys.readouterr()
        assert status == 2
        assert output.out == ""
        assert output.err.startswith("propmdao")
        assert output.err.count("\n") == 1 and output.err.endswith("\n")
        return output.err

    return refuse

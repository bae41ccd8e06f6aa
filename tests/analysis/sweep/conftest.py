"""Sweeps without the physics behind them."""

from __future__ import annotations

import sys
import types
import warnings
from typing import Any

import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller


class Analyzer:
    """In place of `propmdao.analysis.single_point`: thrust is rpm squared, 13 m/s is too fast."""

    def __init__(self) -> None:
        self.calls: list[tuple[Propeller, dict[str, Any]]] = []

    def analyze(self, propeller: Propeller, **asked: Any) -> Analyzer:
        self.calls.append((propeller, asked))
        if asked["speed"] == 11.0:
            warnings.warn("Reynolds numbers below\nthe tables", stacklevel=2)
        if asked["speed"] == 13.0:
            raise ValueError("thrust 1 N is out of reach")
        if asked["speed"] == 14.0:
            raise FloatingPointError("underflow")
        return self

    def to_dict(self) -> dict[str, Any]:
        _, asked = self.calls[-1]
        rpm = 4000.0 if asked["rpm"] is None else asked["rpm"]
        levels = {f"{name}_db": 50.0 for name in ("spl_bpf", "oaspl", "oaspl_thickness")}
        return {
            **dict.fromkeys("J torque shaft_power CT CQ CP eta".split(), 0.5),
            "rpm": rpm,
            "speed": asked["speed"],
            "rho": asked["density"],
            "thrust": rpm**2,
            "converged": True,
            "observers": [
                {**levels, "oaspl_loading_db": 40.0, "oaspl_dba": 30.0, "oaspl_broadband_db": 45.0}
                for _ in asked["observers"]
            ],
        }


@pytest.fixture
def analyzer(monkeypatch: pytest.MonkeyPatch) -> Analyzer:
    analyzer = Analyzer()
    module = types.SimpleNamespace(analyze=analyzer.analyze)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.single_point", module)
    return analyzer


@pytest.fixture
def propeller() -> Propeller:
    return load_propeller("apcsf_11x4.7")

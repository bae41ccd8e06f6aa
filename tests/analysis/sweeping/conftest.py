"""Sweeps without the physics behind them."""

from __future__ import annotations

import sys
import types
import warnings
from collections.abc import Iterator, Sequence
from typing import Any

import pytest

from propmdao.analysis.request import Request
from propmdao.analysis.sweeping.outcomes import Outcome
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.description import Propeller


class Answer:
    """In place of `propmdao.Analysis`: thrust is rpm squared, all levels are the same."""

    def __init__(self, request: Request) -> None:
        self.request = request

    def to_dict(self) -> dict[str, Any]:
        point = self.request.point
        rpm = 4000.0 if point.rpm is None else point.rpm
        levels = {f"{name}_db": 50.0 for name in ("spl_bpf", "oaspl", "oaspl_thickness")}
        levels |= {"oaspl_loading_db": 40.0, "oaspl_dba": 30.0}
        if self.request.model.noise.broadband is not None:
            levels |= {"oaspl_broadband_db": 45.0, "oaspl_broadband_dba": 43.0}
            levels |= {"oaspl_total_db": 51.0, "oaspl_total_dba": 43.2}
        return {
            **self.request.to_dict(),
            **dict.fromkeys("J torque shaft_power CT CQ CP eta".split(), 0.5),
            "rpm": rpm,
            "speed": point.speed,
            "rho": point.air.density,
            "thrust": rpm**2,
            "converged": True,
            "failure": None,
            "hub_force": [0.1, -0.2, rpm**2],
            "hub_moment": [0.01, -0.02, -0.5],
            "observers": [dict(levels) for _ in self.request.listening.observers],
        }


class Analyzer:
    """In place of `analysis.sweeping.batches`: keeps what was asked; 13 m/s is too fast."""

    def __init__(self) -> None:
        self.asked: list[Request] = []

    def analyze(self, propeller: Propeller, **asked: Any) -> Answer:
        request = Request.of(**asked)
        self.asked.append(request)
        if request.point.speed == 11.0:
            warnings.warn("Reynolds numbers below\nthe tables", stacklevel=2)
        if request.point.speed == 13.0:
            raise ValueError("thrust 1 N is out of reach")
        if request.point.speed == 14.0:
            raise FloatingPointError("underflow")
        return Answer(request)

    def analyze_each(self, propeller: Propeller, asked: Sequence[Any]) -> Iterator[Outcome[Any]]:
        for values in asked:
            result: Any
            with warnings.catch_warnings(record=True) as caught:
                warnings.simplefilter("always")
                try:
                    result = self.analyze(propeller, **values)
                except Exception as error:
                    result = error
            yield Outcome(result, [" ".join(str(w.message).split()) for w in caught])


@pytest.fixture
def analyzer(monkeypatch: pytest.MonkeyPatch) -> Analyzer:
    analyzer = Analyzer()
    module = types.SimpleNamespace(analyze_each=analyzer.analyze_each)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.sweeping.batches", module)
    return analyzer


@pytest.fixture
def answer() -> type[Answer]:
    """Class of the answers, to change what they say."""
    return Answer


@pytest.fixture
def propeller() -> Propeller:
    return load_propeller("apcsf_11x4.7_uiuc")

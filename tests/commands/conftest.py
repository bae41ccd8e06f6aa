"""The command line without the physics behind it."""

from __future__ import annotations

import dataclasses
import importlib
import sys
import types
from collections.abc import Callable, Iterator, Sequence
from typing import Any

import pytest

from propmdao.acoustics.kinematics.observers import directions
from propmdao.analysis.request import Request
from propmdao.analysis.sweeping.outcomes import Outcome
from propmdao.commands.program import main
from propmdao.propeller.description import Propeller


@dataclasses.dataclass
class Answer:
    """In place of `propmdao.Analysis`: says what was asked, and the same numbers to everybody."""

    propeller: Propeller
    request: Request
    polars: dict[str, str] = dataclasses.field(default_factory=dict)

    @property
    def listening(self) -> Any:
        return self.request.listening

    def to_dict(self) -> dict[str, Any]:
        asked = self.request
        point = dict.fromkeys(["J", "torque", "shaft_power", "CT", "CQ", "CP"], 0.5)
        levels = dict.fromkeys(["spl_bpf_db", "oaspl_db", "oaspl_loading_db", "oaspl_dba"], 50.0)
        if asked.model.noise.broadband is not None:
            levels |= {"oaspl_broadband_db": 61.0, "oaspl_broadband_dba": 62.0}
            levels |= {"oaspl_total_db": 63.0, "oaspl_total_dba": 64.0}
        names = ("name", "diameter", "n_blades", "source")
        return {
            "propeller": {name: getattr(self.propeller, name) for name in names},
            **asked.to_dict(),
            "polars": self.polars,
            "rpm": 4000.0 if asked.point.rpm is None else asked.point.rpm,
            "speed": asked.point.speed,
            "rho": asked.point.air.density,
            **point,
            "thrust": 1.5,
            "eta": 0.5,
            "figure_of_merit": 0.5,
            "converged": True,
            "failure": None,
            "hub_force": [0.0, 0.0, 1.5],
            "hub_moment": [0.0, 0.0, -0.5],
            "deflection": None
            if asked.model.loads.elastic is None
            else {"r_over_R": [0.2, 1.0], "twist_deg": [0.0, 0.8]},
            "observers": [
                {"elevation_deg": elevation, "azimuth_deg": azimuth, "radius": radius, **levels}
                | {"oaspl_thickness_db": -200.0, "harmonics": [], "third_octave": []}
                for radius, elevation, azimuth in zip(
                    *directions(asked.listening.observers).rounded(), strict=True
                )
            ],
        }


class Recorder:
    """In place of `propmdao.analyze` at one point or several: keeps what it was asked."""

    def __init__(self) -> None:
        self.asked: list[Request] = []
        self.polars: list[Any] = []

    def analyze(
        self, propeller: Propeller, *, polars: Any = None, progress: Any = None, **asked: Any
    ) -> Answer:
        records = {name: asked.pop(name, None) for name in ("change", "model", "listening")}
        request = Request.of(records, **asked)
        self.asked.append(request)
        self.polars.append(polars)
        return Answer(propeller, request)

    def analyze_each(
        self, propeller: Propeller, asked: Sequence[Any], *, polars: Any = None, **_: Any
    ) -> Iterator[Outcome[Any]]:
        for point in asked:
            request = point if isinstance(point, Request) else Request.of(**point)
            self.asked.append(request)
            self.polars.append(polars)
            yield Outcome(Answer(propeller, request), [])


@pytest.fixture
def polar_text() -> str:
    """Polar of a section as XFOIL writes it."""
    head = " Mach = 0.000  Re = 0.100 e 6  Ncrit = 9.000\n alpha CL CD CDp CM\n --- --- ---\n"
    lines = [f"{a} {0.1 * a + 0.3:.3f} 0.0200 0.0100 -0.0500\n" for a in range(-10, 13)]
    return head + "".join(lines)


@pytest.fixture
def recorder(monkeypatch: pytest.MonkeyPatch) -> Recorder:
    # What takes more from the module than `analyze` has to have it before it is replaced.
    batches = importlib.import_module("propmdao.analysis.sweeping.batches")
    recorder = Recorder()
    monkeypatch.setattr(batches, "analyze_each", recorder.analyze_each)
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

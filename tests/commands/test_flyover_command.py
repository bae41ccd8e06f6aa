"""``propmdao flyover``: what it prints, writes and refuses."""

from __future__ import annotations

import csv
import functools
import json
from collections.abc import Callable
from pathlib import Path

import pytest
from shared_mesh import COARSE

from propmdao.analysis import single_point
from propmdao.commands.program import main

PROPELLER = "apcsf_11x4.7"
FLIGHT = "--rpm 4200 --speed 8 --height 20 --duration 20 --trip heavy --json".split()


def test_json_holds_the_flight_its_levels_and_their_history(
    tmp_path: Path, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    coarse = functools.partial(single_point.analyze, fidelity=COARSE)
    monkeypatch.setattr(single_point, "analyze", coarse)
    out = tmp_path / "levels.csv"
    assert (
        main(["flyover", PROPELLER, *FLIGHT, "--trip", "heavy", "--json", "--out", str(out)]) == 0
    )
    result = json.loads(capsys.readouterr().out)
    assert list(result) == (
        "propeller point change model polars rpm speed rho J thrust torque shaft_power CT CQ CP eta"
        " figure_of_merit converged failure deflection hub_force hub_moment broadband_range flight"
        " levels epnl pnltm epnl_failure history".split()
    )
    assert result["model"]["noise"]["broadband"]["trip"] == "heavy"
    assert result["flight"]["height"] == 20.0 and result["flight"]["absorption"] is True
    assert result["point"]["air"]["temperature"] == 288.15
    assert set(result["levels"]) == {"thickness", "loading", "broadband", "total"}
    assert result["epnl"] < result["pnltm"] and result["epnl_failure"] is None
    with out.open(newline="") as stream:
        rows = list(csv.DictReader(stream))
    assert [float(row["total_dba"]) for row in rows] == pytest.approx(
        [step["total_dba"] for step in result["history"]], abs=1e-3
    )
    assert result["levels"]["total"]["lamax_dba"] == pytest.approx(
        max(step["total_dba"] for step in result["history"])
    )


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--rpm 4200 --speed 8", "required: --height"),
        ("--rpm 4200 --height 20", "--speed of a flyover must be positive"),
        ("--rpm 4200 --speed 8 --height -1", "height of flight must be within 0.001 ... 1000000 m"),
        ("--rpm 4200 --speed 8 --height 9 --microphone 9", "microphone must be between"),
        ("--rpm 4200 --speed 8 --height 9 --duration 1", "duration must be within 2 ... 1200 s"),
        (
            "--rpm 4200 --speed 8 --height 9 --incidence 170",
            "incidence_deg must be within 0 ... 150 deg; it is 170",
        ),
        ("--rpm 4200 --speed 8 --height 9 --wav a.mp3", "the file must end in .wav"),
        ("--rpm 4200 --speed 8 --height 9 --out no/a.csv", "there is no folder no"),
        ("--rpm 4200 --speed 8 --height 9 --full-scale 1", "--full-scale is of a sound file"),
        ("--rpm 4200 --speed 8 --height 9 --no-absorption --absorption", "do not go along"),
        ("--rpm 4200 --speed 8 --height 9 --absorption 90", "temperature must be within"),
    ],
)
def test_flyovers_that_are_refused(
    refused: Callable[..., str], arguments: str, message: str
) -> None:
    assert message in refused("flyover", PROPELLER, *arguments.split())

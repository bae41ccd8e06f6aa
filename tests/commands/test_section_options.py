"""``propmdao analyze``: sections and their polars, transition, drag."""

from __future__ import annotations

import json
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.commands.program import main
from propmdao.records.models import LoadModel, Transition

PROPELLER = "apcsf_11x4.7_uiuc"


def test_sections_can_be_left_out_or_stall_as_in_two_dimensions(recorder: Any) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--inviscid"]) == 0
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--no-stall-delay"]) == 0
    inviscid, no_delay = (asked.model.loads for asked in recorder.asked)
    assert inviscid == LoadModel(viscous=False) and recorder.polars[0] is None
    assert no_delay == LoadModel(stall_delay=False) and recorder.polars[1] is not None


def test_drag_can_be_left_as_computed(recorder: Any, capsys: pytest.CaptureFixture[str]) -> None:
    for options in ([], ["--computed-drag"]):
        assert main(["analyze", PROPELLER, "--rpm", "4000", "--json", *options]) == 0
    level, computed = recorder.polars
    assert recorder.asked[1].model.loads == LoadModel(measured_drag=False)
    assert float((level.values - computed.values)[:, :, :, 1].max()) > 0.2
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--inviscid", "--computed-drag"]) == 2
    assert "--inviscid has no sections" in capsys.readouterr().err


def test_transition_is_of_the_polars_and_is_said(
    recorder: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    for given in ([], ["--n-crit", "9"], ["--trip-upper", "0.05", "--trip-lower", "0.05"]):
        assert main(["analyze", PROPELLER, "--rpm", "4000", "--computed-drag", *given]) == 0
    asked = [request.model.loads.transition for request in recorder.asked]
    assert asked == [Transition(), Transition(9.0), Transition(None, 0.05, 0.05)]
    drag = [np.asarray(polars.values[..., 1, :, :]).mean() for polars in recorder.polars]
    assert drag[0] < drag[1] and drag[0] < drag[2]
    printed = [line for line in capsys.readouterr().out.splitlines() if "Transition" in line]
    assert printed == [
        "Transition: n_crit 9.",
        "Transition: n_crit 5, trips at x/c 0.05 (upper) and 0.05 (lower).",
    ]


def test_polars_of_ones_own_go_before_the_catalogue(
    recorder: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str], polar_text: str
) -> None:
    file = tmp_path / "mine.txt"
    file.write_text(polar_text)
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--polar", "e63", str(file), "--json"]) == 0
    said = json.loads(capsys.readouterr().out)["polars"]
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 0
    own, shipped = recorder.polars
    assert own.values.shape != shipped.values.shape
    assert said["e63"] == str(file) and said["naca4412"] != str(file)

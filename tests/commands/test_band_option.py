"""``propmdao analyze --band``: changes beside the numbers, in the table and in JSON."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from types import SimpleNamespace
from typing import Any

import pytest

from propmdao.analysis.uncertainty import Band, Effect
from propmdao.commands.program import main

PROPELLER = "apcsf_11x4.7_uiuc"


BAND = Band(
    {"thrust": 1.5, "shaft_power": 0.5, "spl_bpf_db": [50.0, 50.0]},
    (
        Effect(
            "blade angle", "deg", (-1.0, 1.0),
            ({"thrust": -0.2, "shaft_power": -1.0, "spl_bpf_db": [-0.8, -0.7]},
             {"thrust": 0.25, "shaft_power": 1.25, "spl_bpf_db": [0.75, 0.5]}),
        ),
        Effect("n_crit", "", (3.0, 9.0), (None, None), "there are no polars"),
    ),
    {"thrust": -0.2, "shaft_power": -1.0, "spl_bpf_db": [-0.8, -0.7]},
    {"thrust": 0.25, "shaft_power": 1.25, "spl_bpf_db": [0.75, 0.5]},
)  # fmt: skip


@pytest.fixture
def banded(recorder: Any, monkeypatch: pytest.MonkeyPatch) -> list[Any]:
    """Polars that every band was asked for with, in place of its solutions."""
    given: list[Any] = []

    def band(analysis: Any, polars: Any) -> Band:
        given.append(polars)
        return BAND

    module = SimpleNamespace(band=band)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.uncertainty", module)
    return given


def test_band_is_printed_beside_the_numbers_with_what_it_lacks(
    banded: list[Any], capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    asked = ["analyze", PROPELLER, "--rpm", "4000", "--rpm", "3000", "--arc", "2", "-45", "0"]
    assert main([*asked, "--band"]) == 0
    printed = capsys.readouterr().out
    assert banded == [None, None]
    assert printed.count("Band at") == 2 and "Band at 3000.0 rpm" in printed
    lines = printed[printed.index("Band at") :].splitlines()
    thrust = next(k for k, line in enumerate(lines) if "thrust, N" in line)
    assert lines[thrust].split() == ["thrust,", "N", "1.500", "+0.25", "-", "+0.25"]
    assert lines[thrust + 1].split() == ["-0.2", "-", "-0.2"]
    beside = next(line for line in lines if "BPF dB, +0 deg" in line)
    assert beside.split() == ["BPF", "dB,", "+0", "deg", "50.0", "+0.50", "-", "+0.50"]
    assert "The band lacks n_crit: there are no polars." in printed
    assert max(map(len, lines)) <= 80
    assert main(asked) == 0
    assert "Band" not in capsys.readouterr().out and len(banded) == 2


def test_band_in_json_and_with_polars_of_ones_own(
    banded: list[Any],
    recorder: Any,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    polar_text: str,
) -> None:
    file = tmp_path / "mine.txt"
    file.write_text(polar_text)
    polar = ["--polar", "e63", str(file)]
    assert main(["analyze", PROPELLER, "--rpm", "4000", *polar, "--band", "--json"]) == 0
    assert banded == [recorder.polars[0]]
    band = json.loads(capsys.readouterr().out)["band"]
    assert band == BAND.to_dict()
    assert band["effects"][1]["changes"] == [None, None]

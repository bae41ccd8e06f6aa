"""``propmdao analyze --motor``: lines for people, keys of JSON, what is refused."""

from __future__ import annotations

import json
from collections.abc import Callable
from typing import Any

import pytest

from propmdao.commands.program import main
from propmdao.records.units import RAD_PER_S

# The recorder's torque is 0.5 N m; at 390 rpm/V that takes 0.5 x 390 pi/30 + 1.8 A.
CURRENT = 0.5 * 390.0 * RAD_PER_S + 1.8
VOLTAGE = 0.063 * CURRENT + 4200.0 / 390.0
ASKED = ["analyze", "apcsf_11x4.7", "--rpm", "4200", "--inviscid", "--motor", "axi_4130_16"]


@pytest.mark.usefixtures("recorder")
def test_motor_and_battery_are_printed(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*ASKED, "--battery-wh", "50"]) == 0
    output = capsys.readouterr().out
    assert f"Motor axi_4130_16 at 4200.0 rpm: {CURRENT:.4g} A at {VOLTAGE:.4g} V," in output
    power = CURRENT * VOLTAGE
    efficiency = 0.5 * 4200.0 * RAD_PER_S / power
    assert f"  {power:.4g} W, efficiency {efficiency:.3f}." in output
    assert f"  0.8 of 50 W h last {0.8 * 50.0 / power * 60.0:.1f} minutes." in output
    assert max(map(len, output.splitlines())) <= 80


@pytest.mark.usefixtures("recorder")
def test_json_has_a_drive_for_each_point(capsys: pytest.CaptureFixture[str]) -> None:
    arguments = [*ASKED, "--rpm", "5000", "--battery-wh", "50", "--usable-share", "0.5", "--json"]
    assert main(arguments) == 0
    first, second = json.loads(capsys.readouterr().out)
    drive = first["drive"]
    assert drive["motor"] == "axi_4130_16" and drive["speed_constant"] == 390.0
    assert drive["current"] == pytest.approx(CURRENT)
    assert drive["endurance"] == pytest.approx(3600.0 * 25.0 / (CURRENT * VOLTAGE))
    assert (drive["battery_energy"], drive["usable_share"]) == (50.0, 0.5)
    assert second["drive"]["voltage"] > drive["voltage"]


@pytest.mark.usefixtures("recorder")
def test_without_a_battery_there_is_no_endurance(capsys: pytest.CaptureFixture[str]) -> None:
    assert main([*ASKED, "--json"]) == 0
    drive = json.loads(capsys.readouterr().out)["drive"]
    assert not {"endurance", "battery_energy", "usable_share"} & set(drive)
    assert main(["analyze", "apcsf_11x4.7", "--rpm", "4200", "--inviscid", "--json"]) == 0
    assert "drive" not in json.loads(capsys.readouterr().out)


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (["--battery-wh", "10"], "--battery-wh needs a motor"),
        (["--motor", "axi_4130_16", "--usable-share", "0.5"], "--usable-share is of a battery"),
        (["--motor", "axi", "--battery-wh", "10"], "unknown motor 'axi'; near: "),
        (["--motor", "axi_4130_16", "--battery-wh", "-1"], "--battery-wh must be within"),
        (["--motor", "axi_4130_16", "--battery-wh", "9", "--usable-share", "2"],
         "--usable-share must be within 0.01 ... 1; it is 2"),
    ],
)  # fmt: skip
def test_what_does_not_go_together(
    arguments: list[str], message: str, refused: Callable[..., str], recorder: Any
) -> None:
    assert message in refused("analyze", "apcsf_11x4.7", "--rpm", "4200", *arguments)
    assert not recorder.asked

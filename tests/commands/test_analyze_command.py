"""``propmdao analyze``: what it accepts, prints and refuses; mostly with no physics behind it."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
from collections.abc import Callable
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.request import Request
from propmdao.commands.program import main
from propmdao.propeller.changes import Change
from propmdao.records.air import Air, Turbulence
from propmdao.records.fidelity import Marching
from propmdao.records.listening import Surroundings
from propmdao.records.models import (
    ElasticModel,
    Model,
    NoiseModel,
    SelfNoiseModel,
)
from propmdao.records.states import OperatingPoint

PROPELLER = "apcsf_11x4.7_uiuc"


def run(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The installed command in a process of its own, without a display."""
    surroundings = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    return subprocess.run(
        [sys.executable, "-m", "propmdao", *arguments],
        env=surroundings | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def test_analyze_passes_on_what_was_asked(
    recorder: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    status = main(
        f"analyze {PROPELLER} --thrust 1.2 --speed 8 --rho 1.1 --twist-offset -1.5"
        " --arc 1.905 -45 -.5 45 --arc 3 0 --broadband --trip heavy --ground 9 --json"
        " --turbulence-intensity 0.5 --turbulence-length 0.05".split()
    )
    assert status == 0
    (asked,) = recorder.asked
    assert recorder.polars[0] is not None
    assert asked.point == OperatingPoint(
        thrust=1.2, speed=8.0, air=Air(density=1.1), turbulence=Turbulence(0.5, 0.05)
    )
    assert asked.change == Change(twist_offset_deg=-1.5)
    assert asked.model == Model(noise=NoiseModel(SelfNoiseModel("heavy")))
    places = arc([1.905, 1.905, 1.905, 3.0], [-45.0, -0.5, 45.0, 0.0])
    np.testing.assert_array_equal(asked.listening.observers, places)
    assert asked.listening.surroundings == Surroundings(ground=9.0)


@pytest.mark.parametrize(
    ("options", "said"),
    [
        ("--incidence 70", "shaft upright, climbing at 20 deg"),
        ("--incidence 90", "shaft upright, flight along the ground"),
        ("--incidence 100", "shaft upright, descending at 10 deg"),
        ("--incidence 70 --level", "level flight"),
        ("--incidence 0", ""),
    ],
)
def test_where_a_flight_over_the_ground_goes(
    recorder: Any, capsys: pytest.CaptureFixture[str], options: str, said: str
) -> None:
    arguments = "--rpm 4000 --speed 9 --arc 1.905 0 --ground 9 --broadband".split()
    assert main(["analyze", PROPELLER, *arguments, *options.split()]) == 0
    printed = " ".join(capsys.readouterr().out.split())
    said = f", {said}" if said else ""
    assert f"Levels: hard ground 9 m below the hub{said}, blades untripped." in printed


def test_air_that_absorbs_is_the_air_of_the_operating_point(recorder: Any) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--absorption", "-5", "40"]) == 0
    (asked,) = recorder.asked
    assert asked.point.air == Air(temperature=268.15, relative_humidity=0.4)
    assert asked.listening.surroundings.absorption


def test_defaults_are_hover_in_standard_air_without_observers(recorder: Any) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 0
    (asked,) = recorder.asked
    assert recorder.polars[0] is not None
    assert asked.to_dict() == Request(OperatingPoint(rpm=4000.0)).to_dict()
    assert asked.point.air == Air() and len(asked.listening.observers) == 0


@pytest.mark.parametrize(
    ("given", "rpm"),
    [
        (["4000", "--rpm", "3000"], [4000, 3000]),
        (["3000:5000:1000"], [3000, 4000, 5000]),
        (["3000:4999:1000"], [3000, 4000]),
        (["0:0.3:0.1"], [0, 0.1, 0.2, 0.3]),
        (["4000:4000:10"], [4000]),
        (["1000", "--rpm", "2000:3000:500"], [1000, 2000, 2500, 3000]),
    ],
)
def test_several_rpm_give_a_list_and_a_range_includes_its_stop(
    recorder: Any, capsys: pytest.CaptureFixture[str], given: list[str], rpm: list[float]
) -> None:
    assert main(["analyze", PROPELLER, "--rpm", *given, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)
    assert [result["rpm"] for result in results] == pytest.approx(rpm)


def test_one_rpm_gives_an_object_of_strict_json(
    recorder: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    def forbidden(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    assert main(["analyze", PROPELLER, "--rpm", "4000", "--arc", "2", "0", "--json"]) == 0
    result = json.loads(capsys.readouterr().out, parse_constant=forbidden)
    assert result["rpm"] == 4000.0
    assert result["observers"][0]["oaspl_thickness_db"] == -200.0


def test_tables_say_what_is_left_out_and_fit_eighty_columns(
    recorder: Any, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert main(["analyze", PROPELLER, "--rpm", "12345", "--arc", "1.905", "-45"]) == 0
    output = capsys.readouterr().out
    assert "Tones only" in output
    assert "profile drag" not in output
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--inviscid"]) == 0
    assert "no profile drag" in capsys.readouterr().out
    assert "…" not in output
    assert "nan" not in output and "inf" not in output


def test_levels_of_tones_of_broadband_noise_and_of_both_stand_side_by_side(
    recorder: Any, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    arguments = "--rpm 12345 --point 1.905 -45 -120.5 --broadband --trip heavy --ground 2"
    assert main(["analyze", PROPELLER, *arguments.split()]) == 0
    output = capsys.readouterr().out
    # radius, elevation, azimuth; BPF, tones, thickness, loading; broadband, total; dBA
    row = "12345.0 1.905 -45 -120.5 50.0 50.0 - 50.0 61.0 63.0 50.0 64.0".split()
    assert row in [line.split() for line in output.splitlines()]
    assert "Levels: hard ground 2 m below the hub, blades heavily tripped." in output
    assert "Tones only" not in output and "…" not in output


@pytest.mark.parametrize("command", ["analyze", "export", "sweep"])
def test_what_was_assumed_about_a_propeller_file_is_one_line(
    recorder: Any, capsys: pytest.CaptureFixture[str], tmp_path: Path, command: str, polar_text: str
) -> None:
    file, polar = tmp_path / "mine_9x4.7_geom.txt", tmp_path / "polar.txt"
    file.write_text("r/R c/R beta\n0.2 0.15 30\n0.6 0.2 20\n1.0 0.05 10\n")
    polar.write_text(polar_text)
    arguments = {
        "analyze": ["--rpm", "4000", "--polar", "naca4412", str(polar)],
        "export": ["--to", str(tmp_path / "mine.toml")],
        "sweep": ["--rpm", "4000", "--out", str(tmp_path / "sweep.csv")],
    }
    assert main([command, str(file), *arguments[command]]) == 0
    said = capsys.readouterr().err
    assert said.startswith(f"propmdao {command}: warning: {file}: assumed, ")
    assert said.count("\n") == 1


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("", "required: COMMAND"),
        ("analyse", "invalid choice"),
        (f"analyze {PROPELLER}", "--rpm --thrust is required"),
        (f"analyze {PROPELLER} --rpm 4000 --thrust 1", "not allowed with argument --rpm"),
        (f"analyze {PROPELLER} --rpm fast", "'fast' is not a number"),
        (f"analyze {PROPELLER} --rpm nan", "'nan' is not a number"),
        (f"analyze {PROPELLER} --rpm 4000 --speed inf", "'inf' is not a number"),
        (f"analyze {PROPELLER} --rpm 3000:5000", "START:STOP:STEP"),
        (f"analyze {PROPELLER} --rpm 3000:5000:0", "STEP of a range must be positive"),
        (f"analyze {PROPELLER} --rpm 5000:3000:100", "STOP not below START"),
        (f"analyze {PROPELLER} --rpm 0:100000:0.001", "more than the 1000 values"),
        (f"analyze {PROPELLER} --rpm 4000 --arc", "--arc"),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1.905", "at least one elevation"),
        (f"analyze {PROPELLER} --rpm 4000 --ar 1.905 0", "unrecognized arguments"),
        (f"analyze {PROPELLER} --rpm 4000 --trip light", "trip 'light' is about broadband noise"),
        (f"analyze {PROPELLER} --rpm 4000 --wav a.wav", "--wav needs observers"),
        (f"analyze {PROPELLER} --rpm 4000 --spectra a.csv", "--spectra needs observers"),
        (f"analyze {PROPELLER} --rpm 4000 --out a.txt", "a.txt: the file must end in .csv"),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1 0 --figure-at 1", "add --figures FOLDER"),
        (
            f"analyze {PROPELLER} --rpm 4000 --arc 1 0 30 --figures a --figure-at 3",
            "--figure-at must be within 1 ... 2, the observers in the order of the table; it is 3",
        ),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1 0 --figures a --figure-at 0", "it is 0"),
        (f"analyze {PROPELLER} --rpm 1:2:1 --arc 1 0 --wav a.wav", "of one operating point"),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1 0 --wav a.mp3", "a.mp3: the file must end in"),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1 0 --wav no/a.wav", "there is no folder no"),
        (f"analyze {PROPELLER} --rpm 4000 --circle 2 0 65 --wav a.wav", "at most 64 observers"),
        (f"analyze {PROPELLER} --rpm 1:2:1 --report a.html", "--report is of one operating point"),
        (f"analyze {PROPELLER} --rpm 4000 --report a.pdf", "a.pdf: the file must end in .html"),
        (f"analyze {PROPELLER} --rpm 4000 --report no/a.html", "--report no/a.html: there is no"),
        (f"analyze {PROPELLER} --rpm 4000 --full-scale 1", "--full-scale is of a sound file"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63", "--polar e63 has no file"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63 no_such.txt", "no_such.txt"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63 a.c81 b.c81", "a C81 file stands alone"),
        (f"analyze {PROPELLER} --rpm 4000 --inviscid --no-stall-delay", "do not go along"),
        ("analyze apcsf_11x47 --rpm 4000", "near: apcsf_11x4.7"),
        ("analyze no_such_file.toml --rpm 4000", "no_such_file.toml"),
    ],
)
def test_bad_input_is_refused_in_one_line(
    recorder: Any, refused: Callable[..., str], arguments: str, message: str
) -> None:
    assert message in refused(*arguments.split())
    assert recorder.asked == []


def test_malformed_toml_is_refused_in_one_line(
    recorder: Any, refused: Callable[..., str], tmp_path: Path
) -> None:
    file = tmp_path / "blade.toml"
    file.write_text('name = "blade"\ndiameter = = 0.3\n')
    assert "line 2" in refused("analyze", str(file), "--rpm", "4000")


def test_keys_are_those_promised() -> None:
    # The whole command, as a user types it; the JSON keys are a promise to users.
    arguments = f"analyze {PROPELLER} --rpm 4200 --speed 8 --arc 1.905 -45 0 --json".split()
    result = run(*arguments)
    assert (result.returncode, result.stderr) == (0, "")
    point = json.loads(result.stdout)
    assert list(point) == (
        "propeller point change model listening polars rpm speed rho J thrust torque shaft_power"
        " CT CQ CP eta figure_of_merit converged failure deflection hub_force hub_moment"
        " observers".split()
    )
    assert set(point["propeller"]) == {"name", "diameter", "n_blades", "checksum", "source"}
    assert set(point["point"]) == {
        "rpm", "thrust", "speed", "incidence_deg", "air", "turbulence",
    }  # fmt: skip
    assert set(point["point"]["turbulence"]) == {"turbulence_intensity", "turbulence_length_scale"}
    assert set(point["point"]["air"]) == set(
        "rho sound_speed dynamic_viscosity temperature pressure relative_humidity".split()
    )
    assert set(point["change"]) == {"twist_offset_deg", "chord_factor", "diameter", "n_blades"}
    assert set(point["model"]) == {"loads", "noise", "fidelity"}
    assert set(point["model"]["loads"]) == set(
        "viscous stall_delay wake transition measured_drag elastic unsteady blade_element".split()
    )
    assert set(point["listening"]) == {"observers", "surroundings", "groups"}
    assert set(point["polars"]) == {"e63", "naca4412"}
    assert [observer["elevation_deg"] for observer in point["observers"]] == [-45, 0]
    for observer in point["observers"]:
        assert set(observer) == set(
            "elevation_deg azimuth_deg radius spl_bpf_db oaspl_db oaspl_thickness_db"
            " oaspl_loading_db oaspl_dba harmonics third_octave".split()
        )
        assert set(observer["harmonics"][0]) == set(
            "m frequency_hz spl_db spl_thickness_db spl_loading_db".split()
        )
        assert set(observer["third_octave"][0]) == {"frequency_hz", "spl_db"}
        # Blade passage frequency: two blades, 70 revolutions a second.
        assert observer["harmonics"][0]["frequency_hz"] == pytest.approx(140.0)
    n, diameter = 70.0, 0.2794
    assert point["J"] == pytest.approx(8.0 / (n * diameter))
    assert point["CT"] == pytest.approx(point["thrust"] / (1.225 * n**2 * diameter**4))
    assert point["CQ"] == pytest.approx(point["torque"] / (1.225 * n**2 * diameter**5))
    assert point["CP"] == pytest.approx(2 * math.pi * point["CQ"])
    assert point["eta"] == pytest.approx(point["J"] * point["CT"] / point["CP"])
    assert point["shaft_power"] == pytest.approx(2 * math.pi * n * point["torque"])


def test_rpm_0_gives_zero_loads(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "0", "--json"]) == 0
    output = capsys.readouterr().out
    point = json.loads(output)
    assert point["thrust"] == point["torque"] == point["shaft_power"] == 0.0
    assert "-0.0" not in output


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--rpm -5", "rpm must be"),
        ("--rpm 4000 --speed -1", "speed must be"),
        ("--rpm 4000 --rho 0", "density must be within 0.0001 ... 2000 kg/m3; it is 0"),
        ("--rpm 4000 --arc 0.1 0", "inside the source region: 0.1 m"),
        ("--rpm 30000", "Mach"),
        ("--thrust -1", "thrust must be within 1e-09 ... 1000000000 N; it is -1"),
        ("--thrust 1000", "thrust 1000 N is out of reach"),
    ],
)
def test_what_the_physics_refuses_is_one_line(
    refused: Callable[..., str], arguments: str, message: str
) -> None:
    assert message in refused("analyze", PROPELLER, *arguments.split())


def test_an_elastic_blade_is_asked_for_and_its_twist_is_shown(
    recorder: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    arguments = f"analyze {PROPELLER} --rpm 4000 --elastic --youngs-modulus 11e9"
    assert main(arguments.split()) == 0
    shown = capsys.readouterr().out
    assert "0.75 R" in shown and "+0.55" in shown and "…" not in shown  # nothing is cut
    assert recorder.asked[-1].model.loads.elastic == ElasticModel(youngs_modulus=11e9)
    assert main(f"analyze {PROPELLER} --rpm 4000".split()) == 0
    assert "0.75 R" not in capsys.readouterr().out


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--shear-modulus 4e9", "shear_modulus is about an elastic blade: ask for elastic, too"),
        ("--elastic --inviscid", "needs the moments of its sections, which inviscid flow has not"),
        ("--elastic --youngs-modulus 11", "youngs_modulus must be within 1000000 ..."),
    ],
)
def test_what_an_elastic_blade_cannot_be_is_refused(
    refused: Callable[..., str], arguments: str, message: str
) -> None:
    assert message in refused("analyze", PROPELLER, "--rpm", "4000", *arguments.split())


def test_the_report_says_that_there_was_no_lattice(
    recorder: Any, capsys: pytest.CaptureFixture[str]
) -> None:
    options = ["analyze", PROPELLER, "--rpm", "4000", "--blade-element"]
    assert main(options) == 0
    assert recorder.asked[0].model.loads.blade_element
    assert "Blade elements, no lattice" in capsys.readouterr().out
    assert main([*options, "--vtk", "folder"]) == 2
    assert "--vtk draws the lattice" in capsys.readouterr().err


def test_help_explains_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_:
        main(["analyze", "--help"])
    assert exit_.value.code == 0
    text = capsys.readouterr().out
    options = "--rpm --thrust --speed --rho --twist-offset --inviscid --no-stall-delay --polar"
    options += " --n-crit --trip-upper --trip-lower"
    options += " --elastic --youngs-modulus --shear-modulus --material-density"
    options += " --unsteady --revolutions --average --timestep --start --wake"
    options += " --gust --gust-shape --gust-start --gust-length"
    options += " --arc --point --circle --hemisphere --grid --ground --level --absorption"
    options += (
        " --broadband --trip --layers --band --wav --seconds --full-scale --figures --figure-at"
    )
    options += " --figure-dba --report --vtk --json --out --spectra --quiet"
    for option in options.split():
        assert option in text
    assert "examples:" in text


def test_a_march_is_asked_for_by_its_options(recorder: Any) -> None:
    arguments = f"analyze {PROPELLER} --rpm 4000 --speed 8 --unsteady --revolutions 6 --average 2"
    assert main([*arguments.split(), *"--timestep 10 --start impulsive --wake free".split()]) == 0
    asked = recorder.asked[-1].model.loads.unsteady
    assert asked == Marching(6, 2, 10.0, "impulsive", "free")
    assert main([*arguments.split(), *"--gust -3 --gust-shape step --gust-start 2".split()]) == 0
    asked = recorder.asked[-1].model.loads.unsteady
    assert asked == Marching(6, 2, gust_speed=-3.0, gust_shape="step", gust_start=2.0)
    assert main(f"analyze {PROPELLER} --rpm 4000".split()) == 0
    assert recorder.asked[-1].model.loads.unsteady is None


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--rpm 4000 --wake free", "wake_motion is about a march in time: ask for unsteady, too"),
        ("--rpm 4000 --unsteady --timestep 7", "timestep_deg must divide a revolution of 360 deg"),
        ("--rpm 4000 --unsteady --revolutions 0", "revolutions must be within 1 ... 1000; it is 0"),
        ("--rpm 4000 --unsteady --revolutions 2", "average must be at most the revolutions, 2"),
        ("--rpm 4000 --unsteady --gust-length 2", "gust_length is about a gust: give gust_speed"),
        ("--rpm 4000 --unsteady --elastic", "an elastic blade is known in steady flow alone"),
        ("--thrust 2 --unsteady", "a march in time needs rpm, not thrust"),
        ("--rpm 0 --unsteady", "a rotor that does not turn cannot be marched"),
    ],
)
def test_what_cannot_be_marched_is_refused(
    refused: Callable[..., str], arguments: str, message: str
) -> None:
    assert message in refused("analyze", PROPELLER, *arguments.split())

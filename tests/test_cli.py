"""The command line: what it accepts, prints and refuses; mostly with no physics behind it."""

from __future__ import annotations

import json
import math
import os
import subprocess
import sys
import types
from pathlib import Path
from typing import Any

import pytest

import propmdao
from propmdao.catalog import catalog_names
from propmdao.cli import main

PROPELLER = "apcsf_11x4.7"


class Recorder:
    """In place of `propmdao.analysis.analyze`: keeps what it was asked, answers at once."""

    def __init__(self) -> None:
        self.calls: list[dict[str, Any]] = []

    def analyze(self, propeller: object, **asked: Any) -> Recorder:
        self.calls.append(asked)
        return self

    def to_dict(self) -> dict[str, Any]:
        asked = self.calls[-1]
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
            "observers": [
                {"elevation_deg": elevation, "radius": radius, **levels}
                | {"oaspl_thickness_db": -math.inf, "harmonics": [], "third_octave": []}
                for radius, elevation in asked["observers"]
            ],
        }


@pytest.fixture
def recorder(monkeypatch: pytest.MonkeyPatch) -> Recorder:
    recorder = Recorder()
    module = types.SimpleNamespace(analyze=recorder.analyze)
    monkeypatch.setitem(sys.modules, "propmdao.analysis", module)
    return recorder


def run(*arguments: str, **environment: str) -> subprocess.CompletedProcess[str]:
    """The installed command in a process of its own, without a display."""
    surroundings = {key: value for key, value in os.environ.items() if key != "DISPLAY"}
    return subprocess.run(
        [sys.executable, "-m", "propmdao.cli", *arguments],
        env=surroundings | environment,
        capture_output=True,
        text=True,
        check=False,
    )


def refused(capsys: pytest.CaptureFixture[str], *arguments: str) -> str:
    """The one line on stderr with which the command line refuses the arguments."""
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


def test_list_names_the_whole_catalogue(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list"]) == 0
    table = capsys.readouterr().out
    assert catalog_names()
    assert all(name in table for name in catalog_names())


def test_list_as_json_says_where_the_numbers_come_from(capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["list", "--json"]) == 0
    propellers = json.loads(capsys.readouterr().out)
    assert [propeller["name"] for propeller in propellers] == catalog_names()
    assert all(propeller["source"] and propeller["diameter"] > 0 for propeller in propellers)


def test_analyze_passes_on_what_was_asked(
    recorder: Recorder, capsys: pytest.CaptureFixture[str]
) -> None:
    status = main(
        f"analyze {PROPELLER} --thrust 1.2 --speed 8 --rho 1.1 --twist-offset -1.5"
        " --arc 1.905 -45 -.5 45 --arc 3 0 --broadband --json".split()
    )
    assert status == 0
    polars = [call.pop("polars") for call in recorder.calls]
    assert polars[0] is not None
    assert recorder.calls == [
        {
            "rpm": None,
            "thrust": 1.2,
            "speed": 8.0,
            "density": 1.1,
            "twist_offset_deg": -1.5,
            "viscous": True,
            "stall_delay": True,
            "broadband": True,
            "observers": [(1.905, -45.0), (1.905, -0.5), (1.905, 45.0), (3.0, 0.0)],
        }
    ]


def test_defaults_are_hover_in_standard_air_without_observers(recorder: Recorder) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 0
    (asked,) = recorder.calls
    assert asked.pop("polars") is not None
    assert asked == {
        "rpm": 4000.0,
        "thrust": None,
        "speed": 0.0,
        "density": 1.225,
        "twist_offset_deg": 0.0,
        "viscous": True,
        "stall_delay": True,
        "broadband": False,
        "observers": [],
    }


def test_sections_can_be_left_out_or_stall_as_in_two_dimensions(recorder: Recorder) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--inviscid"]) == 0
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--no-stall-delay"]) == 0
    inviscid, no_delay = recorder.calls
    assert inviscid["viscous"] is False and inviscid["polars"] is None
    assert no_delay["viscous"] is True and no_delay["stall_delay"] is False


def test_polars_of_ones_own_go_before_the_catalogue(recorder: Recorder, tmp_path: Path) -> None:
    lines = [" Mach = 0.000  Re = 0.100 e 6  Ncrit = 9.000", " alpha CL CD CDp CM", " --- --- ---"]
    lines += [f"{a} {0.1 * a + 0.3:.3f} 0.0200 0.0100 -0.0500" for a in range(-10, 13)]
    file = tmp_path / "mine.txt"
    file.write_text("\n".join(lines) + "\n")
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--polar", "e63", str(file)]) == 0
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 0
    own, shipped = (call["polars"] for call in recorder.calls)
    assert own.values.shape != shipped.values.shape


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
    recorder: Recorder, capsys: pytest.CaptureFixture[str], given: list[str], rpm: list[float]
) -> None:
    assert main(["analyze", PROPELLER, "--rpm", *given, "--json"]) == 0
    results = json.loads(capsys.readouterr().out)
    assert [result["rpm"] for result in results] == pytest.approx(rpm)


def test_one_rpm_gives_an_object_of_strict_json(
    recorder: Recorder, capsys: pytest.CaptureFixture[str]
) -> None:
    def forbidden(constant: str) -> None:
        raise AssertionError(f"{constant} is no JSON")

    assert main(["analyze", PROPELLER, "--rpm", "4000", "--arc", "2", "0", "--json"]) == 0
    result = json.loads(capsys.readouterr().out, parse_constant=forbidden)
    assert result["rpm"] == 4000.0
    assert result["eta"] is None
    assert result["observers"][0]["oaspl_thickness_db"] is None


def test_tables_say_what_is_left_out_and_fit_eighty_columns(
    recorder: Recorder, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
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


def test_a_twist_offset_is_said_above_the_table(
    recorder: Recorder, capsys: pytest.CaptureFixture[str]
) -> None:
    assert main(["analyze", PROPELLER, "--rpm", "4000", "--twist-offset", "-1.5"]) == 0
    assert "Twist offset -1.5 deg" in capsys.readouterr().out


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
        (f"analyze {PROPELLER} --rpm 0:100000:0.001", "at most 1000"),
        (f"analyze {PROPELLER} --rpm 4000 --arc", "--arc"),
        (f"analyze {PROPELLER} --rpm 4000 --arc 1.905", "at least one elevation"),
        (f"analyze {PROPELLER} --rpm 4000 --ar 1.905 0", "unrecognized arguments"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63", "--polar e63 has no file"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63 no_such.txt", "no_such.txt"),
        (f"analyze {PROPELLER} --rpm 4000 --polar e63 a.c81 b.c81", "a C81 file stands alone"),
        (f"analyze {PROPELLER} --rpm 4000 --inviscid --no-stall-delay", "do not go along"),
        ("analyze apcsf_11x47 --rpm 4000", PROPELLER),
        ("analyze no_such_file.toml --rpm 4000", "no_such_file.toml"),
    ],
)
def test_bad_input_is_refused_in_one_line(
    recorder: Recorder, capsys: pytest.CaptureFixture[str], arguments: str, message: str
) -> None:
    assert message in refused(capsys, *arguments.split())
    assert recorder.calls == []


def test_malformed_toml_is_refused_in_one_line(
    recorder: Recorder, capsys: pytest.CaptureFixture[str], tmp_path: Path
) -> None:
    file = tmp_path / "blade.toml"
    file.write_text('name = "blade"\ndiameter = = 0.3\n')
    assert "line 2" in refused(capsys, "analyze", str(file), "--rpm", "4000")


def test_keys_are_those_promised() -> None:
    # The whole command, as a user types it; the JSON keys are a promise to users.
    arguments = f"analyze {PROPELLER} --rpm 4200 --speed 8 --arc 1.905 -45 0 --json".split()
    result = run(*arguments)
    assert (result.returncode, result.stderr) == (0, "")
    point = json.loads(result.stdout)
    assert list(point) == (
        "rpm speed rho J thrust torque shaft_power CT CQ CP eta viscous converged failure observers"
        "".split()
    )
    assert [observer["elevation_deg"] for observer in point["observers"]] == [-45, 0]
    for observer in point["observers"]:
        assert set(observer) == set(
            "elevation_deg radius spl_bpf_db oaspl_db oaspl_thickness_db oaspl_loading_db oaspl_dba"
            " harmonics third_octave".split()
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
        ("--rpm 4000 --rho 0", "density must be positive"),
        ("--rpm 4000 --arc 0.1 0", "inside the source region: 0.1 m"),
        ("--rpm 30000", "Mach"),
        ("--thrust -1", "thrust must be positive"),
        ("--thrust 1000", "thrust 1000 N is out of reach"),
    ],
)
def test_what_the_physics_refuses_is_one_line(
    capsys: pytest.CaptureFixture[str], arguments: str, message: str
) -> None:
    assert message in refused(capsys, "analyze", PROPELLER, *arguments.split())


def test_interrupt_ends_quietly(
    capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    def interrupted(*_: object, **__: object) -> None:
        raise KeyboardInterrupt

    module = types.SimpleNamespace(analyze=interrupted)
    monkeypatch.setitem(sys.modules, "propmdao.analysis", module)
    assert main(["analyze", PROPELLER, "--rpm", "4000"]) == 130
    output = capsys.readouterr()
    assert output.out == output.err == ""


@pytest.mark.parametrize("form", [[], ["--json"]])
def test_a_closed_pipe_ends_quietly(form: list[str]) -> None:
    reader, writer = os.pipe()
    os.close(reader)
    with os.fdopen(writer, "w") as pipe:
        result = subprocess.run(
            [sys.executable, "-m", "propmdao.cli", "list", *form],
            stdout=pipe,
            stderr=subprocess.PIPE,
            text=True,
            check=False,
        )
    assert result.stderr == ""
    assert result.returncode == 1


def test_version_is_that_of_the_package() -> None:
    version = run("--version")
    assert (version.returncode, version.stderr) == (0, "")
    assert version.stdout == f"propmdao {propmdao.__version__}\n"


def test_help_explains_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_:
        main(["analyze", "--help"])
    assert exit_.value.code == 0
    text = capsys.readouterr().out
    options = "--rpm --thrust --speed --rho --twist-offset --inviscid --no-stall-delay --polar"
    for option in f"{options} --arc --broadband --json".split():
        assert option in text
    assert "examples:" in text

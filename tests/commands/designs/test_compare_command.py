"""``propmdao compare``: table, folder of results, what it refuses; no physics behind it."""

from __future__ import annotations

import csv
import json
import sys
import types
from collections.abc import Callable
from pathlib import Path
from typing import Any

import jax.numpy as jnp
import numpy as np
import pytest
import soundfile

import propmdao as pm
from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.signals import Tones
from propmdao.analysis.results import MECHANISMS, Analysis
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.commands.program import main
from propmdao.records.plain import to_plain

A, B = "apcsf_11x4.7_uiuc", "gwsdd_9x5"
THRUST = ["--thrust", "2"]


def test_operating_points_stand_beside_each_other_with_their_change(
    recorder: Any, capsys: pytest.CaptureFixture[str], monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setenv("COLUMNS", "80")
    assert main(["compare", A, B, *THRUST, "--speed", "8", "--arc", "2", "-45", "0"]) == 0
    first, second = recorder.asked
    assert first == second and first.point.thrust == 2.0 and first.point.speed == 8.0
    lines = capsys.readouterr().out.splitlines()
    assert lines[0].split() == [A, B, "change"]
    assert next(line for line in lines if "thrust, N" in line).split()[-3:] == [
        "1.5000",
        "1.5000",
        "+0.0000",
    ]
    assert any("efficiency" in line for line in lines)
    assert not any("figure of merit" in line for line in lines)
    # The tip of the smaller propeller is slower at the same rotation speed.
    mach = next(line for line in lines if "tip Mach" in line).split()
    assert float(mach[-1]) == pytest.approx(float(mach[-2]) - float(mach[-3]), abs=1e-4)
    assert float(mach[-1]) < 0.0
    assert any("observer 1: -45 deg, 2 m" in line for line in lines)
    assert any("mean over 2 observers" in line for line in lines)
    assert max(map(len, lines)) <= 80 or "Tones only" in max(lines, key=len)


def test_the_mean_over_observers_is_of_the_mean_square() -> None:
    from propmdao.analysis.comparisons import operation_and_levels

    air = pm.Air(sound_speed=340.0)
    point = pm.OperatingPoint(rpm=4000.0, speed=10.0, incidence_deg=60.0, air=air)
    result: dict[str, Any] = {
        "propeller": {"diameter": 0.3}, "change": {"diameter": None},
        "point": to_plain(point), "rpm": 4000.0, "speed": 10.0,
        "thrust": 1.0, "torque": 1.0, "shaft_power": 1.0,
        "figure_of_merit": 0.5, "eta": 0.0, "CT": 0.1, "CP": 0.1,
        "observers": [{"oaspl_db": level, "elevation_deg": 0.0, "radius": 1.0}
                      for level in (60.0, 50.0)],
    }  # fmt: skip
    rows, values = operation_and_levels(result, 1)
    assert values["at oaspl_db"] == 50.0
    assert values["mean oaspl_db"] == pytest.approx(10.0 * np.log10(0.5 * (1e6 + 1e5)))
    tip = np.pi * 0.3 * 4000 / 60  # and faster where the blade advances
    fastest = np.hypot(tip + 10.0 * np.sin(np.pi / 3), 10.0 * np.cos(np.pi / 3))
    assert values["tip_mach"] == pytest.approx(fastest / 340.0)
    assert "figure_of_merit" not in [key for _, key, _ in rows]
    assert all(key in values for _, key, _ in rows if key)


def test_json_has_every_result(recorder: Any, capsys: pytest.CaptureFixture[str]) -> None:
    assert main(["compare", A, B, *THRUST, "--json"]) == 0
    printed = json.loads(capsys.readouterr().out)
    assert [result["propeller"]["name"] for result in printed["results"]] == [A, B]
    assert printed["files"] == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        (f"{A} --thrust 2", "2 to 4 propellers are compared; there are 1"),
        (f"{A} {B} {A} {B} {A} --thrust 2", "there are 5"),
        (f"{A} {A} --thrust 2", f"{A} is given twice"),
        (f"{A} {B}", "--rpm --thrust is required"),
        (f"{A} {B} --thrust 2 --observer 1", "--observer needs observers; it is 1"),
        (f"{A} {B} --thrust 2 --arc 2 0 --observer 2", "--observer must be within 1 ... 1"),
        (f"{A} {B} --thrust 2 --seconds 2", "add --results FOLDER"),
        (f"{A} {B} --thrust 2 --results setup.py/below", "not a folder"),
        (f"{A} {B} --thrust 2 --arc 2 0 --results x --seconds -1", "length of the sound"),
        (f"{A} {B} --thrust 2 --trip light", "trip 'light' is about broadband noise"),
        (f"{A} no_such --thrust 2", "unknown propeller 'no_such'"),
    ],
)
def test_bad_input_is_refused_in_one_line(
    recorder: Any, refused: Callable[..., str], tmp_path: Path, monkeypatch: Any,
    arguments: str, message: str,
) -> None:  # fmt: skip
    monkeypatch.chdir(tmp_path)
    Path("setup.py").touch()
    assert message in refused("compare", *arguments.split())
    assert recorder.asked == []


@pytest.fixture
def heard(recorder: Any, monkeypatch: pytest.MonkeyPatch) -> None:
    """Analyses of random sound in place of the physics."""
    rng = np.random.default_rng(1)

    def analyze(propeller: Any, **asked: Any) -> Any:
        answer = recorder.analyze(propeller, **asked)
        n = len(answer.request.listening.observers)
        pressure = (1 + len(recorder.asked)) * 1e-3 * (1.0 + rng.random((n, 3)))
        power = {name: 1e-8 * (1.0 + rng.random((n, BANDS_HZ.size))) for name in MECHANISMS}
        noise = SelfNoise(**power)
        analysis = types.SimpleNamespace(
            propeller=propeller,
            changed_propeller=propeller,
            to_dict=answer.to_dict,
            point=answer.request.point,
            listening=answer.request.listening,
            tones=Tones(140.0 * jnp.arange(1.0, 4.0), {"loading": jnp.asarray(pressure)}),
            broadband=noise if answer.request.model.noise.broadband else None,
        )
        return analysis

    module = types.SimpleNamespace(analyze=analyze, Analysis=Analysis)
    monkeypatch.setitem(sys.modules, "propmdao.analysis.single_point", module)


def test_a_folder_has_table_figures_sounds_and_what_they_were_made_of(
    heard: None, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    pytest.importorskip("matplotlib")
    folder = tmp_path / "results"
    arguments = ["compare", A, B, *THRUST, "--arc", "2", "-45", "0", "45", "--broadband"]
    arguments += ["--results", str(folder), "--seconds", "0.1"]
    assert main(arguments) == 0
    written = {file.name for file in folder.iterdir()}
    assert written == {
        "record.json", "comparison.csv", "blades.png", "spectra.png", "directivity.png",
        "directivity_dba.png", f"{A}.wav", f"{B}.wav",
    }  # fmt: skip
    printed = capsys.readouterr().out
    assert all(str(folder / name) in printed for name in written)
    record = json.loads((folder / "record.json").read_text())
    assert record["arguments"] == arguments
    assert record["propellers"][B]["n_blades"] == 2 and len(record["results"]) == 2
    assert set(record["versions"]) >= {"propmdao", "python", "jax"}
    with (folder / "comparison.csv").open() as stream:
        assert next(csv.reader(stream)) == ["", A, B, "change"]
    # One full scale: the louder file is louder by what its pressure is.
    scales, peaks = zip(*(_scale_and_peak(folder / f"{name}.wav") for name in (A, B)), strict=True)
    assert scales[0] == scales[1] and peaks[1] > 1.2 * peaks[0] and max(peaks) > 0.9


def _scale_and_peak(file: Path) -> tuple[str, float]:
    with soundfile.SoundFile(file) as sound:
        return sound.comment, float(np.abs(sound.read()).max())

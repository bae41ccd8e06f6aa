"""Sweeps, mostly with no physics behind them: points, rows, resuming, the command."""

from __future__ import annotations

import csv
import dataclasses
import subprocess
import sys
import time
import types
import warnings
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.cli import main
from propmdao.propeller import Propeller, load_propeller
from propmdao.sweep import grid, latin_hypercube, read_points, sweep

PROPELLER = "apcsf_11x4.7"


class Analyzer:
    """In place of `propmdao.analysis`: thrust is rpm squared, 13 m/s is too fast."""

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
                {"elevation_deg": elevation, "radius": radius, **levels, "harmonics": []}
                | {"oaspl_loading_db": 40.0, "oaspl_dba": 30.0}
                for radius, elevation in asked["observers"]
            ],
        }


@pytest.fixture
def analyzer(monkeypatch: pytest.MonkeyPatch) -> Analyzer:
    analyzer = Analyzer()
    module = types.SimpleNamespace(analyze=analyzer.analyze)
    monkeypatch.setitem(sys.modules, "propmdao.analysis", module)
    return analyzer


@pytest.fixture
def propeller() -> Propeller:
    return load_propeller(PROPELLER)


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


# --- points -------------------------------------------------------------------------------------


def test_a_grid_is_every_combination() -> None:
    assert grid({"rpm": [3.0, 4.0], "speed": [0.0, 1.0]}) == [
        {"rpm": rpm, "speed": speed} for rpm in (3.0, 4.0) for speed in (0.0, 1.0)
    ]
    assert grid({}) == [{}]


def test_a_latin_hypercube_has_one_point_in_every_slice_of_every_range() -> None:
    points = latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=3)
    for name, low, high in (("rpm", 3000.0, 6000.0), ("speed", -1.0, 1.0)):
        slices = [int(20 * (point[name] - low) / (high - low)) for point in points]
        assert sorted(slices) == list(range(20))
    assert points == latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=3)
    assert points != latin_hypercube({"rpm": (3000.0, 6000.0), "speed": (-1.0, 1.0)}, 20, seed=4)


def test_points_of_a_file(tmp_path: Path) -> None:
    file = tmp_path / "points.csv"
    file.write_text("\ufeffrpm,speed\n3000,1.5\n4e3,0\n", encoding="utf-8")  # as Excel writes it
    assert read_points(file) == [{"rpm": 3000.0, "speed": 1.5}, {"rpm": 4000.0, "speed": 0.0}]


@pytest.mark.parametrize(
    ("content", "said"),
    [
        ("rpm,sped\n3000,1\n", "has a column 'sped', which is no variable"),
        ("rpm,speed\n3000,fast\n", "row 2 of .* is not all numbers"),
        ("rpm,speed\n3000,1\n3000\n", "row 3 of .* is not all numbers"),
        ("", "has a column ''"),
    ],
)
def test_a_file_of_points_that_is_none(tmp_path: Path, content: str, said: str) -> None:
    file = tmp_path / "points.csv"
    file.write_text(content)
    with pytest.raises(ValueError, match=said):
        read_points(file)
    with pytest.raises(ValueError, match="points cannot be read from"):
        read_points(tmp_path / "none.csv")


# --- the table ----------------------------------------------------------------------------------


def test_a_point_is_passed_on_and_its_results_are_a_row(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    point = {"rpm": 3000.0, "speed": 8.0, "rho": 1.1, "twist_offset_deg": 1.5}
    blade = {"chord_factor": 1.1, "diameter": 0.3, "n_blades": 3.0}
    path = tmp_path / "sweep.csv"
    new, failures = sweep(propeller, [point | blade], path, observers=[(1.905, -45.0), (2.0, 0.0)])
    assert (new, failures) == (1, [])
    (changed, asked), (row,) = analyzer.calls[0], rows_of(path)
    assert (changed.diameter, changed.n_blades) == (0.3, 3)
    np.testing.assert_allclose(changed.c_over_R, 1.1 * propeller.c_over_R)
    assert asked["rpm"] == 3000.0 and asked["thrust"] is None and asked["speed"] == 8.0
    assert asked["density"] == 1.1 and asked["twist_offset_deg"] == 1.5
    assert row["propeller"] == propeller.name and row["n_blades"] == "3"
    assert float(row["thrust"]) == 9e6 and row["converged"] == "True"
    assert row["oaspl_db@1.905m-45deg"] == row["spl_bpf_db@2m+0deg"] == "50.0"
    assert asked["viscous"] is True and row["viscous"] == "True"


def test_warnings_stand_in_the_row_that_they_are_about(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    sweep(propeller, grid({"rpm": [3000.0], "speed": [11.0, 12.0]}), tmp_path / "sweep.csv")
    warned = [row["warnings"] for row in rows_of(tmp_path / "sweep.csv")]
    assert warned == ["Reynolds numbers below the tables", ""]


def test_inviscid_points_are_other_points(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    arguments = ["--rpm", "3000", "--out", str(tmp_path / "sweep.csv")]
    assert command(*arguments) == command(*arguments, "--inviscid") == 0
    assert asked_for(analyzer, "viscous") == [(True,), (False,)]
    assert len(rows_of(tmp_path / "sweep.csv")) == 2


def test_failed_points_are_rows_with_the_reason(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    path = tmp_path / "sweep.csv"
    points = [{"thrust_required": 1.0, "speed": speed} for speed in (12.0, 13.0, 14.0, 15.0)]
    new, failures = sweep(propeller, points, path)
    assert new == 4
    assert failures == ["thrust 1 N is out of reach", "FloatingPointError: underflow"]
    assert [row["status"] for row in rows_of(path)] == ["ok", "failed", "failed", "ok"]
    assert [row["reason"] for row in rows_of(path)] == ["", *failures, ""]
    assert rows_of(path)[0]["rpm"] == "4000.0"  # found for the thrust


def test_a_point_that_does_not_converge_has_failed_and_keeps_its_numbers(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    to_dict = Analyzer.to_dict
    monkeypatch.setattr(Analyzer, "to_dict", lambda self: to_dict(self) | {"converged": False})
    _, failures = sweep(propeller, [{"rpm": 3000.0}], tmp_path / "sweep.csv")
    assert failures == ["the solution has not converged"]
    (row,) = rows_of(tmp_path / "sweep.csv")
    assert (row["converged"], row["thrust"]) == ("False", "9000000.0")


def test_a_sweep_goes_on_where_it_was_stopped_and_takes_more_points(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    points = [{"rpm": rpm} for rpm in (3000.0, 4000.0, 5000.0, 6000.0)]
    uninterrupted, path = tmp_path / "uninterrupted.csv", tmp_path / "sweep.csv"
    sweep(propeller, points, uninterrupted)
    to_dict = Analyzer.to_dict

    def interrupted(self: Analyzer) -> dict[str, Any]:
        if self.calls[-1][1]["rpm"] == 5000.0:
            raise KeyboardInterrupt
        return to_dict(self)

    monkeypatch.setattr(Analyzer, "to_dict", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sweep(propeller, points, path)
    assert len(rows_of(path)) == 2
    monkeypatch.setattr(Analyzer, "to_dict", to_dict)
    analyzer.calls.clear()
    assert sweep(propeller, points, path) == (2, [])
    assert [asked["rpm"] for _, asked in analyzer.calls] == [5000.0, 6000.0]
    assert path.read_bytes() == uninterrupted.read_bytes()
    assert sweep(propeller, [*points, {"rpm": 7000.0}], path) == (1, [])


def test_another_blade_of_the_same_name_is_another_point(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    """A propeller file that was changed is not taken for the one before."""
    path = tmp_path / "sweep.csv"
    sweep(propeller, [{"rpm": 3000.0}], path)
    changed = dataclasses.replace(propeller, beta_deg=propeller.beta_deg + 1.0)
    assert sweep(changed, [{"rpm": 3000.0}], path) == (1, [])


@pytest.mark.parametrize(
    ("points", "said"),
    [
        ([{"speed": 1.0}], "needs either rpm or thrust_required"),
        ([{"rpm": 1.0, "thrust_required": 1.0}], "needs either rpm or thrust_required"),
        ([{"rpm": 1.0}, {"thrust_required": 1.0}], "in all of them rpm or in all"),
        ([], "needs points"),
        ([{"rpm": 1.0, "sped": 1.0}], "'sped' is no variable"),
        ([{"rpm": 1.0, "n_blades": 2.5}], "n_blades must be a whole number; it is 2.5"),
    ],
)
def test_points_that_are_none(
    propeller: Propeller, tmp_path: Path, points: list[dict[str, float]], said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        sweep(propeller, points, tmp_path / "sweep.csv")
    assert not (tmp_path / "sweep.csv").exists()


def test_parquet_is_written_beside_csv(
    analyzer: Analyzer, propeller: Propeller, tmp_path: Path
) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    sweep(propeller, [{"rpm": 3000.0}, {"rpm": 4000.0}], tmp_path / "sweep.parquet")
    assert len(rows_of(tmp_path / "sweep.csv")) == 2
    assert parquet.read_table(tmp_path / "sweep.parquet")["rpm"].to_pylist() == [3000.0, 4000.0]


@pytest.mark.slow
def test_two_workers_make_the_same_table(propeller: Propeller, tmp_path: Path) -> None:
    points = grid({"rpm": [3000.0, 4000.0], "speed": [0.0, 8.0]}) + [{"rpm": 4e5, "speed": 0.0}]
    for n_workers in (1, 2):
        new, failures = sweep(
            propeller, points, tmp_path / f"{n_workers}.csv", observers=[(1.905, -45.0)],
            n_workers=n_workers,
        )  # fmt: skip
        assert new == 5 and len(failures) == 1
    alone, shared = rows_of(tmp_path / "1.csv"), rows_of(tmp_path / "2.csv")
    for one, other in zip(alone, shared, strict=True):
        for name, cell in one.items():
            # threads sum in another order
            if name in ("propeller", "blade", "status", "reason", "warnings") or cell in (
                "",
                "True",
            ):
                assert other[name] == cell
            else:
                assert float(other[name]) == pytest.approx(float(cell), rel=1e-9)


@pytest.mark.slow
def test_a_killed_sweep_resumes_to_the_same_table(tmp_path: Path) -> None:
    path = tmp_path / "sweep.csv"
    sweep_of = [sys.executable, "-m", "propmdao.cli", "sweep", PROPELLER, "--out", str(path)]
    arguments = [*sweep_of, "--rpm", "3000:6000:100", "--speed", "8"]
    with subprocess.Popen(arguments, stdout=subprocess.DEVNULL) as process:
        deadline = time.monotonic() + 120.0
        while not path.exists() or path.read_bytes().count(b"\n") < 4:
            assert process.poll() is None and time.monotonic() < deadline
            time.sleep(0.01)
        process.kill()
    assert 4 <= path.read_bytes().count(b"\n") < 32
    again = subprocess.run(arguments, capture_output=True, text=True, timeout=300, check=True)
    assert again.stdout.startswith("points: 31, ") and "31 new" not in again.stdout
    resumed = path.read_bytes()
    path.unlink()
    subprocess.run(arguments, capture_output=True, timeout=300, check=True)
    assert path.read_bytes() == resumed


# --- the command --------------------------------------------------------------------------------


def command(*arguments: str) -> int:
    return main(["sweep", PROPELLER, *arguments])


def asked_for(analyzer: Analyzer, *names: str) -> list[tuple[float, ...]]:
    return [tuple(asked[name] for name in names) for _, asked in analyzer.calls]


def test_command_of_a_grid(
    analyzer: Analyzer, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "sweep.csv")
    arguments = "--rpm 3000:4000:500 --rpm 3500 --speed 0:12:6 --speed 13 --arc 1.905 -45 0"
    assert command(*arguments.split(), "--out", out) == 0
    assert asked_for(analyzer, "rpm", "speed") == [
        (rpm, speed) for rpm in (3000.0, 3500.0, 4000.0) for speed in (0.0, 6.0, 12.0, 13.0)
    ]
    assert analyzer.calls[0][1]["observers"] == [(1.905, -45.0), (1.905, 0.0)]
    printed = capsys.readouterr().out
    assert printed.startswith(f"points: 12, 12 new, 3 failed; {out}\n")
    assert "failed: thrust 1 N is out of reach" in printed
    assert command(*arguments.split(), "--out", out) == 0
    assert capsys.readouterr().out.startswith("points: 12, 0 new, 3 failed")


def test_negative_ranges_and_every_option(analyzer: Analyzer, tmp_path: Path) -> None:
    arguments = "--thrust 1.5 --rho 1.1 --twist-offset -2:0:1 --chord-factor 1.1 --diameter 0.3"
    assert command(*arguments.split(), "--blades", "3", "--out", str(tmp_path / "s.csv")) == 0
    assert asked_for(analyzer, "thrust", "density", "twist_offset_deg") == [
        (1.5, 1.1, offset) for offset in (-2.0, -1.0, 0.0)
    ]
    assert analyzer.calls[0][0].n_blades == 3


def test_drawn_points_and_fixed_values(analyzer: Analyzer, tmp_path: Path) -> None:
    arguments = "--samples 10 --seed 2 --rpm 3000:6000 --twist-offset -2:2 --speed 0:8:8"
    with pytest.raises(SystemExit):
        main(["sweep", PROPELLER, "--samples", "ten", "--out", "x.csv"])
    assert command(*arguments.split(), "--out", str(tmp_path / "s.csv")) == 2  # three-part range
    fixed = arguments.replace("0:8:8", "8")
    assert command(*fixed.split(), "--out", str(tmp_path / "s.csv")) == 0
    drawn = latin_hypercube({"rpm": (3000.0, 6000.0), "twist_offset_deg": (-2.0, 2.0)}, 10, 2)
    expected = [(point["rpm"], point["twist_offset_deg"], 8.0) for point in drawn]
    assert asked_for(analyzer, "rpm", "twist_offset_deg", "speed") == expected


def test_points_of_a_file_with_other_values(analyzer: Analyzer, tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text("rpm,speed\n3000,1\n4000,2\n")
    arguments = ["--points", str(tmp_path / "points.csv"), "--out", str(tmp_path / "s.csv")]
    assert command(*arguments, "--rho", "1.0", "--rho", "1.2") == 0
    assert asked_for(analyzer, "rpm", "speed", "density") == [
        (3000.0, 1.0, 1.0), (3000.0, 1.0, 1.2), (4000.0, 2.0, 1.0), (4000.0, 2.0, 1.2)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("--speed 3", "needs either rpm or thrust_required"),
        ("--rpm 3000:6000", "rpm: '3000:6000' is not a range START:STOP:STEP"),
        ("--rpm fast", "rpm: 'fast' is not a number"),
        ("--rpm 3000 --arc 1.905", "has no elevation"),
        ("--rpm 3000 --workers 0", "--workers must be 1 or more; it is 0"),
        ("--rpm 3000 --samples 5", "--samples needs a range LOWEST:HIGHEST"),
        ("--rpm 3000:4000 --samples 0", "--samples must be 1 or more; it is 0"),
        ("--rpm 4000:3000 --samples 5", "LOWEST of '4000:3000' must be below HIGHEST"),
        ("--rpm 3000:3999:1 --speed 0:99:1 --rho 1:2:0.5", "300000 points are more than"),
        ("--rpm 3000 --points none.csv", "points cannot be read from 'none.csv'"),
        ("--rpm 3000 --speed 13", "points: 1, 1 new, 1 failed, the first with: thrust 1 N is out"),
    ],
)
def test_bad_input_is_one_line(
    analyzer: Analyzer,
    tmp_path: Path,
    capsys: pytest.CaptureFixture[str],
    arguments: str,
    said: str,
) -> None:
    assert command(*arguments.split(), "--out", str(tmp_path / "s.csv")) == 2
    out, err = capsys.readouterr()
    assert out == "" and err.count("\n") == 1
    assert err.startswith("propmdao sweep: error: ") and said in err


def test_a_table_has_to_have_a_known_ending(
    analyzer: Analyzer, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    assert command("--rpm", "3000", "--out", str(tmp_path / "sweep.xlsx")) == 2
    assert "a table ends in .csv or .parquet" in capsys.readouterr().err


def test_help_explains_every_option(capsys: pytest.CaptureFixture[str]) -> None:
    with pytest.raises(SystemExit) as exit_:
        main(["sweep", "--help"])
    assert exit_.value.code == 0
    text = capsys.readouterr().out
    for option in (
        "--rpm --thrust --speed --rho --twist-offset --chord-factor --diameter --blades"
        " --points --samples --seed --arc --inviscid --workers --out"
    ).split():
        assert option in text
    assert "examples:" in text and "resumes" in text

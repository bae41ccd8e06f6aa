"""The table of a sweep: rows, failures, resuming; mostly with no physics behind it."""

from __future__ import annotations

import csv
import dataclasses
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.sweeps import grid, sweep
from propmdao.propeller.description import Propeller
from propmdao.records.listening import Surroundings

PROPELLER = "apcsf_11x4.7"


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_point_is_passed_on_and_its_results_are_a_row(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    point = {"rpm": 3000.0, "speed": 8.0, "rho": 1.1, "twist_offset_deg": 1.5}
    blade = {"chord_factor": 1.1, "diameter": 0.3, "n_blades": 3.0}
    path = tmp_path / "sweep.csv"
    new, failures = sweep(
        propeller, [point | blade], path, observers=arc([1.905, 2.0], [-45.0, 0.0])
    )
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
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    sweep(propeller, grid({"rpm": [3000.0], "speed": [11.0, 12.0]}), tmp_path / "sweep.csv")
    warned = [row["warnings"] for row in rows_of(tmp_path / "sweep.csv")]
    assert warned == ["Reynolds numbers below the tables", ""]


def test_inviscid_points_are_other_points(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    for viscous in (True, False):
        sweep(propeller, [{"rpm": 3000.0}], tmp_path / "sweep.csv", viscous=viscous)
    assert [asked["viscous"] for _, asked in analyzer.calls] == [True, False]
    assert len(rows_of(tmp_path / "sweep.csv")) == 2


def test_noise_is_heard_in_the_same_way_at_all_points(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    path, points = tmp_path / "sweep.csv", [{"rpm": 3000.0}, {"rpm": 4000.0}]
    over_ground = Surroundings(ground=2.0)
    places = [(1.905, -20.0, 0.0), (1.905, -20.0, 90.0)]
    sweep(
        propeller, points, path, observers=places, broadband=True, trip="heavy",
        surroundings=over_ground,
    )  # fmt: skip
    for _, asked in analyzer.calls:
        assert asked["broadband"] is True and asked["trip"] == "heavy"
        assert asked["surroundings"] == over_ground and asked["observers"] == places
    row = rows_of(path)[1]
    assert row["surroundings"] == "hard ground 2 m below the hub" and row["trip"] == "heavy"
    assert "oaspl_db@1.905m-20deg" in row
    assert row["oaspl_broadband_db@1.905m-20deg_az+90deg"] == "45.0"
    # What is heard in another way is another sweep: its columns differ.
    with pytest.raises(ValueError, match="oaspl_broadband_db@1.905m-20deg only there"):
        sweep(propeller, points, path, observers=places)


def test_failed_points_are_rows_with_the_reason(
    analyzer: Any, propeller: Propeller, tmp_path: Path
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
    analyzer: Any, propeller: Propeller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    to_dict = type(analyzer).to_dict
    monkeypatch.setattr(
        type(analyzer), "to_dict", lambda self: to_dict(self) | {"converged": False}
    )
    _, failures = sweep(propeller, [{"rpm": 3000.0}], tmp_path / "sweep.csv")
    assert failures == ["the solution has not converged"]
    (row,) = rows_of(tmp_path / "sweep.csv")
    assert (row["converged"], row["thrust"]) == ("False", "9000000.0")


def test_a_sweep_goes_on_where_it_was_stopped_and_takes_more_points(
    analyzer: Any, propeller: Propeller, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    points = [{"rpm": rpm} for rpm in (3000.0, 4000.0, 5000.0, 6000.0)]
    uninterrupted, path = tmp_path / "uninterrupted.csv", tmp_path / "sweep.csv"
    sweep(propeller, points, uninterrupted)
    to_dict = type(analyzer).to_dict

    def interrupted(self: Any) -> dict[str, Any]:
        if self.calls[-1][1]["rpm"] == 5000.0:
            raise KeyboardInterrupt
        return to_dict(self)

    monkeypatch.setattr(type(analyzer), "to_dict", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sweep(propeller, points, path)
    assert len(rows_of(path)) == 2
    monkeypatch.setattr(type(analyzer), "to_dict", to_dict)
    analyzer.calls.clear()
    assert sweep(propeller, points, path) == (2, [])
    assert [asked["rpm"] for _, asked in analyzer.calls] == [5000.0, 6000.0]
    assert path.read_bytes() == uninterrupted.read_bytes()
    assert sweep(propeller, [*points, {"rpm": 7000.0}], path) == (1, [])


def test_another_blade_of_the_same_name_is_another_point(
    analyzer: Any, propeller: Propeller, tmp_path: Path
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


def test_parquet_is_written_beside_csv(analyzer: Any, propeller: Propeller, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    sweep(propeller, [{"rpm": 3000.0}, {"rpm": 4000.0}], tmp_path / "sweep.parquet")
    assert len(rows_of(tmp_path / "sweep.csv")) == 2
    assert parquet.read_table(tmp_path / "sweep.parquet")["rpm"].to_pylist() == [3000.0, 4000.0]


WORDS = ("propeller", "blade", "status", "reason", "warnings", "trip", "surroundings")


@pytest.mark.slow
def test_two_workers_make_the_same_table(propeller: Propeller, tmp_path: Path) -> None:
    points = grid({"rpm": [3000.0, 4000.0], "speed": [0.0, 8.0]}) + [{"rpm": 4e5, "speed": 0.0}]
    for n_workers in (1, 2):
        new, failures = sweep(
            propeller, points, tmp_path / f"{n_workers}.csv", observers=arc(1.905, [-45.0]),
            n_workers=n_workers,
        )  # fmt: skip
        assert new == 5 and len(failures) == 1
    alone, shared = rows_of(tmp_path / "1.csv"), rows_of(tmp_path / "2.csv")
    for one, other in zip(alone, shared, strict=True):
        for name, cell in one.items():
            # threads sum in another order
            if name in WORDS or cell in ("", "True", "False"):
                assert other[name] == cell
            else:
                assert float(other[name]) == pytest.approx(float(cell), rel=1e-9)


@pytest.mark.slow
def test_a_killed_sweep_resumes_to_the_same_table(tmp_path: Path) -> None:
    path = tmp_path / "sweep.csv"
    sweep_of = [
        sys.executable,
        "-m",
        "propmdao",
        "sweep",
        PROPELLER,
        "--out",
        str(path),
    ]
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

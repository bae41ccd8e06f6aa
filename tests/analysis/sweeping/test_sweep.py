"""The table of a sweep: rows, failures, resuming; mostly with no physics behind it."""

from __future__ import annotations

import csv
import dataclasses
import math
import subprocess
import sys
import time
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc, point
from propmdao.analysis.sweeping.points import grid
from propmdao.analysis.sweeping.sweeps import sweep
from propmdao.propeller.changes import Change
from propmdao.propeller.description import Propeller
from propmdao.records.air import Air
from propmdao.records.fidelity import Fidelity
from propmdao.records.listening import Surroundings
from propmdao.records.models import Model, SelfNoiseModel
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS
from propmdao.records.states import OperatingPoint
from propmdao.records.wake_law import WakeLaw
from propmdao.runtime.locks import InUseError, locked

PROPELLER = "apcsf_11x4.7_uiuc"


def rows_of(path: Path) -> list[dict[str, str]]:
    with path.open(newline="") as file:
        return list(csv.DictReader(file))


def test_a_point_is_passed_on_and_its_results_are_a_row(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    flow = {"rpm": 3000.0, "speed": 8.0, "rho": 1.1, "twist_offset_deg": 1.5}
    blade = {"chord_factor": 1.1, "diameter": 0.3, "n_blades": 3.0}
    path = tmp_path / "sweep.csv"
    new, failures = sweep(
        propeller, [flow | blade], path, observers=arc([1.905, 2.0], [-45.0, 0.0])
    )
    assert (new, failures) == (1, [])
    (asked,), (row,) = analyzer.asked, rows_of(path)
    assert asked.point == OperatingPoint(rpm=3000.0, speed=8.0, air=Air(density=1.1))
    assert asked.change == Change(1.5, 1.1, 0.3, 3)
    assert asked.model == Model()
    assert row["propeller"] == propeller.name and row["n_blades"] == "3"
    assert float(row["thrust"]) == 9e6 and row["converged"] == "True"
    assert [row[f"hub_force_{axis}"] for axis in "xyz"] == ["0.1", "-0.2", row["thrust"]]
    assert [row[f"hub_moment_{axis}"] for axis in "xyz"] == ["0.01", "-0.02", "-0.5"]
    assert row["oaspl_db@1.905m-45deg"] == row["spl_bpf_db@2m+0deg"] == "50.0"
    assert (row["rho"], row["chord_factor"], row["diameter"]) == ("1.1", "1.1", "0.3")


def test_observers_that_are_the_same_have_no_columns_of_their_own(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    path = tmp_path / "sweep.csv"
    with pytest.raises(ValueError, match=r"^observers 1 and 3 are both at 1.905m-45deg; a table"):
        sweep(propeller, [{"rpm": 3000.0}], path, observers=arc(1.905, [-45.0, 0.0, -45.0]))
    assert not path.exists() and not analyzer.asked


def test_rows_begin_with_the_point_and_all_that_was_asked_of_it(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    path = tmp_path / "sweep.csv"
    sweep(propeller, [{"rpm": 3000.0}], path)
    (row,) = rows_of(path)
    asked = "propeller blade rpm speed incidence_deg rho twist_offset_deg chord_factor diameter"
    asked += " n_blades"
    asked += " viscous stall_delay broadband trip surroundings settings"
    assert set(list(row)[:16]) == set(asked.split())
    said = {name: row[name] for name in list(row)[10:16]}
    assert said == {
        "viscous": "True",
        "stall_delay": "True",
        "broadband": "False",
        "trip": "none",
        "surroundings": "free field",
        "settings": "default",
    }
    assert analyzer.asked[0].change == Change()  # the blade as it is described


def test_levels_of_tones_of_noise_and_of_both_have_columns(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    places = arc(1.905, [-45.0])
    sweep(propeller, [{"rpm": 3000.0}], tmp_path / "tones.csv", observers=places)
    sweep(propeller, [{"rpm": 3000.0}], tmp_path / "both.csv", observers=places, broadband=True)
    tones, both = (
        {name.removesuffix("@1.905m-45deg"): cell for name, cell in row.items() if "@" in name}
        for name in ("tones", "both")
        for row in rows_of(tmp_path / f"{name}.csv")
    )
    assert tones.keys() == LEVELS.keys()
    assert both.keys() == LEVELS.keys() | BROADBAND_LEVELS.keys()
    assert (tones["oaspl_db"], both["oaspl_db"], both["oaspl_total_db"]) == ("50.0", "50.0", "51.0")


def test_what_has_no_column_of_its_own_is_in_the_settings(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    """Rows of other settings are other points, in the same table."""
    path, points = tmp_path / "sweep.csv", [{"rpm": 3000.0}]
    sweep(propeller, points, path)
    others: list[dict[str, Any]] = [
        {"n_crit": 9.0},
        {"fidelity": Fidelity(n_spanwise=12)},
        {"sound_speed": 330.0, "temperature": 270.0},
        {"wake": WakeLaw(inside=1.5)},
    ]
    for asked in others:
        assert sweep(propeller, points, path, **asked) == (1, [])
    assert [row["settings"] for row in rows_of(path)] == [
        "default",
        "loads.transition.n_crit=9.0",
        "fidelity.n_spanwise=12",
        "sound_speed=330.0 temperature=270.0",
        "loads.wake.inside=1.5",
    ]
    assert sweep(propeller, points, path, viscous=False, stall_delay=False) == (1, [])
    last = rows_of(path)[-1]
    assert (last["viscous"], last["stall_delay"], last["settings"]) == ("False", "False", "default")


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
    assert [asked.model.loads.viscous for asked in analyzer.asked] == [True, False]
    assert len(rows_of(tmp_path / "sweep.csv")) == 2


def test_noise_is_heard_in_the_same_way_at_all_points(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    path, points = tmp_path / "sweep.csv", [{"rpm": 3000.0}, {"rpm": 4000.0}]
    over_ground = Surroundings(ground=2.0)
    places = point(1.905, -20.0, [0.0, 90.0])
    sweep(
        propeller, points, path, observers=places, broadband=True, trip="heavy",
        surroundings=over_ground,
    )  # fmt: skip
    for asked in analyzer.asked:
        assert asked.model.noise.broadband == SelfNoiseModel("heavy")
        assert asked.listening.surroundings == over_ground
        np.testing.assert_array_equal(asked.listening.observers, places)
    row = rows_of(path)[1]
    assert row["surroundings"] == "hard ground 2 m below the hub" and row["trip"] == "heavy"
    assert "oaspl_db@1.905m-20deg" in row
    assert row["oaspl_broadband_db@1.905m-20deg_az+90deg"] == "45.0"
    # What is heard in another way is another sweep: its columns differ.
    with pytest.raises(ValueError, match="oaspl_broadband_db@1.905m-20deg only there"):
        sweep(propeller, points, path, observers=places)


def test_a_table_from_before_the_incidence_is_left_alone_and_the_difference_named(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    path, points = tmp_path / "sweep.csv", [{"rpm": 3000.0}]
    sweep(propeller, points, path)
    rows = rows_of(path)
    later = ("incidence_deg", "hub_force_x")
    with path.open("w", newline="") as file:
        old = [name for name in rows[0] if name not in later]
        writer = csv.DictWriter(file, old, extrasaction="ignore", lineterminator="\n")
        writer.writeheader()
        writer.writerows(rows)
    content = path.read_bytes()
    differ = "its columns differ: incidence_deg only here, hub_force_x only here; name another file"
    with pytest.raises(ValueError, match=differ):
        sweep(propeller, points, path)
    assert path.read_bytes() == content and len(analyzer.asked) == 1


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
    analyzer: Any,
    answer: Any,
    propeller: Propeller,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    to_dict = answer.to_dict
    monkeypatch.setattr(answer, "to_dict", lambda self: to_dict(self) | {"converged": False})
    _, failures = sweep(propeller, [{"rpm": 3000.0}], tmp_path / "sweep.csv")
    assert failures == ["the solution has not converged"]
    (row,) = rows_of(tmp_path / "sweep.csv")
    assert (row["converged"], row["thrust"]) == ("False", "9000000.0")


def test_a_sweep_goes_on_where_it_was_stopped_and_takes_more_points(
    analyzer: Any,
    answer: Any,
    propeller: Propeller,
    tmp_path: Path,
    monkeypatch: pytest.MonkeyPatch,
) -> None:
    points = [{"rpm": rpm} for rpm in (3000.0, 4000.0, 5000.0, 6000.0)]
    uninterrupted, path = tmp_path / "uninterrupted.csv", tmp_path / "sweep.csv"
    sweep(propeller, points, uninterrupted)
    to_dict = answer.to_dict

    def interrupted(self: Any) -> dict[str, Any]:
        if self.request.point.rpm == 5000.0:
            raise KeyboardInterrupt
        return to_dict(self)

    monkeypatch.setattr(answer, "to_dict", interrupted)
    with pytest.raises(KeyboardInterrupt):
        sweep(propeller, points, path)
    assert len(rows_of(path)) == 2
    monkeypatch.setattr(answer, "to_dict", to_dict)
    analyzer.asked.clear()
    assert sweep(propeller, points, path) == (2, [])
    assert [asked.point.rpm for asked in analyzer.asked] == [5000.0, 6000.0]
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
        ([{"rpm": 1.0}, {"thrust_required": 1.0}], "in all points rpm or in all"),
        ([], "number of points must be within 1 ... 100000; it is 0"),
        ([{"rpm": 1.0, "sped": 1.0}], "'sped' is no variable"),
        ([{"rpm": 1.0, "n_blades": 2.5}], "n_blades must be a whole number; it is 2.5"),
        ([{"rpm": 1.0, "n_blades": 1000}], "n_blades must be within 1 ... 40; it is 1000"),
        ([{"rpm": 1.0}, {"rpm": 1e300}], "rpm must be 0 or within .* rpm; it is 1e"),
        ([{"rpm": math.nan}], "rpm must be 0 or within .* rpm; it is nan"),
        ([{"rpm": 1.0}] * 100_001, "number of points must be within 1 ... 100000; it is 100001"),
    ],
)
def test_points_that_are_none(
    propeller: Propeller, tmp_path: Path, points: list[dict[str, float]], said: str
) -> None:
    with pytest.raises(ValueError, match=said):
        sweep(propeller, points, tmp_path / "sweep.csv")
    assert not (tmp_path / "sweep.csv").exists()


def test_a_table_is_of_one_sweep_at_a_time(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    """Two at once would each analyse all points and write every row twice."""
    path = tmp_path / "new" / "sweep.csv"
    path.parent.mkdir()
    with locked(path), pytest.raises(InUseError, match=r"sweep\.csv' is in use by process \d+ on "):
        sweep(propeller, [{"rpm": 3000.0}], path)
    assert analyzer.asked == [] and not path.exists()
    assert sweep(propeller, [{"rpm": 3000.0}], path) == (1, [])
    assert [file.name for file in path.parent.iterdir()] == ["sweep.csv"]


def test_a_parquet_file_that_cannot_be_written_is_known_before_the_work(
    analyzer: Any, propeller: Propeller, tmp_path: Path
) -> None:
    pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    (tmp_path / "sweep.parquet").mkdir()
    with pytest.raises(ValueError, match=r"sweep\.parquet: cannot be written: it is a folder"):
        sweep(propeller, [{"rpm": 3000.0}], tmp_path / "sweep.parquet")
    assert analyzer.asked == []


def test_parquet_is_written_beside_csv(analyzer: Any, propeller: Propeller, tmp_path: Path) -> None:
    parquet = pytest.importorskip("pyarrow.parquet", reason="pyarrow, an extra, is not installed")
    sweep(propeller, [{"rpm": 3000.0}, {"rpm": 4000.0}], tmp_path / "sweep.parquet")
    assert len(rows_of(tmp_path / "sweep.csv")) == 2
    assert parquet.read_table(tmp_path / "sweep.parquet")["rpm"].to_pylist() == [3000.0, 4000.0]


WORDS = ("propeller", "blade", "status", "reason", "warnings", "trip", "surroundings", "settings")


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

"""``propmdao sweep``: what it passes on and refuses, with no physics behind it."""

from __future__ import annotations

import operator
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.sweeping.points import latin_hypercube
from propmdao.commands.program import main
from propmdao.propeller.changes import Change

PROPELLER = "apcsf_11x4.7_uiuc"


def command(*arguments: str) -> int:
    return main(["sweep", PROPELLER, *arguments])


def asked_for(analyzer: Any, *names: str) -> list[tuple[float, ...]]:
    """Values by their dotted path in the request, of every point."""
    return [operator.attrgetter(*names)(request) for request in analyzer.asked]


def test_command_of_a_grid(
    analyzer: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
) -> None:
    out = str(tmp_path / "sweep.csv")
    arguments = "--rpm 3000:4000:500 --rpm 3500 --speed 0:12:6 --speed 13 --arc 1.905 -45 0"
    assert command(*arguments.split(), "--out", out) == 0
    assert asked_for(analyzer, "point.rpm", "point.speed") == [
        (rpm, speed) for rpm in (3000.0, 3500.0, 4000.0) for speed in (0.0, 6.0, 12.0, 13.0)
    ]
    np.testing.assert_allclose(analyzer.asked[0].listening.observers, arc(1.905, [-45.0, 0.0]))
    printed = capsys.readouterr().out
    assert printed.startswith(f"points: 12, 12 new, 3 failed; {out}\n")
    assert "failed: thrust 1 N is out of reach" in printed
    assert command(*arguments.split(), "--out", out) == 0
    assert capsys.readouterr().out.startswith("points: 12, 0 new, 3 failed")


def test_negative_ranges_and_every_option(analyzer: Any, tmp_path: Path) -> None:
    arguments = "--thrust 1.5 --rho 1.1 --twist-offset -2:0:1 --chord-factor 1.1 --diameter 0.3"
    assert command(*arguments.split(), "--blades", "3", "--out", str(tmp_path / "s.csv")) == 0
    assert asked_for(analyzer, "point.thrust", "point.air.density", "change.twist_offset_deg") == [
        (1.5, 1.1, offset) for offset in (-2.0, -1.0, 0.0)
    ]
    assert analyzer.asked[0].change == Change(-2.0, 1.1, 0.3, 3)


def test_level_flight_at_an_incidence_places_by_the_ground(analyzer: Any, tmp_path: Path) -> None:
    arguments = "--rpm 3000 --incidence 70 --level --grid 0 0 -10 --out"
    assert command(*arguments.split(), str(tmp_path / "s.csv")) == 0
    angle = np.radians(70.0)
    below = [[10.0 * np.cos(angle), 0.0, -10.0 * np.sin(angle)]]
    np.testing.assert_allclose(analyzer.asked[0].listening.observers, below, atol=1e-12)


def test_drawn_points_and_fixed_values(analyzer: Any, tmp_path: Path) -> None:
    arguments = "--samples 10 --seed 2 --rpm 3000:6000 --twist-offset -2:2 --speed 0:8:8"
    with pytest.raises(SystemExit):
        main(["sweep", PROPELLER, "--samples", "ten", "--out", "x.csv"])
    assert command(*arguments.split(), "--out", str(tmp_path / "s.csv")) == 2  # three-part range
    fixed = arguments.replace("0:8:8", "8")
    assert command(*fixed.split(), "--out", str(tmp_path / "s.csv")) == 0
    drawn = latin_hypercube({"rpm": (3000.0, 6000.0), "twist_offset_deg": (-2.0, 2.0)}, 10, 2)
    expected = [(point["rpm"], point["twist_offset_deg"], 8.0) for point in drawn]
    assert asked_for(analyzer, "point.rpm", "change.twist_offset_deg", "point.speed") == expected


def test_points_of_a_file_with_other_values(analyzer: Any, tmp_path: Path) -> None:
    (tmp_path / "points.csv").write_text("rpm,speed\n3000,1\n4000,2\n")
    arguments = ["--points", str(tmp_path / "points.csv"), "--out", str(tmp_path / "s.csv")]
    assert command(*arguments, "--rho", "1.0", "--rho", "1.2") == 0
    assert asked_for(analyzer, "point.rpm", "point.speed", "point.air.density") == [
        (3000.0, 1.0, 1.0), (3000.0, 1.0, 1.2), (4000.0, 2.0, 1.0), (4000.0, 2.0, 1.2)
    ]  # fmt: skip


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        ("--speed 3", "needs either rpm or thrust_required"),
        ("--rpm 3000:6000", "rpm: '3000:6000' is not a range START:STOP:STEP"),
        ("--rpm fast", "rpm: 'fast' is not a number"),
        ("--rpm 3000 --arc 1.905", "at least one elevation"),
        ("--rpm 3000 --trip light", "trip 'light' is about broadband noise"),
        ("--rpm 3000 --ground 0", "height above ground must be within 0.001 ... 1000000 m"),
        (
            "--rpm 3000 --incidence 60:80:10 --level --grid 0 0 -10",
            "with --level all points need the same incidence; they have 3",
        ),
        ("--rpm 3000 --workers 0", "number of workers must be within 1 ... 256; it is 0"),
        ("--rpm 3000 --samples 5", "--samples needs a range LOWEST:HIGHEST"),
        ("--rpm 3000:4000 --samples 0", "--samples must be within 1 ... 100000; it is 0"),
        ("--rpm 3000:4000 --samples 1000000000", "--samples must be within 1 ... 100000"),
        ("--rpm 3000:4000 --samples 5 --seed -1", "seed must be within 0 ..."),
        ("--rpm 3000 --workers 100000", "number of workers must be within 1 ... 256"),
        ("--rpm 3000 --blades 1000", "n_blades must be within 1 ... 40; it is 1000"),
        ("--rpm 3000 --diameter 1e-300", "diameter must be within 0.001 ... 1000 m"),
        ("--rpm 3000 --chord-factor 1e300", "chord_factor must be within 0.001 ... 100"),
        ("--rpm 4000:3000 --samples 5", "LOWEST of '4000:3000' must be below HIGHEST"),
        ("--rpm 3000:3999:1 --speed 0:99:1 --rho 1:2:0.5", "300000 points are more than"),
        ("--rpm 3000 --points none.csv", "points cannot be read from 'none.csv'"),
        ("--rpm 3000 --speed 13", "points: 1, 1 new, 1 failed, the first with: thrust 1 N is out"),
    ],
)
def test_bad_input_is_one_line(
    analyzer: Any,
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
    analyzer: Any, tmp_path: Path, capsys: pytest.CaptureFixture[str]
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
        " --points --samples --seed --inviscid --workers --out --broadband --trip"
        " --n-crit --trip-upper --trip-lower"
        " --arc --point --circle --hemisphere --grid --ground --level --absorption"
    ).split():
        assert option in text
    assert "examples:" in text and "resumes" in text

"""What a number may ask for: one line with the range, before anything is analysed."""

from __future__ import annotations

from collections.abc import Callable
from pathlib import Path
from typing import Any

import pytest

PROPELLER = "apcsf_11x4.7"


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--rpm 1e300", "rpm must be 0 or within 0.001 ... 1000000 rpm; it is 1e+300"),
        ("--rpm 1e-300", "rpm must be 0 or within 0.001 ... 1000000 rpm; it is 1e-300"),
        ("--rpm 0:1e308:1e-308", "more than the 1000 values"),
        ("--rpm=-1e308:1e308:1e308", "more than the 1000 values"),
        ("--thrust 1e300", "thrust must be within 1e-09 ... 1000000000 N; it is 1e+300"),
        ("--rpm 4200 --speed 1e300", "speed must be within 0 ... 1000 m/s; it is 1e+300"),
        ("--rpm 4200 --rho 1e-300", "density must be within 0.0001 ... 2000 kg/m3; it is 1e-300"),
        ("--rpm 4200 --twist-offset 1e300", "twist_offset_deg must be within -180 ... 180 deg"),
        ("--rpm 4200 --arc 1e300 0", "observer radius must be within 0.001 ... 1000000 m"),
        ("--rpm 4200 --arc 1e-300 0", "observer radius must be within 0.001 ... 1000000 m"),
        ("--rpm 4200 --point 2 0 1e300", "observer azimuth must be within -3600 ... 3600 deg"),
        ("--rpm 4200 --point 1:999:1 0:80:0.1 0:359:1", "observers are more than the 20000"),
        ("--rpm 4200 --circle 1e300 0 4", "observer radius must be within"),
        ("--rpm 4200 --circle 2 0 1e300", "observers, 1 ... 20000; it is 1e+300"),
        ("--rpm 4200 --hemisphere 1e300 30", "observer radius must be within"),
        ("--rpm 4200 --hemisphere 9 1e-300", "must be within 1 ... 90 deg; it is 1e-300"),
        ("--rpm 4200 --grid 1e300 0 0", "coordinates of observer 1 must be at most 1e+06 m"),
        ("--rpm 4200 --arc 2 0 --ground 1e300", "height above ground must be within 0.001 ..."),
        ("--rpm 4200 --arc 2 0 --wav a.wav --seconds 1e12", "must be within 0.01 ... 625 s"),
        (
            "--rpm 4200 --arc 2 0 --wav a.wav --seconds -1",
            "must be within 0.01 ... 625 s; it is -1",
        ),
        ("--rpm 4200 --circle 2 0 64 --wav a.wav --seconds 10", "within 0.01 ... 9 s; it is 10"),
        ("--rpm 4200 --arc 2 0 --wav a.wav --full-scale 0", "full scale must be within 1e-09 ..."),
    ],
)
def test_analyze(recorder: Any, refused: Callable[..., str], arguments: str, message: str) -> None:
    assert message in refused("analyze", PROPELLER, *arguments.split())
    assert recorder.asked == []


@pytest.mark.parametrize(
    ("arguments", "message"),
    [
        ("--speed 8 --height 1e300", "height of flight must be within 0.001 ... 1000000 m"),
        ("--speed 8 --height 20 --sideline 1e300", "sideline distance must be within"),
        ("--speed 8 --height 20 --duration 1e300", "duration must be within 2 ... 1200 s"),
        ("--speed 1e-300 --height 20", "at most 1200 s are heard: give a duration"),
        ("--speed 8 --height 20 --wav a.wav --full-scale -1", "full scale must be within"),
        (
            "--speed 8 --height 20 --wav a.wav --duration 1000",
            "must be within 0.01 ... 625 s; it is 1000",
        ),
    ],
)
def test_flyover(recorder: Any, refused: Callable[..., str], arguments: str, message: str) -> None:
    assert message in refused("flyover", PROPELLER, "--rpm", "4200", *arguments.split())
    assert recorder.asked == []


def test_the_most_that_is_allowed_is_allowed(recorder: Any, refused: Callable[..., str]) -> None:
    """Only what is asked is wrong here: the propeller is looked for after all numbers were good."""
    most = "--rpm 0.001 --speed 1000 --rho 2000 --twist-offset -180 --arc 1e6 90 --ground 1e6"
    assert "no_such.toml" in refused("analyze", "no_such.toml", *most.split())


def test_numbers_of_a_file_are_bounded_too(tmp_path: Path, refused: Callable[..., str]) -> None:
    file = tmp_path / "p.toml"
    text = (
        'name = "p"\ndiameter = 0.3\nn_blades = 2\nr_over_R = [0.2, 1.0]\nc_over_R = [0.1, 0.1]\n'
        'beta_deg = [20, 10]\nairfoils = [{ r_over_R = 0.2, airfoil = "e63" }]\n'
    )
    for right, wrong, message in (
        ("n_blades = 2", "n_blades = 100000", "n_blades must be within 1 ... 40; it is 100000"),
        ("= 0.3", "= 1e-300", "diameter must be within 0.001 ... 1000 m; it is 1e-300"),
        ("[0.1, 0.1]", "[1e-300, 0.1]", "c_over_R must be within 1e-06 ... 10; station 1"),
        ("[0.2, 1.0]", "[1e-300, 1.0]", "r_over_R must be within 0.0001 ... 1; station 1"),
    ):
        file.write_text(text.replace(right, wrong))
        assert message in refused("analyze", str(file), "--rpm", "4000")

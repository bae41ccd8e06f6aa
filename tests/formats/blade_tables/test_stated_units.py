"""Propeller files in the designer's units and with other lines than the chord."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.toml_files import read_toml, write_toml
from propmdao.propeller.airfoils.datums import chord_from_flat_bottom, chord_from_parting_line
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.identity import checksum

HEAD = """name = "made"
n_blades = 2
airfoils = [ { r_over_R = 1.0, airfoil = "naca4412" } ]
"""
SI = {
    "diameter": "diameter = 0.254", "r_over_R": "r_over_R = [0.2, 0.6, 1.0]",
    "c_over_R": "c_over_R = [0.15, 0.2, 0.05]", "beta_deg": "beta_deg = [30.0, 15.0, 9.0]",
}  # fmt: skip


def file(folder: Path, text: str = "", **changes: str) -> Path:
    path = folder / "made.toml"
    path.write_text(HEAD + "\n".join({**SI, **changes}.values()) + "\n" + text, encoding="utf-8")
    return path


def pitches(unit: float) -> str:
    radius = 0.127 * np.array([0.2, 0.6, 1.0]) / unit
    return str((2.0 * np.pi * radius * np.tan(np.radians([30.0, 15.0, 9.0]))).tolist())


@pytest.mark.parametrize(
    "changes",
    [
        {"diameter": "diameter_inch = 10"},
        {"diameter": "diameter_mm = 254.0"},
        {"c_over_R": "chord_mm = [19.05, 25.4, 6.35]"},
        {"c_over_R": "chord_inch = [0.75, 1.0, 0.25]", "diameter": "diameter_inch = 10.0"},
        {"r_over_R": "radius_mm = [25.4, 76.2, 127]"},
        {"r_over_R": "radius_inch = [1, 3, 5]", "diameter": ""},
        {"beta_deg": f"pitch_inch = {pitches(0.0254)}"},
        {"beta_deg": f"pitch_mm = {pitches(1e-3)}", "diameter": "",
         "r_over_R": "radius_inch = [1, 3, 5]"},
    ],
)  # fmt: skip
def test_the_designers_units_give_the_same_blade(changes: dict[str, str], tmp_path: Path) -> None:
    (tmp_path / "si").mkdir()
    own, other = read_toml(file(tmp_path / "si")), read_toml(file(tmp_path, **changes))
    assert other.diameter == pytest.approx(own.diameter, rel=1e-12)
    for key in ("r_over_R", "c_over_R", "beta_deg"):
        np.testing.assert_allclose(getattr(other, key), getattr(own, key), rtol=1e-12)


def test_one_pitch_is_a_screw(tmp_path: Path) -> None:
    blade = read_toml(file(tmp_path, beta_deg="pitch_inch = 7"))
    radius = blade.r_over_R * 5.0
    np.testing.assert_allclose(2.0 * np.pi * radius * np.tan(np.radians(blade.beta_deg)), 7.0)


def test_offsets_may_be_lengths(tmp_path: Path) -> None:
    blade = read_toml(file(tmp_path, "sweep_mm = [0, 1.27, 12.7]\nrake_inch = [0, 0, 0.5]\n"))
    np.testing.assert_allclose(blade.sweep_over_R, [0.0, 0.01, 0.1])
    np.testing.assert_allclose(blade.rake_over_R, [0.0, 0.0, 0.1])


@pytest.mark.parametrize(
    ("text", "over_R"),
    [
        ("trailing_edge_thickness_mm = 0.635", 0.005),
        ("trailing_edge_thickness_inch = [0.05, 0.025, 0]", [0.01, 0.005, 0.0]),
        ("trailing_edge_over_R = 0.005", 0.005),
    ],
)
def test_trailing_edges_and_tips_are_described(text: str, over_R: object, tmp_path: Path) -> None:
    blade = read_toml(file(tmp_path, f'{text}\ntrailing_edge_angle_deg = 12\ntip = "square"\n'))
    np.testing.assert_allclose(blade.trailing_edge_over_R, np.broadcast_to(over_R, 3))
    np.testing.assert_array_equal(blade.trailing_edge_angle_deg, 12.0)
    write_toml(tmp_path / "again.toml", blade)
    again = read_toml(tmp_path / "again.toml")
    assert again.tip == "square" and checksum(again) == checksum(blade)


@pytest.mark.parametrize("trip", ["light", ("none", "light", "heavy"), None])
def test_trips_are_described(trip: object, tmp_path: Path) -> None:
    written = "" if trip is None else f"trip = {list(trip) if trip != 'light' else trip!r}\n"
    blade = read_toml(file(tmp_path, written))
    assert blade.trip == trip
    write_toml(tmp_path / "again.toml", blade)
    again = read_toml(tmp_path / "again.toml")
    assert again.trip == trip and checksum(again) == checksum(blade)


@pytest.mark.parametrize("line", ["flat_bottom", "parting_line", "chord"])
def test_the_blade_angle_may_be_of_another_line(line: str, tmp_path: Path) -> None:
    """Referred to the line again, the angle of the chord line is what was written."""
    thickness = "thickness_over_chord = [0.18, 0.12, 0.1]\n"
    blade = read_toml(file(tmp_path, f'{thickness}beta_from = "{line}"\n'))
    camber, shape = blade.sections()
    steeper = []
    for i, ratio in enumerate([0.18, 0.12, 0.1]):
        section = camber[i], shape[i] * ratio / shape[i].max()
        written = np.radians([30.0, 15.0, 9.0][i])
        steeper.append(
            {
                "flat_bottom": lambda s, _: chord_from_flat_bottom(*s),
                "parting_line": lambda s, w: chord_from_parting_line(*s, w),
                "chord": lambda *_: 0.0,
            }[line](section, written)
        )
    np.testing.assert_allclose(blade.beta_deg, [30.0, 15.0, 9.0] + np.degrees(steeper))
    assert line == "chord" or (blade.beta_deg > [30.2, 15.2, 9.1]).all()
    write_toml(tmp_path / "again.toml", blade)
    np.testing.assert_array_equal(read_toml(tmp_path / "again.toml").beta_deg, blade.beta_deg)


def test_camber_is_scaled_to_what_is_described(tmp_path: Path) -> None:
    """A gauge under twice the camber line finds other angles, so the line is taken as described."""
    plain = read_toml(file(tmp_path, 'beta_from = "flat_bottom"\n'))
    text = 'camber_over_chord = [0.02, 0.02, 0.02]\nbeta_from = "flat_bottom"\n'
    flatter = read_toml(file(tmp_path, text))
    assert (flatter.beta_deg > plain.beta_deg + 0.3).all()  # less hollow, its nose higher
    np.testing.assert_array_equal(flatter.camber_over_chord, 0.02)


@pytest.mark.parametrize(
    ("changes", "text", "message"),
    [
        ({}, "diameter_inch = 10\n", "diameter and diameter_inch are the same thing; give one"),
        ({"c_over_R": "chord_mm = [1, 2, 3]"}, "chord_inch = [1, 2, 3]\n", "chord_mm and chord_"),
        ({}, "pitch_mm = 100\n", "beta_deg and pitch_mm are the same thing; give one of them"),
        ({"diameter": ""}, "", "missing key 'diameter'"),
        ({"diameter": "", "c_over_R": "chord_mm = [1, 2, 3]"}, "", "missing key 'diameter' (m), "),
        ({"diameter": "diameter_mm = 0"}, "", "diameter must be "),
        ({"diameter": "diameter_mm = [254]"}, "", "diameter_mm must be a number; it is [254]"),
        ({"r_over_R": "radius_mm = [20, 60, 120]"}, "", "radius_mm must end at the tip, half of"),
        ({"r_over_R": ""}, "", "missing key 'r_over_R'"),
        ({"r_over_R": "", "beta_deg": "pitch_mm = 1"}, "", "pitch_mm needs stations: r_over_R or"),
        ({"beta_deg": "pitch_mm = [1, 2]"}, "", "pitch_mm has 2 values for 3 stations"),
        ({"c_over_R": 'chord_mm = ["a"]'}, "", "chord_mm must be a list of numbers; it is ['a']"),
        ({"c_over_R": "chord_mm = []"}, "", "chord_mm must"),
        ({"c_over_R": "chord_mm = [1, 2]"}, "", "c_over_R has 2 values for 3 stations"),
        ({}, 'beta_from = "te"\n', "beta_from must be one of chord, flat_bottom, parting_line"),
        ({}, "chord_mn = [1, 2, 3]\n", "unknown key 'chord_mn'; did you mean 'chord_mm'?"),
        ({}, "trailing_edge_thickness_mm = -0.1\n", "trailing_edge_over_R must be within 0 ... 1"),
        ({}, "trailing_edge_angle_deg = 90\n", "trailing_edge_angle_deg must be within 0 ... 60"),
        ({}, 'tip = "pointed"\n', "tip must be one of rounded, square; it is 'pointed'"),
        ({}, "camber_over_chord = [1, 0, 0]\n", "camber_over_chord must be within -0.5 ... 0.5"),
    ],
)  # fmt: skip
def test_what_contradicts_itself_is_refused_in_one_line(
    changes: dict[str, str], text: str, message: str, tmp_path: Path
) -> None:
    path = file(tmp_path, text, **changes)
    with pytest.raises(PropellerError) as caught:
        read_toml(path)
    assert str(caught.value).startswith(f"{path}: {message}")
    assert "\n" not in str(caught.value)

"""The described propeller: files read back as written, wrong values named in one line."""

from __future__ import annotations

import dataclasses
import pickle
from pathlib import Path
from typing import Any

import numpy as np
import pytest

from propmdao.formats.propellers import load_propeller
from propmdao.formats.toml_files import read_toml, write_toml
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

AIRFOILS = [(0.25, "e63"), (1.0, "naca4412")]


def propeller(**changes: Any) -> Propeller:
    values: dict[str, Any] = {
        "name": "test",
        "diameter": 0.3,
        "n_blades": 2,
        "r_over_R": [0.15, 0.2, 0.25, 1.0],
        "c_over_R": [0.1, 0.15, 0.2, 0.1],
        "beta_deg": [30.0, 25.0, 20.0, 10.0],
        "airfoils": AIRFOILS,
    }
    return Propeller(**(values | changes))


def same(first: Propeller, second: Propeller) -> None:
    for field in dataclasses.fields(Propeller):
        np.testing.assert_equal(getattr(first, field.name), getattr(second, field.name))


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


FILE = """
name = "test"
diameter = 0.3  # m
n_blades = 2
r_over_R = [0.15, 0.2, 0.25, 1]
c_over_R = [0.1, 0.15, 0.2, 0.1]
beta_deg = [30, 25, 20, 10]
airfoils = [ {r_over_R = 0.25, airfoil = "e63"}, {r_over_R = 1.0, airfoil = "naca4412"} ]
source = "made up"
"""


def test_a_file_is_read_as_described(tmp_path: Path) -> None:
    read = load_propeller(write(tmp_path / "p.toml", FILE))
    same(read, propeller(source="made up"))
    np.testing.assert_array_equal(read.sweep_over_R, np.zeros(4))
    assert read.thickness_over_chord is None


@pytest.mark.parametrize(
    "changes",
    [
        {},
        {"name": 'with "quotes" and \\ and é', "source": "two\nlines\ttab"},
        {
            "thickness_over_chord": [0.12, 0.1, 1.0 / 3.0, 0.08],
            "sweep_over_R": [0.0, 0.01, 0.02, 0.1],
            "rake_over_R": [0.0, 0.0, 1e-20, -0.05],
        },
        {"n_blades": 1, "diameter": 3.0000000000000004},
    ],
)
def test_writing_and_reading_back_is_the_same_propeller(
    changes: dict[str, Any], tmp_path: Path
) -> None:
    written = propeller(**changes)
    write_toml(tmp_path / "p.toml", written)
    same(read_toml(tmp_path / "p.toml"), written)


def test_airfoil_files_are_found_beside_the_propeller_file(
    tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    x = np.concatenate([CHORD_FRACTION[::-1], CHORD_FRACTION[1:]])
    z = 0.1 * np.sqrt(x) * (1.0 - x) * np.where(np.arange(x.size) < 80, 1.0, -1.0)
    folder = tmp_path / "mine"
    folder.mkdir()
    np.savetxt(folder / "own.dat", np.stack([x, z], axis=1), header="own section")
    text = FILE.replace('"naca4412"', '"own.dat"')
    read = read_toml(write(folder / "p.toml", text))
    write_toml(folder / "again.toml", read)
    assert 'airfoil = "own.dat"' in (folder / "again.toml").read_text(encoding="utf-8")
    same(read_toml(folder / "again.toml"), read)
    # Written elsewhere, the file is still found from any working directory.
    write_toml(tmp_path / "elsewhere.toml", read)
    monkeypatch.chdir("/")
    _, thickness = load_propeller(tmp_path / "elsewhere.toml").sections()
    assert thickness[-1].max() == pytest.approx(2.0 * 0.1 * 2.0 / 27.0**0.5, rel=1e-3)


def test_sections_are_blended_linearly_between_the_airfoils() -> None:
    camber, thickness = propeller(r_over_R=[0.25, 0.5, 0.625, 1.0]).sections()
    assert camber.shape == thickness.shape == (4, CHORD_FRACTION.size)
    np.testing.assert_allclose(camber[2], 0.5 * (camber[0] + camber[3]), atol=1e-16)
    np.testing.assert_allclose(thickness[2], 0.5 * (thickness[0] + thickness[3]), atol=1e-16)


def test_a_single_number_of_sweep_holds_at_every_station() -> None:
    np.testing.assert_array_equal(propeller(sweep_over_R=0.02).sweep_over_R, np.full(4, 0.02))


def test_a_propeller_does_not_change_with_the_list_it_was_made_of() -> None:
    chord = np.array([0.1, 0.15, 0.2, 0.1])
    described = propeller(c_over_R=chord)
    chord[0] = 9.0
    assert described.c_over_R[0] == 0.1
    with pytest.raises(ValueError, match="read-only"):
        described.c_over_R[0] = 9.0


def test_a_propeller_can_be_sent_to_another_process() -> None:
    same(pickle.loads(pickle.dumps(propeller())), propeller())


@pytest.mark.parametrize(
    ("changes", "message"),
    [
        ({"diameter": 0.0}, "diameter must be within 0.001 ... 1000 m; it is 0"),
        ({"diameter": -1}, "diameter must be within 0.001 ... 1000 m; it is -1"),
        ({"diameter": float("nan")}, "diameter must be a finite number; it is nan"),
        ({"diameter": "11 in"}, "diameter must be a number; it is '11 in'"),
        ({"diameter": 1e300}, "diameter must be within 0.001 ... 1000 m; it is 1e+300"),
        (
            {"diameter": 10**400},
            "diameter must be a number; it is 100000000000000000...0000000000000000000",
        ),
        ({"n_blades": 0}, "n_blades must be within 1 ... 40; it is 0"),
        ({"n_blades": 1000}, "n_blades must be within 1 ... 40; it is 1000"),
        ({"n_blades": 10**400}, "n_blades must be within 1 ... 40; it is inf"),
        ({"n_blades": 2.5}, "n_blades must be a whole number; it is 2.5"),
        ({"n_blades": True}, "n_blades must be a whole number; it is True"),
        ({"name": 7}, "name must be text; it is 7"),
        (
            {"c_over_R": [0.1, 0.15, -0.02, 0.1]},
            "c_over_R must be within 1e-06 ... 10; station 3 (r/R 0.25) has -0.02",
        ),
        (
            {"c_over_R": [0.1, 0.15, 0.1, 0.0]},
            "c_over_R must be within 1e-06 ... 10; station 4 (r/R 1) has 0",
        ),
        (
            {"c_over_R": [0.1, float("nan"), 0.1, 0.1]},
            "c_over_R must be finite; station 2 (r/R 0.2) has nan",
        ),
        ({"c_over_R": [0.1, 0.15]}, "c_over_R has 2 values for 4 stations of r_over_R"),
        ({"c_over_R": 0.1}, "c_over_R must be a list of numbers; it is 0.1"),
        (
            {"c_over_R": [0.1, "a", 0.1, 0.1]},
            "c_over_R must be a list of numbers; it is [0.1, 'a', 0.1, 0.1]",
        ),
        (
            {"c_over_R": [[0.1], [0.1, 0.2]]},
            "c_over_R must be a list of numbers; it is [[0.1], [0.1, 0.2]]",
        ),
        (
            {"beta_deg": [91, 25, 20, 10]},
            "beta_deg must be within -90..90; station 1 (r/R 0.15) has 91",
        ),
        (
            {"c_over_R": [1e300, 0.15, 0.1, 0.1]},
            "c_over_R must be within 1e-06 ... 10; station 1 (r/R 0.15) has 1e+300",
        ),
        (
            {"c_over_R": [10**400]},
            "c_over_R must be a list of numbers; it is [100000000000000000...0000000000000000000]",
        ),
        (
            {"thickness_over_chord": [0.1, 0.1, 12, 0.1]},
            "thickness_over_chord must be within 0.0001 ... 0.999; station 3 (r/R 0.25) has 12",
        ),
        (
            {"rake_over_R": -1e300},
            "rake_over_R must be within -10 ... 10; station 1 (r/R 0.15) has -1e+300",
        ),
        (
            {"sweep_over_R": [0, 0, float("inf"), 0]},
            "sweep_over_R must be finite; station 3 (r/R 0.25) has inf",
        ),
        ({"rake_over_R": "up"}, "rake_over_R must be a number; it is 'up'"),
        (
            {"r_over_R": [0.15, 0.25, 0.2, 1.0]},
            "r_over_R must rise from station to station; station 3 has 0.2",
        ),
        (
            {"r_over_R": [0.0, 0.2, 0.25, 1.0]},
            "r_over_R must be within 0.0001 ... 1; station 1 has 0",
        ),
        (
            {"r_over_R": [0.15, 0.2, 0.25, 1.2]},
            "r_over_R must be within 0.0001 ... 1; station 4 has 1.2",
        ),
        (
            {"r_over_R": [0.15, 0.2, 0.25, 0.98]},
            "r_over_R must end at the tip, 1; the last station has 0.98",
        ),
        ({"r_over_R": [1.0]}, "r_over_R must hold 2 ... 1000 stations; it holds 1"),
        ({"airfoils": []}, "airfoils must name at least one airfoil"),
        ({"airfoils": ["e63"]}, "airfoils must be (r/R, airfoil) pairs; got 'e63'"),
        ({"airfoils": [(0.2, 63)]}, "an airfoil must be given by name or path; got 63"),
        ({"airfoils": [(1.5, "e63")]}, "r_over_R of airfoil 'e63' must be in 0..1; it is 1.5"),
        (
            {"airfoils": [(0.5, "e63"), (0.2, "clarky")]},
            "airfoils must rise in r_over_R; 'clarky' at 0.2 follows 0.5",
        ),
        (
            {"airfoils": [(0.5, "clark-y")]},
            "unknown airfoil 'clark-y'; near: clarky; also 'naca4412' or a path to a .dat",
        ),
    ],
)
def test_a_wrong_value_is_one_clear_line(changes: dict[str, Any], message: str) -> None:
    with pytest.raises(PropellerError) as caught:
        propeller(**changes)
    assert str(caught.value) == message


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("n_blades = 2", "", "missing key 'n_blades'"),
        ("beta_deg", "beta", "unknown key 'beta'; did you mean 'beta_deg'?"),
        ("source", "zzz", "unknown key 'zzz'; known: name, diameter, n_blades, r_over_R, "),
        ("diameter = 0.3", "diameter = ", "is not valid TOML: Invalid value (at line 3, column"),
        (
            "diameter = 0.3",
            "diameter = -0.3",
            "diameter must be within 0.001 ... 1000 m; it is -0.3",
        ),
        (
            '{r_over_R = 0.25, airfoil = "e63"}',
            '"e63"',
            "airfoils must be a list of { r_over_R = 0.15, airfoil = \"e63\" }; got 'e63'",
        ),
        ('"e63"', '"gone.dat"', "airfoil file '"),
    ],
)
def test_a_wrong_file_is_one_line_that_begins_with_the_file(
    old: str, new: str, message: str, tmp_path: Path
) -> None:
    path = write(tmp_path / "p.toml", FILE.replace(old, new, 1))
    with pytest.raises(PropellerError) as caught:
        load_propeller(path)
    assert str(caught.value).startswith(f"{path}: {message}")
    assert "\n" not in str(caught.value)


def test_a_file_that_is_not_text_is_refused(tmp_path: Path) -> None:
    path = tmp_path / "p.toml"
    path.write_bytes(b"\xff\xfe\x00")
    with pytest.raises(PropellerError, match="is not text in UTF-8"):
        load_propeller(path)


@pytest.mark.parametrize(
    ("name", "parts"),
    [
        ("apcsf_11x47", ["unknown propeller 'apcsf_11x47'", "apcsf_11x4.7", "`propmdao list`"]),
        ("APCE_10x7", ["near: apce_10x7"]),
        ("missing.toml", ["missing.toml: cannot be read: No such file"]),
    ],
)
def test_an_unknown_propeller_lists_what_comes_near(name: str, parts: list[str]) -> None:
    with pytest.raises(PropellerError) as caught:
        load_propeller(name)
    for part in parts:
        assert part in str(caught.value)
    assert "\n" not in str(caught.value)


@pytest.mark.parametrize("sent", [False, True], ids=["here", "sent to another process"])
def test_other_stations_keep_the_sweep_and_rake_that_were_never_given(sent: bool) -> None:
    described = propeller(rake_over_R=0.01)
    if sent:
        described = pickle.loads(pickle.dumps(described))
    values = {"r_over_R": [0.2, 0.6, 1.0], "c_over_R": [0.1] * 3, "beta_deg": [30.0, 20.0, 10.0]}
    changed = dataclasses.replace(described, **values)
    np.testing.assert_array_equal(changed.sweep_over_R, np.zeros(3))
    np.testing.assert_array_equal(changed.rake_over_R, np.full(3, 0.01))


def test_a_sweep_that_belongs_to_other_stations_is_refused() -> None:
    swept = propeller(sweep_over_R=[0.0, 0.01, 0.02, 0.1])
    values = {"r_over_R": [0.2, 0.6, 1.0], "c_over_R": [0.1] * 3, "beta_deg": [30.0, 20.0, 10.0]}
    message = "^sweep_over_R has 4 values for 3 stations of r_over_R$"
    with pytest.raises(PropellerError, match=message):
        dataclasses.replace(swept, **values)
    with pytest.raises(PropellerError, match=message):
        propeller(**values, sweep_over_R=[0.0] * 4)

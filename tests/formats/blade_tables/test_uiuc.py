"""Geometry files of UIUC: what they hold, what their names say, what is assumed."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.blade_tables.uiuc import read_uiuc_geometry
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.checks import PropellerError

AIRFOILS = [(0.25, "e63"), (1.0, "naca4412")]
BLADE = "  r/R     c/R    beta\n 0.15   0.109   21.11\n 0.5  0.223 17.06\n 1.00 0.042  5.04\n"


def write(path: Path, text: str) -> Path:
    path.write_text(text, encoding="utf-8")
    return path


@pytest.mark.parametrize(
    "text",
    [
        BLADE + "\n",
        "r_over_R,c_over_R,beta_deg\n0.15,0.109,21.11\n0.5,0.223,17.06\n1,0.042,5.04\n",
        "0.15 0.109 21.11\n0.5 0.223 17.06\n1 0.042 5.04\n",
        "\ufeff0.15 0.109 21.11\n0.5 0.223 17.06\n1 0.042 5.04\n",
        "0.15 0.109 21.11 # measured twice\n0.5 0.223 17.06\n1 0.042 5.04\n",
        "0,15 0,109 21,11\n0,5 0,223 17,06\n1,0 0,042 5,04\n",
    ],
)
def test_uiuc_geometry_is_read_in_either_form(text: str, tmp_path: Path) -> None:
    read = read_uiuc_geometry(
        write(tmp_path / "apcsf_10x4.7_geom.txt", text),
        diameter=0.254,
        n_blades=2,
        airfoils=AIRFOILS,
    )
    np.testing.assert_array_equal(read.r_over_R, [0.15, 0.5, 1.0])
    np.testing.assert_array_equal(read.c_over_R, [0.109, 0.223, 0.042])
    np.testing.assert_array_equal(read.beta_deg, [21.11, 17.06, 5.04])
    assert read.name == "apcsf_10x4.7_geom"
    assert "apcsf_10x4.7_geom.txt" in read.source


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("h\n0.15 0.1 20\n0.5 0.2\n", ", line 3: three numbers r/R c/R beta expected, not '0.5"),
        ("0.15 0.1 20 twice\n1 0.2 5\n", ", line 1: three numbers r/R c/R beta expected, not '0.1"),
        ("0.15x 0.1 20\n0.6 0.1 20\n1 0.2 5\n", ", line 1: three numbers r/R c/R beta expected"),
        ("r/R c/R beta 0.15 0.1 20\n1 0.2 5\n", ", line 1: three numbers r/R c/R beta expected"),
        ("h\ninf inf inf\n1 0.2 5\n", ", line 2: 'inf' is not finite"),
        ("h\n0.15 0.1 1e308\n1 0.2 5\n", ", line 2: '1e308' is out of range"),
        (
            "h\n0.15 0.1 20\n1 -0.2 5\n",
            ": c_over_R must be within 1e-06 ... 10; station 2 (r/R 1) has -0.2",
        ),
        ("h\n", ": r_over_R must hold 2 ... 1000 stations; it holds 0"),
    ],
)
def test_a_wrong_geometry_file_names_the_line_or_the_station(
    text: str, message: str, tmp_path: Path
) -> None:
    path = write(tmp_path / "geom.txt", text)
    with pytest.raises(PropellerError) as caught:
        read_uiuc_geometry(path, diameter=0.254, n_blades=2, airfoils=AIRFOILS)
    assert str(caught.value).startswith(f"{path}{message}")


@pytest.mark.parametrize(
    ("name", "diameter", "n_blades", "assumed"),
    [
        ("apcsf_9x4.7_geom.txt", 0.2286, 2, "NACA 4412 sections from root to tip and 2 blades;"),
        ("gwsdd_2.5x0.8.dat", 0.0635, 2, "NACA 4412 sections from root to tip and 2 blades;"),
        ("da4022_9x6.75_3b_geom.txt", 0.2286, 3, "NACA 4412 sections from root to tip;"),
    ],
)
def test_the_name_says_the_diameter_and_a_warning_what_is_assumed(
    name: str, diameter: float, n_blades: int, assumed: str, tmp_path: Path
) -> None:
    path = write(tmp_path / name, BLADE)
    with pytest.warns(AssumedBladeWarning) as caught:
        read = load_propeller(path)
    assert read.diameter == pytest.approx(diameter, rel=1e-12)
    assert read.n_blades == n_blades
    assert read.airfoils == ((1.0, "naca4412"),)
    (warning,) = caught
    message = str(warning.message)
    assert message.startswith(f"{path}: assumed, ") and assumed in message
    assert "\n" not in message
    assert warning.filename == __file__  # who has asked for the propeller


@pytest.mark.parametrize(
    "name",
    [
        "blade.txt",
        "cfnq_45p1_geom.txt",
        "nr640_9_15deg_geom.txt",  # blade angle, no pitch
        "pl_57x20_geom.txt",  # millimetres
        "ancf_125x75_geom.txt",  # 12.5 inches
        "x_0x4.txt",
    ],
)
def test_a_name_without_a_diameter_in_inches_is_refused(name: str, tmp_path: Path) -> None:
    path = write(tmp_path / name, BLADE)
    with pytest.raises(PropellerError) as caught:
        load_propeller(path)
    message = str(caught.value)
    assert message.startswith(f"{path}: the diameter is missing: ")
    assert "propeller file (TOML)" in message and "\n" not in message


def test_a_file_of_something_else_is_refused_as_that(tmp_path: Path) -> None:
    section = write(tmp_path / "e63.dat", "E63\n1.0 0.0\n0.99 0.002\n")
    with pytest.raises(
        PropellerError, match="e63.dat, line 2: three numbers r/R c/R beta expected"
    ):
        load_propeller(section)
    with pytest.raises(PropellerError, match="none.txt: cannot be read: No such file"):
        load_propeller(tmp_path / "none.txt")


def test_files_of_the_data_set_are_read(reference_data: Path, tmp_path: Path) -> None:
    """Their copies here are comma-separated, the originals are not."""
    folder = reference_data / "uiuc_geometry"
    table = np.loadtxt(folder / "apcsf_9x4.7.csv", delimiter=",", skiprows=1)
    text = (folder / "apcsf_9x4.7.csv").read_text().replace(",", "  ")
    with pytest.warns(AssumedBladeWarning):
        read = load_propeller(write(tmp_path / "apcsf_9x4.7_geom.txt", text))
    np.testing.assert_array_equal([read.r_over_R, read.c_over_R, read.beta_deg], table.T)

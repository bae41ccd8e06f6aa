"""Blade and polar files of QBlade: round trips, its documentation's blade, which way is up."""

from __future__ import annotations

import dataclasses
import re
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.exchange.qblade.blade_file import read_bld, write_bld
from propmdao.formats.exchange.qblade.polar_file import read_plr, read_qblade_polar
from propmdao.formats.exchange.section_polar import export_polar
from propmdao.formats.polars import load_polars, read_polar
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.propeller.airfoils.coordinate_files import read_coordinates
from propmdao.propeller.airfoils.library import find_airfoil
from propmdao.propeller.checks import PropellerError
from propmdao.propeller.description import Propeller

BLADE = Propeller(
    name="blade",
    diameter=0.3,
    n_blades=3,
    r_over_R=np.array([0.2, 0.4, 0.7, 0.9, 1.0]),
    c_over_R=np.array([0.15, 0.2, 0.18, 0.12, 0.06]),
    beta_deg=np.array([34.0, 25.0, 15.0, 11.0, 9.0]),
    airfoils=[(1.0, "naca4412")],
    thickness_over_chord=np.array([0.2, 0.15, 0.12, 0.1, 0.09]),
    sweep_over_R=np.array([-0.01, -0.02, 0.0, 0.05, 0.1]),
    rake_over_R=0.02,
)
# Three stations of the blade of 5 MW in QBlade's documentation; its polar files are not there.
TURBINE = """\
----------------------------------------QBlade Blade Definition File-----------------------------
Generated with : QBlade IH v2.0.2_alpha windows
----------------------------------------Object Name----------------------------------------------
NREL_5MW                                 OBJECTNAME         - the name of the blade object

----------------------------------------Parameters-----------------------------------------------
HAWT                                     ROTORTYPE          - the rotor type
3                                        NUMBLADES          - number of blades

----------------------------------------Blade Data-----------------------------------------------
POS [m]   CHORD [m]  TWIST [deg]  OFFSET_X [m]  OFFSET_Y [m]  TAXIS [-]  POLAR_FILE
15.8399   4.6520     11.4845      0.5696        0.1157        0.5000     t35.0 nre_5mw.plr
36.3454   3.5020     5.3623       0.4358        0.0409        0.5000     t21.0_nre_5mw.plr
63.0000   0.9610     0.0000       0.1201        0.0000        0.5000     t17.0_nre_5mw.plr
"""


@pytest.fixture(scope="module")
def bld(tmp_path_factory: pytest.TempPathFactory) -> Path:
    path = tmp_path_factory.mktemp("qblade") / "my blade.bld"
    assert write_bld(path, BLADE) == 5
    return path


def test_a_round_trip_keeps_the_blade(bld: Path) -> None:
    with pytest.warns(AssumedBladeWarning, match="cambered toward thrust; NACA 4-digit .* 5 of 5"):
        back = load_propeller(bld)
    assert (back.name, back.n_blades) == ("my blade", 3)
    assert back.diameter == pytest.approx(0.3)
    for key in ("r_over_R", "c_over_R", "beta_deg", "sweep_over_R", "rake_over_R"):
        np.testing.assert_allclose(getattr(back, key), getattr(BLADE, key), rtol=1e-6, atol=1e-7)
    np.testing.assert_allclose(back.thickness_over_chord, BLADE.thickness_over_chord, rtol=1e-4)
    np.testing.assert_allclose(back.camber_over_chord, 0.04, rtol=2e-3)


def test_sections_of_the_catalogue_come_back_by_name(tmp_path: Path) -> None:
    blade = dataclasses.replace(BLADE, airfoils=[(0.7, "e63"), (0.9, "clarky")])
    write_bld(tmp_path / "b.bld", blade)
    with pytest.warns(AssumedBladeWarning, match="cambered toward thrust$"):
        back = read_bld(tmp_path / "b.bld")
    assert [name for _, name in back.airfoils] == ["e63", "e63", "e63", "clarky", "clarky"]
    expected = np.asarray(Blade.from_propeller(blade).camber_over_chord)
    np.testing.assert_allclose(back.camber_over_chord, expected, rtol=1e-3)


def test_the_blade_of_the_documentation_has_its_pitch_axis_on_a_line(tmp_path: Path) -> None:
    """Its aerodynamic centre is an eighth of the chord ahead of that (Jonkman, NREL/TP-500-38060).

    The offsets of the file have four digits.
    """
    path = tmp_path / "turbine.bld"
    path.write_text(TURBINE)
    with pytest.warns(AssumedBladeWarning, match="for there is no polar file, at 3 of 3 stations"):
        blade = read_bld(path)
    assert blade.n_blades == 3 and blade.diameter == pytest.approx(126.0)
    ahead, angle = 0.125 * blade.c_over_R, np.radians(blade.beta_deg)
    np.testing.assert_allclose(blade.sweep_over_R, -ahead * np.cos(angle), atol=2e-5)
    np.testing.assert_allclose(blade.rake_over_R, ahead * np.sin(angle), atol=2e-5)


def test_contours_and_polars_stand_upside_down(bld: Path, tmp_path: Path) -> None:
    """QBlade's propeller takes minus the lift at minus the angle: that is the blade's own again."""
    (path,) = sorted((bld.parent / "my_blade_polars").glob("*_02.plr"))
    polar = read_qblade_polar(path)
    assert polar.thickness == pytest.approx(0.12, rel=1e-5)
    section = read_coordinates(path.with_suffix(".afl"))
    naca = find_airfoil("naca4412")
    np.testing.assert_allclose(section.camber, -naca.camber, atol=3e-4)
    # The polar that the analysis has, at a Reynolds number of the table.
    reynolds = float(polar.reynolds[np.argmin(np.abs(polar.reynolds - 1e5))])
    own_path = tmp_path / "own.txt"
    export_polar(own_path, BLADE, 0.7, reynolds)
    own = read_polar(own_path)
    values = polar.values[np.flatnonzero(polar.reynolds == reynolds)[0]]
    theirs = [np.interp(-own.alpha, polar.alpha, row) for row in values]
    np.testing.assert_allclose(-theirs[0], own.cl, atol=2e-4)
    np.testing.assert_allclose(theirs[1], own.cd, atol=2e-5)
    np.testing.assert_allclose(-theirs[2], own.cm, atol=2e-4)
    assert polar.alpha[0] == pytest.approx(-np.pi) and polar.alpha[-1] == pytest.approx(np.pi)


def test_a_polar_file_is_the_polar_of_a_section(bld: Path, tmp_path: Path) -> None:
    source = sorted((bld.parent / "my_blade_polars").glob("*_02.plr"))[0]
    written = read_qblade_polar(source)
    path = tmp_path / "section.plr"
    path.write_text(written.upside_down().text())
    table = load_polars(path)
    np.testing.assert_allclose(np.exp(table.log_re), written.reynolds, rtol=1e-4)
    upright = written.upside_down()
    np.testing.assert_allclose(table.cl[0, 1], upright.values[1, 0], atol=1e-6)
    np.testing.assert_allclose(table.cd[0, 1], upright.values[1, 1], atol=2e-6)
    assert upright.zero_lift_angle() == pytest.approx(-0.07, abs=0.02)


def test_decomposed_polars_and_newer_heads_are_read(tmp_path: Path) -> None:
    path = tmp_path / "p.plr"
    rows = "\n".join(f"{a} {0.1 * a + 0.4} 0.01 -0.1 9 9 9" for a in range(-10, 11, 2))
    path.write_text(
        "---QBlade Multi RE Polar File---\nname with blanks  POLARNAME - \n12.0 THICKNESS - \n"
        f"true ISDECOMPOSED - \nREYNOLDS_[-] 1e5 - list\nAOA CL CD CM\n{rows}\n"
    )
    polar = read_qblade_polar(path)
    assert polar.name == "name with blanks" and polar.values.shape == (1, 3, 11)
    assert np.degrees(polar.zero_lift_angle()) == pytest.approx(-4.0)


def test_without_contours_the_polars_tell_camber_and_thickness(bld: Path, tmp_path: Path) -> None:
    folder = tmp_path / "my_blade_polars"
    folder.mkdir()
    for file in (bld.parent / "my_blade_polars").glob("*.plr"):
        (folder / file.name).write_text(file.read_text())
    path = tmp_path / "copied.bld"
    path.write_text(bld.read_text())
    with pytest.warns(AssumedBladeWarning, match="of the polar's thickness and zero-lift angle"):
        back = read_bld(path)
    np.testing.assert_allclose(back.thickness_over_chord, BLADE.thickness_over_chord, rtol=1e-5)
    naca = find_airfoil("naca4412")
    angle = read_qblade_polar(folder / "my_blade_02.plr").zero_lift_angle()
    assert back.camber_over_chord is not None and angle > 0.0
    expected = -angle * naca.max_camber / naca.zero_lift_angle
    assert back.camber_over_chord[2] == pytest.approx(expected, rel=1e-3)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("QBlade Blade Definition File", "", "no blade file of QBlade"),
        ("HAWT", "VAWT", "ROTORTYPE is VAWT; a propeller is read, not that"),
        ("3                ", "3.5              ", "NUMBLADES must be a whole number; it is 3.5"),
        ("NUMBLADES", "BLADES", "entry '... NUMBLADES' is missing"),
        ("4.6520 ", "", "line 12: 't35.0' is no number"),
        ("0.1201        0.0000        0.5000     t17.0_nre_5mw.plr", "0.12", "six numbers"),
        ("4.6520", "-4.652", "c_over_R must be within 1e-06 ... 10; station"),
        ("36.3454 ", "x36 ", "2 ... 1000 stations expected below the heads POS CHORD TWIST"),
    ],
)
def test_what_is_wrong_is_one_line(old: str, new: str, message: str, tmp_path: Path) -> None:
    assert old in TURBINE
    path = tmp_path / "wrong.bld"
    path.write_text(TURBINE.replace(old, new, 1))
    with pytest.raises(PropellerError, match=re.escape(message)) as caught:
        read_bld(path)
    assert str(caught.value).startswith(str(path)) and "\n" not in str(caught.value)


@pytest.mark.parametrize(
    ("old", "new", "message"),
    [
        ("QBlade Multi RE Polar File", "", "no polar file of QBlade"),
        ("REYNOLDS ", "RE ", "entry 'REYNOLDS ...' is missing"),
        (" THICKNESS", " THICK", "entry '... THICKNESS' is missing"),
        ("AOA ", "ALPHA ", "two rows of numbers expected"),
        ("\n0.000000 ", "\nzero ", "numbers of a row expected, not 'zero"),
    ],
)
def test_a_wrong_polar_file_is_named(
    old: str, new: str, message: str, bld: Path, tmp_path: Path
) -> None:
    folder = tmp_path / "my_blade_polars"
    folder.mkdir()
    for file in (bld.parent / "my_blade_polars").iterdir():
        (folder / file.name).write_text(file.read_text())
    path, wrong = tmp_path / "b.bld", folder / "my_blade_01.plr"
    path.write_text(bld.read_text())
    assert old in wrong.read_text()
    wrong.write_text(wrong.read_text().replace(old, new, 1))
    with pytest.raises(PropellerError, match=re.escape(message)) as caught:
        read_bld(path)
    assert str(caught.value).startswith(f"{path}: {wrong}") and "\n" not in str(caught.value)
    with pytest.raises(ValueError, match=re.escape(message)):
        read_plr(wrong)


def test_a_polar_without_rising_lift_is_refused(bld: Path, tmp_path: Path) -> None:
    polar = read_qblade_polar(bld.parent / "my_blade_polars" / "my_blade_00.plr")
    round_root = dataclasses.replace(polar, airfoil="", values=0.0 * polar.values)
    (tmp_path / "round.plr").write_text(round_root.text())
    path = tmp_path / "b.bld"
    path.write_text(TURBINE.replace("t35.0 nre_5mw.plr", "round.plr"))
    with pytest.raises(PropellerError, match=r"round\.plr: lift does not rise through 0"):
        read_bld(path)

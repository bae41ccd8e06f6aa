"""Files of QPROP and XROTOR: round trips, their published layouts, fits of the sections."""

from __future__ import annotations

import dataclasses
import re
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from propmdao.formats.blade_tables.assumptions import AssumedBladeWarning
from propmdao.formats.exchange.qprop import read_qprop, write_qprop
from propmdao.formats.exchange.section_fits import SectionFit, section_fits
from propmdao.formats.exchange.section_polar import export_polar
from propmdao.formats.exchange.xrotor import read_xrotor, write_xrotor
from propmdao.formats.polars import read_polar
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
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
)
# The example of QPROP's guide: a propeller of 6 inches whose R is 3.05 in the unit of the stations.
GUIDE = """
Graupner CAM 6x3 folder

 2     {R}  ! Nblades  [ R ]

 0.50  5.8   ! CL0     CL_a
 -0.3  1.2   ! CLmin   CLmax

 0.028  0.050  0.020 0.5   !  CD0    CD2u   CD2l   CLCD0
 70000   -0.7              !  REref  REexp

 0.0254  0.0254   1.0  !  Rfac   Cfac   Bfac
 0.      0.       0.5   !  Radd   Cadd   Badd

#  r    chord    beta
 0.75    0.66    27.5  0.80  6.1 -0.3 1.5
 1.00    0.69    22.0
 2.00    0.55    10.2
 3.00    0.19     4.2
"""
READ: dict[str, Callable[[Path], Propeller]] = {"qprop": read_qprop, "xrotor": read_xrotor}


@pytest.fixture(scope="module")
def fits() -> list[SectionFit]:
    return section_fits(BLADE, BLADE.r_over_R)


@pytest.fixture(scope="module")
def files(tmp_path_factory: pytest.TempPathFactory) -> dict[str, Path]:
    folder = tmp_path_factory.mktemp("files")
    paths = {ending: folder / f"blade.{ending}" for ending in READ}
    assert write_qprop(paths["qprop"], BLADE) == write_xrotor(paths["xrotor"], BLADE) == 5
    return paths


@pytest.mark.parametrize("ending", READ)
def test_a_round_trip_keeps_the_planform_and_the_zero_lift_angle(
    ending: str, files: dict[str, Path], fits: list[SectionFit]
) -> None:
    with pytest.warns(AssumedBladeWarning, match="12 % thick NACA 4-digit sections of the file's"):
        back = load_propeller(files[ending])
    assert (back.name, back.n_blades) == ("blade", 3)
    assert back.diameter == pytest.approx(0.3)
    for key in ("r_over_R", "c_over_R", "beta_deg"):
        np.testing.assert_allclose(getattr(back, key), getattr(BLADE, key), rtol=1e-5)
    naca = find_airfoil("naca4412")
    per_camber = naca.zero_lift_angle / naca.max_camber
    zero_lift = np.asarray(Blade.from_propeller(back).camber_over_chord) * per_camber
    np.testing.assert_allclose(zero_lift, [fit.zero_lift for fit in fits], atol=3e-5)


def test_fits_are_near_the_polars(tmp_path: Path, fits: list[SectionFit]) -> None:
    """Line and parabola against the polar itself where a propeller works."""
    fit = fits[2]
    assert export_polar(tmp_path / "polar.txt", BLADE, 0.7, fit.re) == 53
    polar = read_polar(tmp_path / "polar.txt")
    line = fit.slope * (polar.alpha - fit.zero_lift)
    working = (polar.cl > 0.2) & (polar.cl < 0.9) & (np.abs(polar.alpha) < 0.2)
    assert working.sum() > 4
    np.testing.assert_allclose(line[working], polar.cl[working], atol=0.05)
    parabola = fit.cd_min + fit.curvature * (polar.cl - fit.cl_of_cd_min) ** 2
    np.testing.assert_allclose(parabola[working], polar.cd[working], rtol=0.1)
    assert fit.cl_max == pytest.approx(polar.cl[np.abs(polar.alpha) < 0.35].max(), abs=1e-3)
    assert -1.0 < fit.re_exponent < 0.0 and 5.0 < fit.slope < 7.0


def test_drag_at_another_reynolds_number_is_the_same_drag(fits: list[SectionFit]) -> None:
    fit, other = fits[2], fits[2].at_reynolds(3.0 * fits[2].re)
    for cl in (0.0, 0.8):
        drags = [
            (f.cd_min + f.curvature * (cl - f.cl_of_cd_min) ** 2) * (5e4 / f.re) ** f.re_exponent
            for f in (fit, other)
        ]
        assert drags[0] == pytest.approx(drags[1], rel=1e-12)


@pytest.mark.parametrize("n_crit", [5.0, 9.0])
def test_a_polar_is_read_back(n_crit: float, tmp_path: Path) -> None:
    path = tmp_path / "p.txt"
    export_polar(path, dataclasses.replace(BLADE, n_crit=n_crit), 0.5, 1.2e5)
    polar = read_polar(path)
    assert (polar.name, polar.re, polar.n_crit) == ("blade at r/R 0.5", 1.2e5, n_crit)
    assert np.interp(0.0, polar.alpha, polar.cl) == pytest.approx(0.44, abs=0.06)


def test_the_guides_example_of_qprop_is_read(tmp_path: Path) -> None:
    path = tmp_path / "cam.prop"
    path.write_text(GUIDE.format(R="3.05"))
    with pytest.warns(AssumedBladeWarning, match=r"last station, r/R 0\.9836, on to the tip"):
        blade = load_propeller(path)
    assert blade.diameter == pytest.approx(2 * 3.05 * 0.0254) and blade.n_blades == 2
    np.testing.assert_allclose(0.5 * blade.diameter * blade.c_over_R[0], 0.66 * 0.0254)
    np.testing.assert_allclose(blade.beta_deg, [28.0, 22.5, 10.7, 4.7, 4.7])
    # -CL0 / CL_a, the first station's own.
    naca = find_airfoil("naca4412")
    ratio = naca.zero_lift_angle / naca.max_camber
    assert blade.camber_over_chord is not None
    np.testing.assert_allclose(
        blade.camber_over_chord[:2] * ratio, [-0.8 / 6.1, -0.5 / 5.8], rtol=2e-3
    )


def test_a_tip_radius_in_metres_and_none_are_understood(tmp_path: Path) -> None:
    path = tmp_path / "cam.prop"
    for given in ("", str(3.0 * 0.0254)):
        path.write_text(GUIDE.format(R=given))
        with pytest.warns(AssumedBladeWarning):
            blade = read_qprop(path)
        assert blade.diameter == pytest.approx(6.0 * 0.0254) and blade.r_over_R.size == 4


@pytest.mark.parametrize(
    ("ending", "old", "new", "message"),
    [
        ("qprop", "! Nblades", "0.5 ! Nblades", "R, 0.5, must be at the last station, 0.15 m"),
        ("qprop", " 3  ! Nblades", " 3.5  ! Nblades", "Nblades must be a whole number; it is 3.5"),
        ("qprop", " 1 1 1  ! Rfac", " 1 1  ! Rfac", "numbers Rfac Cfac Bfac expected, not '1 1'"),
        ("qprop", "\n", "\n#", "a name and 7 lines of numbers expected"),
        ("xrotor", "XROTOR", "ROTOR", "no rotor file of XROTOR from version 6.9 on"),
        ("xrotor", " 5 3\n", " 6 3\n", "ends ahead of r/R C/R Beta0deg Ubody"),
        ("xrotor", " 5 3\n", " 5 3.2\n", "a whole number expected; it is 3.2"),
        ("xrotor", "! Naero\n 5", "! Naero\n 50", "Naero must be 1 ... 20; it is 50"),
        ("xrotor", "! XI0 XIW\n 0.2", "! XI0 XIW\n x", "numbers XI0 XIW expected, not 'x 0.0'"),
        ("xrotor", "0.15 34 0.0", "-0.15 34 0.0", "c_over_R must be within 1e-06 ... 10; station"),
    ],
)
def test_what_is_wrong_is_one_line(
    ending: str, old: str, new: str, message: str, files: dict[str, Path], tmp_path: Path
) -> None:
    text = files[ending].read_text()
    assert old in text
    path = tmp_path / f"wrong.{ending}"
    path.write_text(text.replace(old, new) if old == "\n" else text.replace(old, new, 1))
    with pytest.raises(PropellerError, match=re.escape(message)) as caught:
        READ[ending](path)
    assert str(caught.value).startswith(str(path)) and "\n" not in str(caught.value)


def test_qprop_has_room_for_81_stations(tmp_path: Path) -> None:
    r = np.linspace(0.1, 1.0, 82)
    blade = Propeller("many", 0.3, 2, r, 0.1 + 0.0 * r, 20.0 + 0.0 * r, [(1.0, "naca4412")])
    with pytest.raises(ValueError, match="QPROP takes up to 81 stations; many has 82"):
        write_qprop(tmp_path / "many.qprop", blade)


def test_xrotor_has_room_for_20_sections(tmp_path: Path) -> None:
    r = np.linspace(0.1, 1.0, 30)
    blade = Propeller("many", 0.3, 2, r, 0.1 + 0.0 * r, 20.0 + 0.0 * r, [(1.0, "naca4412")])
    assert write_xrotor(tmp_path / "many.xrotor", blade) == 30
    text = (tmp_path / "many.xrotor").read_text()
    assert text.count("Xisection") == 20 and "! Naero\n 20\n" in text
    positions = [float(p) for p in re.findall(r"Xisection\n (\S+)", text)]
    assert positions[0] == pytest.approx(0.1) and positions[-1] == 1.0

"""Airfoils: mean lines against thin-airfoil theory, contours against what was put in."""

from __future__ import annotations

from pathlib import Path

import numpy as np
import pytest

from propmdao.propeller.airfoils.airfoil import (
    CHORD_FRACTION,
    DESIGN_LIFT_WEIGHTS,
    ZERO_LIFT_WEIGHTS,
    Airfoil,
    AirfoilError,
    max_camber_for_design_lift,
    naca4,
    naca4_camber_line,
    naca4_from_name,
)
from propmdao.propeller.airfoils.coordinate_files import read_coordinates
from propmdao.propeller.airfoils.coordinates import airfoil_from_coordinates
from propmdao.propeller.airfoils.library import find_airfoil

# The polygon through the 81 grid points misses the curvature between them: (pi/80)^2 / 4 at most.
POLYGON = 5e-4


def naca4_design_lift(position: float) -> float:
    """2 * integral of (dz/dx) cos(angle) for unit camber, both parabolas in closed form."""
    split = np.arccos(1.0 - 2.0 * position)

    def integral(angle: float) -> float:
        return (2.0 * position - 1.0) * np.sin(angle) + angle / 2.0 + np.sin(2.0 * angle) / 4.0

    front = integral(split) / position**2
    rear = (integral(np.pi) - integral(split)) / (1.0 - position) ** 2
    return 2.0 * (front + rear)


def test_parabolic_mean_line_has_its_closed_form_lift() -> None:
    line = 4.0 * CHORD_FRACTION * (1.0 - CHORD_FRACTION)
    assert line @ DESIGN_LIFT_WEIGHTS == pytest.approx(4.0 * np.pi, rel=POLYGON)
    assert line @ ZERO_LIFT_WEIGHTS == pytest.approx(-2.0, rel=POLYGON)


@pytest.mark.parametrize("position", [0.2, 0.4, 0.6])
def test_naca_mean_line_has_its_closed_form_design_lift(position: float) -> None:
    line = naca4_camber_line(1.0, position)
    assert line @ DESIGN_LIFT_WEIGHTS == pytest.approx(naca4_design_lift(position), rel=POLYGON)


def test_a_plate_at_an_angle_is_its_zero_lift_angle() -> None:
    nose_down = 0.03 * CHORD_FRACTION
    assert nose_down @ ZERO_LIFT_WEIGHTS == pytest.approx(0.03, rel=POLYGON)


def test_six_percent_camber_at_forty_percent_chord_lifts_0767() -> None:
    # The figure is quoted to three digits; closed form 0.7681.
    assert 0.06 * naca4_camber_line(1.0, 0.4) @ DESIGN_LIFT_WEIGHTS == pytest.approx(
        0.767, abs=1.2e-3
    )


@pytest.mark.parametrize(("design_lift", "first_digit"), [(0.779, 6), (0.390, 3), (0.531, 4)])
def test_design_lift_of_published_sections_gives_their_first_digit(
    design_lift: float, first_digit: int
) -> None:
    assert round(100.0 * max_camber_for_design_lift(design_lift)) == first_digit


def test_naca4412_by_name_is_the_published_section() -> None:
    section = naca4_from_name("naca4412")
    assert section.max_camber == pytest.approx(0.04, rel=1e-4)
    assert section.max_thickness == pytest.approx(0.12, rel=1e-3)
    assert np.degrees(section.zero_lift_angle) == pytest.approx(-4.15, abs=0.01)
    # The series' polynomial leaves 2 * 0.00126 at the trailing edge of a 12 % section.
    assert section.thickness[-1] == pytest.approx(0.00252)


def test_symmetric_naca_name_has_no_camber() -> None:
    assert not naca4_from_name("naca0012").camber.any()


@pytest.mark.parametrize(
    ("name", "thickness", "camber", "position", "zero_lift_deg"),
    [("e63", 0.0427, 0.0538, 0.52, -8.2), ("clarky", 0.117, 0.0343, 0.42, -3.4)],
)
def test_catalogue_airfoil_has_its_published_figures(
    name: str, thickness: float, camber: float, position: float, zero_lift_deg: float
) -> None:
    section = find_airfoil(name)
    assert section.max_thickness == pytest.approx(thickness, abs=1e-4)
    assert section.max_camber == pytest.approx(camber, abs=1e-4)
    assert CHORD_FRACTION[section.camber.argmax()] == pytest.approx(position, abs=0.01)
    assert np.degrees(section.zero_lift_angle) == pytest.approx(zero_lift_deg, abs=0.05)


def contour(section: Airfoil, n_points: int) -> tuple[np.ndarray, np.ndarray]:
    """Contour in Selig's order through an evenly spaced part of the shared grid."""
    step = (CHORD_FRACTION.size - 1) // n_points
    x = CHORD_FRACTION[::step]
    upper = (section.camber + 0.5 * section.thickness)[::step]
    lower = (section.camber - 0.5 * section.thickness)[::step]
    return np.append(x[::-1], x[1:]), np.append(upper[::-1], lower[1:])


def test_split_returns_what_the_contour_was_made_of() -> None:
    section = naca4(0.05, 0.4, 0.10)
    again = airfoil_from_coordinates("same", *contour(section, 80))
    np.testing.assert_allclose(again.camber, section.camber, atol=1e-12)
    np.testing.assert_allclose(again.thickness, section.thickness, atol=1e-12)


def test_split_converges_with_the_points_of_the_contour() -> None:
    # Second order: the curvature of a NACA contour over chord angle jumps at the nose.
    section = naca4(0.05, 0.4, 0.10)
    error = [
        np.abs(airfoil_from_coordinates("s", *contour(section, n)).thickness - section.thickness)
        for n in (10, 20, 40)
    ]
    assert error[0].max() < 1e-3
    assert error[1].max() < error[0].max() / 3.5
    assert error[2].max() < error[1].max() / 3.5


def write_points(path: Path, title: str, rows: list[tuple[float, float]]) -> Path:
    path.write_text(title + "\n" + "".join(f" {x:.9f}  {z:.9f}\n" for x, z in rows))
    return path


def test_selig_and_lednicer_order_are_the_same_section(tmp_path: Path) -> None:
    x, z = contour(naca4(0.03, 0.4, 0.09), 40)
    selig = list(zip(x, z, strict=True))
    lednicer = [(41.0, 41.0), *selig[40::-1], *selig[40:]]
    first = read_coordinates(write_points(tmp_path / "selig.dat", "A section", selig))
    second = read_coordinates(write_points(tmp_path / "lednicer.dat", "A section", lednicer))
    np.testing.assert_array_equal(first.camber, second.camber)
    np.testing.assert_array_equal(first.thickness, second.thickness)
    assert (first.name, second.name) == ("selig", "lednicer")


def test_a_file_without_title_loses_no_point(tmp_path: Path) -> None:
    x, z = contour(naca4(0.03, 0.4, 0.09), 40)
    rows = list(zip(x, z, strict=True))
    path = write_points(tmp_path / "plain.dat", "", rows)
    path.write_text(path.read_text().lstrip())
    assert read_coordinates(path).thickness[-1] == pytest.approx(0.00189, abs=1e-8)


@pytest.mark.parametrize("name", ["e63", "clarky"])
def test_catalogue_airfoil_follows_the_published_contour(name: str, reference_data: Path) -> None:
    published = read_coordinates(reference_data / "airfoils" / f"{name}.dat")
    shipped = find_airfoil(name)
    # The catalogue keeps six decimals.
    np.testing.assert_allclose(shipped.camber, published.camber, atol=1e-6)
    np.testing.assert_allclose(shipped.thickness, published.thickness, atol=1e-6)


def test_naca0012_follows_the_published_contour(reference_data: Path) -> None:
    published = read_coordinates(reference_data / "airfoils" / "naca0012.dat")
    np.testing.assert_allclose(
        naca4_from_name("naca0012").thickness, published.thickness, atol=4e-5
    )


@pytest.mark.parametrize(
    ("name", "message"),
    [
        ("e36", r"unknown airfoil 'e36'; near: e63; also 'naca4412' or a path to a \.dat"),
        ("naca44120", "'naca44120' is no NACA 4-digit section; write it like 'naca4412'"),
        ("naca4400", "'naca4400' names no thickness or no position of its camber"),
        ("naca4012", "'naca4012' names no thickness or no position of its camber"),
        ("missing.dat", r"airfoil file 'missing\.dat' cannot be read: No such file"),
    ],
)
def test_a_wrong_name_is_one_clear_line(name: str, message: str) -> None:
    with pytest.raises(AirfoilError, match=message) as caught:
        find_airfoil(name)
    assert "\n" not in str(caught.value)


def test_a_side_that_folds_back_is_refused() -> None:
    x, z = contour(naca4(0.03, 0.4, 0.09), 40)
    x[[10, 11]] = x[[11, 10]]
    with pytest.raises(AirfoilError, match="a side folds back at x/c"):
        airfoil_from_coordinates("folded", x, z)

"""Coordinate files as they are found: what is certain is read, the rest refused for its reason."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from pathlib import Path

import numpy as np
import pytest

from propmdao.propeller.airfoils.airfoil import Airfoil, AirfoilError, chord_interpolation, naca4
from propmdao.propeller.airfoils.contours import AirfoilFrameWarning
from propmdao.propeller.airfoils.coordinate_files import read_coordinates
from propmdao.propeller.airfoils.coordinates import airfoil_from_coordinates

ANGLE = np.linspace(0.0, np.pi, 21)
OPERATOR = chord_interpolation(ANGLE)


def contour(section: Airfoil) -> np.ndarray:
    """Points in Selig's order, (41, 2)."""
    x = 0.5 * (1.0 - np.cos(ANGLE))
    middle, half = OPERATOR @ section.camber, 0.5 * OPERATOR @ section.thickness
    upper, lower = np.stack([x, middle + half], axis=1), np.stack([x, middle - half], axis=1)
    return np.concatenate([upper[::-1], lower[1:]])


SECTION = naca4(0.03, 0.4, 0.09)
POINTS = contour(SECTION)
PLAIN = airfoil_from_coordinates("plain", *POINTS.T)
UPPER, LOWER = POINTS[20::-1], POINTS[20:]


def lines(points: np.ndarray) -> str:
    return "".join(f" {x:.12f}  {z:.12f}\n" for x, z in points)


def written(folder: Path, text: str) -> Path:
    path = folder / "section.dat"
    path.write_bytes(text.encode())
    return path


BLOCKS = lines(UPPER) + "\nlower side\n" + lines(LOWER)
SAME = {
    "no title": lines(POINTS),
    "two lines of title": "my section\nby me, 1998\n" + lines(POINTS),
    "number of points": "my section\n41\n" + lines(POINTS),
    "corners of a grid": "my section\n-2.0 3.0 -2.5 3.5\n" + lines(POINTS),
    "byte order mark": "\ufeff" + lines(POINTS),
    "text behind": "t\n"
    + lines(POINTS)
    + "\ndrawn for the club, March\nThickness: 9 %\n12 nov 01\n",
    "end of file of DOS": "t\n" + lines(POINTS) + "\x1a",
    "lines of Windows": "t\r\n" + lines(POINTS).replace("\n", "\r\n"),
    "repeated point": "t\n" + lines(np.repeat(POINTS, 1 + (np.arange(41) == 7), axis=0)),
    "clockwise": "t\n" + lines(POINTS[::-1]),
    "leading edge first": "t\n" + lines(np.roll(POINTS, 20, axis=0)),
    "from the middle of a side": "t\n" + lines(np.roll(POINTS, 8, axis=0)),
    "Lednicer": "t\n21. 21.\n\n" + lines(UPPER) + "\n" + lines(LOWER),
    "headings": "t\nupper side\n" + BLOCKS,
    "lower side first": "t\n" + lines(LOWER) + lines(UPPER),
    "both from the trailing edge": "t\n" + lines(UPPER[::-1]) + lines(LOWER[::-1]),
    "per cent": "t\n" + lines(100.0 * POINTS),
    "per cent, Lednicer": "t\n21 21\n" + lines(100.0 * UPPER) + lines(100.0 * LOWER),
    "decimal commas": "t\n" + lines(POINTS).replace(".", ","),
    "semicolons": "t\n" + lines(POINTS).replace("  ", "; "),
}


@pytest.mark.parametrize("form", SAME)
def test_what_is_certain_is_the_same_section(form: str, tmp_path: Path) -> None:
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        section = read_coordinates(written(tmp_path, SAME[form]))
    np.testing.assert_allclose(section.camber, PLAIN.camber, atol=1e-11)
    np.testing.assert_allclose(section.thickness, PLAIN.thickness, atol=1e-11)


def damaged(number: int, text: str) -> str:
    rows = ["t", *lines(POINTS).splitlines()]
    rows[number - 1] = text
    return "\n".join(rows) + "\n"


EXPECTED = "two numbers x z expected, not "
REFUSED = {
    "a word": (damaged(3, " 0.9 abc"), f", line 3: {EXPECTED}'0.9 abc'; points stand before"),
    "a damaged last point": (damaged(42, "1.0000 0.0x2"), f", line 42: {EXPECTED}'1.0000 0.0x2'"),
    "a damaged first point": (damaged(1, "1.0000 0.0x2"), f", line 1: {EXPECTED}'1.0000 0.0x2'"),
    "three columns": (damaged(5, "0.9 0.0 0.0"), f", line 5: {EXPECTED}'0.9 0.0 0.0'"),
    "first row of inf": (damaged(2, "inf inf"), ", line 2: 'inf' is not finite"),
    "nan": (damaged(9, "0.5 nan"), ", line 9: 'nan' is not finite"),
    "1e308": (damaged(9, "0.5 1e308"), ", line 9: '1e308' is out of range"),
    "400 digits": (damaged(9, f"0.5 {'9' * 400}"), f", line 9: '{'9' * 57}...' is not finite"),
    "counts": (
        "t\n20. 21.\n" + lines(UPPER) + lines(LOWER),
        ", line 2: 20 and 21 are no point over chord, and as numbers of points of the sides they "
        "do not add up to 42, the points that follow",
    ),
    "two elements": (damaged(20, "999.0 999.0"), ", line 20: another element begins"),
    "a notch": ("t\n" + lines(POINTS[[*range(9), 10, 9, *range(11, 41)]]), "a side folds back at"),
    "half a side missing": (
        "t\n" + lines(POINTS[:32]),
        "its lower side ends at x = 0.578217, ahead of the trailing edge at x = 1; the points",
    ),
    "no points": ("title\n", "'section' needs at least 10 finite points"),
    "upright": ("t\n" + lines(POINTS[:, ::-1]), "along a chord in x; it has 41, 0.0"),
    "steep": (
        "t\n" + lines(POINTS @ np.array([[0.9, 0.4], [-0.4, 0.9]])),
        "the chord line must be within 15 deg of the x axis; from (0, 0) to (0.9, 0.4) it is",
    ),
    "crossed": (
        "t\n" + lines(POINTS + np.outer(np.where(np.arange(41) < 15, -0.03, 0.0), [0.0, 1.0])),
        "the sides cross; at x/c 1.000 the upper one is 0.02811 of the chord below the lower one",
    ),
}


@pytest.mark.parametrize("case", REFUSED)
def test_what_is_not_certain_is_refused_for_its_reason(case: str, tmp_path: Path) -> None:
    text, message = REFUSED[case]
    with pytest.raises(AirfoilError) as caught:
        read_coordinates(written(tmp_path, text))
    assert message in str(caught.value)
    assert "section" in str(caught.value) and "\n" not in str(caught.value)


def test_a_path_that_no_file_can_have_is_one_line() -> None:
    with pytest.raises(AirfoilError, match="cannot be read: embedded null byte in its path"):
        read_coordinates(Path("a\0b.dat"))


# A section with a cusp, drawn with five digits: its points do not cross, a cubic spline through
# them does, behind 0.95 of the chord.
CUSP_X = [1.0, 0.95, 0.9, 0.8, 0.7, 0.6, 0.5, 0.4, 0.3, 0.2, 0.1, 0.05, 0.025, 0.0125, 0.0]
CUSP_UPPER = [0, 950, 1950, 3850, 5500, 6800, 7700, 8100, 7900, 7000, 5200, 3700, 2600, 1800, 0]
CUSP_LOWER = [
    0,
    350,
    300,
    -350,
    -1200,
    -2100,
    -2900,
    -3400,
    -3500,
    -3300,
    -2700,
    -2100,
    -1600,
    -1200,
]


def cusp() -> tuple[np.ndarray, np.ndarray]:
    x = np.array([*CUSP_X, *CUSP_X[-2::-1]])
    return x, 1e-5 * np.array([*CUSP_UPPER, *CUSP_LOWER[::-1]])


def distance(section: Airfoil, x: np.ndarray, z: np.ndarray) -> np.ndarray:
    """Difference in z between points in Selig's order and the section there."""
    nose = int(np.argmin(x))
    operator = chord_interpolation(np.arccos(1.0 - 2.0 * x))
    side = np.where(np.arange(x.size) <= nose, 0.5, -0.5)
    return np.asarray(operator @ section.camber + side * (operator @ section.thickness) - z)


def test_a_cusped_trailing_edge_is_read_within_its_points() -> None:
    x, z = cusp()
    section = airfoil_from_coordinates("cusp", x, z)
    assert section.max_thickness == pytest.approx(0.1155, abs=0.0005)  # 0.1150 at 0.4 c, drawn
    assert (section.thickness[1:-1] > 0.0).all() and section.thickness[-1] == 0.0
    assert np.abs(distance(section, x, z)).max() < 5e-4


def test_sides_that_touch_keep_a_wedge() -> None:
    x, z = cusp()
    z[1] = z[-2] = 0.5 * (z[1] + z[-2])
    section = airfoil_from_coordinates("cusp", x, z)
    assert section.thickness[-2] == pytest.approx(0.002 * (1.0 - np.cos(np.pi / 80.0)) / 2.0)
    assert np.abs(distance(section, x, z)).max() < 5e-4


def test_a_spline_that_swings_between_close_points_is_not_taken() -> None:
    x, z = cusp()
    # A point 0.01 % of the chord beside another and 0.3 % above it, as digitised tables have.
    x, z = np.insert(x, 6, 0.5001), np.insert(z, 6, 0.0740)
    assert np.abs(distance(airfoil_from_coordinates("swing", x, z), x, z)).max() < 4e-3


@pytest.mark.parametrize(
    ("place", "said"),
    [
        (
            lambda p: p + np.outer(1.0 - p[:, 0], [0.0, 0.03]),
            "its nose is at (0, 0.03) and its trailing edge at (1, 0); it was turned by 1.72 deg "
            "and scaled by 0.99955 onto its chord line",
        ),
        (lambda p: 0.25 * p, "turned by -0 deg and scaled by 4 onto its chord line"),
        (lambda p: p + np.array([0.1, 0.0]), "its nose is at (0.1, 0)"),
    ],
)
def test_a_section_off_its_axis_is_put_on_its_chord_line(
    place: Callable[[np.ndarray], np.ndarray], said: str
) -> None:
    symmetric = contour(naca4(0.0, 0.4, 0.12))
    straight = airfoil_from_coordinates("s", *symmetric.T)
    with pytest.warns(AirfoilFrameWarning) as caught:
        section = airfoil_from_coordinates("s", *place(symmetric).T)
    assert said in str(caught[0].message)
    # Sheared by 3 % is turned by 1.7 deg, but for the square of that angle.
    np.testing.assert_allclose(section.thickness, straight.thickness, atol=1e-3)
    np.testing.assert_allclose(section.camber, 0.0, atol=1e-3)


def test_a_left_out_last_point_is_closed_and_said() -> None:
    symmetric = contour(naca4(0.0, 0.4, 0.12))
    symmetric[[0, -1], 1] = 0.0
    whole = airfoil_from_coordinates("s", *symmetric.T)
    thinned = np.delete(symmetric, [1, 39, 40], axis=0)
    with pytest.warns(AirfoilFrameWarning, match="its lower side ends at x = 0.975528, ahead of"):
        section = airfoil_from_coordinates("s", *thinned.T)
    np.testing.assert_allclose(section.thickness, whole.thickness, atol=2e-3)


def test_corners_of_a_blunt_trailing_edge_may_be_oblique() -> None:
    section = naca4(0.0, 0.4, 0.12)
    points = contour(section) + np.outer(np.abs(np.arange(41) - 20) / 20.0, [0.0, 0.03])
    points[20:, 1] -= 2.0 * np.arange(21) / 20.0 * 0.03
    blunt = airfoil_from_coordinates("b", *points.T)
    points[0, 0] += 0.003
    oblique = airfoil_from_coordinates("b", *points.T)
    assert blunt.thickness[-1] == pytest.approx(0.0625, abs=5e-4)
    assert oblique.thickness[-1] == pytest.approx(blunt.thickness[-1], abs=5e-4)

"""Angles between chord line, parting line and a gauge under the section."""

from __future__ import annotations

import numpy as np
import pytest
from scipy.spatial import ConvexHull

from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION, naca4
from propmdao.propeller.airfoils.datums import chord_from_flat_bottom, chord_from_parting_line
from propmdao.propeller.airfoils.library import find_airfoil

FLAT = np.zeros(CHORD_FRACTION.size)


def test_all_lines_of_a_flat_plate_are_the_chord_line() -> None:
    plate = np.full(CHORD_FRACTION.size, 1e-9)
    assert chord_from_parting_line(FLAT, plate, 0.5) == pytest.approx(0.0, abs=1e-8)
    assert chord_from_flat_bottom(FLAT, plate) == pytest.approx(0.0, abs=1e-8)


@pytest.mark.parametrize("beta", [0.1, 0.2, 0.5])
def test_the_foremost_point_of_a_round_nose_lies_below_it(beta: float) -> None:
    """On the parabola z^2 = 2 r x of a nose the foremost point is at z = -r tan(beta).

    The rear is the upper corner of the blunt edge, 0.0105 t above the chord line.
    """
    t = 0.03
    steeper = np.arctan(1.1019 * t**2 * np.tan(beta) + 0.0105 * t)
    angle = chord_from_parting_line(FLAT, naca4(0.0, 0.4, t).thickness, beta - steeper)
    assert angle == pytest.approx(steeper, rel=0.02, abs=5e-5)  # 0.003 deg


def test_the_flat_bottom_of_clark_y_is_two_degrees_from_its_chord() -> None:
    section = find_airfoil("clarky")
    angle = chord_from_flat_bottom(section.camber, section.thickness)
    lower = section.camber - 0.5 * section.thickness
    flat = CHORD_FRACTION > 0.35
    slopes = np.degrees(np.arctan(np.diff(lower[flat]) / np.diff(CHORD_FRACTION[flat])))
    np.testing.assert_allclose(slopes, np.degrees(angle), atol=0.1)
    assert 1.9 < np.degrees(angle) < 2.2


@pytest.mark.parametrize("name", ["e63", "naca4412", "naca6409", "clarky"])
def test_a_gauge_rests_on_the_convex_hull(name: str) -> None:
    section = find_airfoil(name)
    lower = section.camber - 0.5 * section.thickness
    hull = ConvexHull(np.column_stack([CHORD_FRACTION, lower]))
    edges = [
        sorted(hull.points[simplex].tolist())
        for simplex, equation in zip(hull.simplices, hull.equations, strict=True)
        if equation[1] < 0.0
    ]
    ((x0, z0), (x1, z1)) = next(edge for edge in edges if edge[0][0] < 0.5 <= edge[1][0])
    angle = np.arctan2(z1 - z0, x1 - x0)
    gauged = chord_from_flat_bottom(section.camber, section.thickness)
    assert gauged == pytest.approx(angle, abs=2e-4)
    assert gauged > 0.0


def test_a_hollow_section_is_gauged_at_its_ends() -> None:
    """NACA 4412: lowest at 0.12 c, 2.95 % below the chord line; the edge is 0.13 % below it."""
    section = find_airfoil("naca4412")
    x, lower = CHORD_FRACTION, section.camber - 0.5 * section.thickness
    touched = np.argmax((lower[-1] - lower[:-1]) / (1.0 - x[:-1]))
    assert 0.05 < x[touched] < 0.2
    angle = chord_from_flat_bottom(section.camber, section.thickness)
    assert angle == pytest.approx((0.0295 - 0.0013) / 0.88, rel=0.03)

"""Continuation through all angles."""

from __future__ import annotations

import numpy as np
import pytest

from propmdao.aerodynamics.sections.polars.high_angle import (
    ALPHA,
    ATTACHED,
    ATTACHED_DEG,
    BROADSIDE_DRAG,
    all_angles,
    trusted_range,
    viterna,
)

THIN_LIFT = 2.0 * np.pi * np.sin(np.radians(ATTACHED_DEG))[None]
DRAG = 0.02 + 0.01 * np.abs(THIN_LIFT)
STALL = 12
LOW, HIGH = (np.array([int(np.flatnonzero(ATTACHED_DEG == side * STALL)[0])]) for side in (-1, 1))


@pytest.fixture
def thin() -> np.ndarray:
    """cl, ln(cd), cm of a symmetric section that holds within 12 deg."""
    return all_angles(THIN_LIFT, DRAG, np.zeros_like(DRAG), LOW, HIGH)[0]


def test_viterna_starts_from_the_stall_and_ends_broadside() -> None:
    stall, cl, cd = (np.array([[value]]) for value in (np.radians(13.0), 1.2, 0.05))
    lift, drag = viterna(np.array([np.radians(13.0), 0.5 * np.pi]), stall, cl, cd)
    np.testing.assert_allclose(lift[0], [1.2, 0.0], atol=1e-14)
    np.testing.assert_allclose(drag[0], [0.05, BROADSIDE_DRAG], atol=1e-14)


def test_the_polar_is_as_given_between_the_stalls(thin: np.ndarray) -> None:
    inside = np.abs(ATTACHED_DEG) <= STALL
    np.testing.assert_allclose(thin[0, ATTACHED][inside], THIN_LIFT[0, inside], atol=1e-14)
    np.testing.assert_allclose(np.exp(thin[1, ATTACHED][inside]), DRAG[0, inside], rtol=1e-12)


def test_a_symmetric_section_stays_symmetric(thin: np.ndarray) -> None:
    np.testing.assert_allclose(thin[0], -thin[0, ::-1], atol=1e-12)
    np.testing.assert_allclose(thin[1], thin[1, ::-1], atol=1e-12)
    np.testing.assert_allclose(thin[2], -thin[2, ::-1], atol=1e-12)


def test_both_ends_are_one_angle(thin: np.ndarray) -> None:
    np.testing.assert_allclose(thin[:, 0], thin[:, -1], atol=1e-12)
    assert thin[0, 0] == pytest.approx(0.0, abs=1e-12)


def test_a_stalled_section_is_pushed_back_and_its_centre_of_pressure_moves_back(
    thin: np.ndarray,
) -> None:
    cl, log_cd, cm = thin
    broadside = int(np.argmin(np.abs(ALPHA - 0.5 * np.pi)))
    assert np.exp(log_cd).max() == pytest.approx(BROADSIDE_DRAG, rel=1e-6)
    assert cl[broadside] == pytest.approx(0.0, abs=1e-12)
    assert cm[broadside] == pytest.approx(-0.25 * BROADSIDE_DRAG, rel=1e-6)  # pressed at mid chord


def test_trust_ends_past_stall_where_confidence_is_lost() -> None:
    angle = ATTACHED_DEG[None]
    cl = np.where(np.abs(angle) < 10.0, 0.1 * angle, np.sign(angle) * (1.2 - 0.02 * np.abs(angle)))
    sure = np.where((angle > 13.5) | (angle == 2.0), 0.2, 0.9)  # a dip before stall is not asked
    low, high = trusted_range(cl, sure)
    assert (ATTACHED_DEG[low[0]], ATTACHED_DEG[high[0]]) == (-20.0, 14.0)

"""Observers on an arc, and the limit of the method."""

import numpy as np
import pytest

from propmdao.acoustics import arc, require_subsonic_tip


def test_elevation_is_from_the_rotor_plane_negative_below():
    expected = [[2.0, 0.0, 0.0], [np.sqrt(2), 0.0, -np.sqrt(2)], [0.0, 0.0, 2.0]]
    np.testing.assert_allclose(arc(2.0, [0.0, -45.0, 90.0]), expected, atol=1e-15)


def test_one_observer_and_a_radius_for_each():
    assert arc(1.0, 0.0).shape == (1, 3)
    np.testing.assert_allclose(np.linalg.norm(arc([1.0, 3.0], -20.0), axis=1), [1.0, 3.0])


@pytest.mark.parametrize(
    ("radius", "elevation_deg", "message"),
    [
        ([1.0, -2.0], 0.0, r"observer radius must be positive and finite \[m\]; got -2"),
        (np.nan, 0.0, r"observer radius must be positive and finite \[m\]; got nan"),
        (1.0, [10.0, 95.0], "observer elevation must be within -90 ... 90 deg; got 95"),
    ],
)
def test_impossible_places_are_refused(radius, elevation_deg, message):
    with pytest.raises(ValueError, match=message):
        arc(radius, elevation_deg)


def test_a_sonic_tip_is_refused_with_its_mach_number():
    require_subsonic_tip(1.0, 300.0, 100.0, 340.0)
    with pytest.raises(ValueError, match=r"must be below 1 for Formulation 1A; it is 1\.031"):
        require_subsonic_tip(1.0, 320.0, 140.0, 340.0 * 0.9965)

"""Observers around a rotor, their names, and the limits of the method."""

import numpy as np
import pytest

from propmdao.acoustics.kinematics.limits import require_outside_rotor, require_subsonic_tip
from propmdao.acoustics.kinematics.observers import (
    arc,
    circle,
    directions,
    grid,
    hemisphere,
    labels,
    on_map,
    point,
    sphere,
)
from propmdao.records.air import Air
from propmdao.records.states import RotorState


def test_elevation_is_from_the_rotor_plane_negative_below():
    expected = [[2.0, 0.0, 0.0], [np.sqrt(2), 0.0, -np.sqrt(2)], [0.0, 0.0, 2.0]]
    np.testing.assert_allclose(arc(2.0, [0.0, -45.0, 90.0]), expected, atol=1e-15)


def test_one_observer_and_a_radius_for_each():
    assert arc(1.0, 0.0).shape == (1, 3)
    np.testing.assert_allclose(np.linalg.norm(arc([1.0, 3.0], -20.0), axis=1), [1.0, 3.0])


def test_azimuth_is_about_the_rotor_axis_from_x():
    np.testing.assert_allclose(point(3.0, 0.0, 90.0), [[0.0, 3.0, 0.0]], atol=1e-15)
    np.testing.assert_allclose(point(3.0, -20.0, 0.0), arc(3.0, -20.0))


@pytest.mark.parametrize(
    ("radius", "elevation_deg", "message"),
    [
        ([1.0, -2.0], 0.0, r"observer radius must be within 0.001 ... 1000000 m; got -2"),
        (np.nan, 0.0, r"observer radius must be within 0.001 ... 1000000 m; got nan"),
        (1.0, [10.0, 95.0], "observer elevation must be within -90 ... 90 deg; got 95"),
    ],
)
def test_impossible_places_are_refused(radius, elevation_deg, message):
    with pytest.raises(ValueError, match=message):
        arc(radius, elevation_deg)


@pytest.mark.parametrize(
    ("place", "message"),
    [
        (
            lambda: point(1.0, 0.0, np.inf),
            r"observer azimuth must be within -3600 ... 3600 deg; got inf",
        ),
        (lambda: circle(1.0, 0), "a circle needs at least 1 observer; got 0"),
        (lambda: hemisphere(1.0, 7.0), "step of a hemisphere must divide 90 deg; got 7"),
        (lambda: hemisphere(1.0, 0.0), "step of a hemisphere must be within 1 ... 90 deg; it is 0"),
    ],
)
def test_impossible_sets_are_refused(place, message):
    with pytest.raises(ValueError, match=message):
        place()


def test_a_circle_in_the_rotor_plane_and_on_a_cone_below_it():
    expected = [[2.0, 0, 0], [0, 2.0, 0], [-2.0, 0, 0], [0, -2.0, 0]]
    np.testing.assert_allclose(circle(2.0, 4), expected, atol=1e-15)
    np.testing.assert_allclose(circle(2.0, 5, -30.0)[:, 2], -1.0)


def test_a_sphere_is_a_map_of_elevations_by_azimuths():
    elevation, azimuth = [-60.0, 0.0, 30.0], [-90.0, 0.0]
    seen = directions(sphere(4.0, elevation, azimuth).reshape(3, 2, 3))
    np.testing.assert_allclose(seen.radius, 4.0)
    np.testing.assert_allclose(seen.elevation_deg, np.outer(elevation, [1, 1]), atol=1e-12)
    np.testing.assert_allclose(seen.azimuth_deg, [azimuth] * 3, atol=1e-12)


def test_a_hemisphere_is_the_lower_one_and_has_nobody_twice():
    positions = hemisphere(2.0, 30.0)
    assert positions.shape == (1 + 3 * 12, 3)
    assert positions[:, 2].max() == pytest.approx(0.0, abs=1e-15)
    np.testing.assert_allclose(positions[0], [0, 0, -2.0], atol=1e-12)
    apart = np.linalg.norm(positions[:, None] - positions, axis=-1) + 9.0 * np.eye(37)
    assert apart.min() > 0.5


def test_values_of_a_hemisphere_are_laid_out_where_their_observers_are():
    positions = hemisphere(2.0, 30.0)
    x, y, z = (on_map(coordinate) for coordinate in positions.T)
    elevation, azimuth = np.meshgrid(np.radians(x.elevation_deg), np.radians(x.azimuth_deg))
    assert x.values.shape == (4, 13) and x.azimuth_deg[-1] == 360.0
    np.testing.assert_allclose(x.values, (2 * np.cos(elevation) * np.cos(azimuth)).T, atol=1e-12)
    np.testing.assert_allclose(y.values, (2 * np.cos(elevation) * np.sin(azimuth)).T, atol=1e-12)
    np.testing.assert_allclose(z.values, (2 * np.sin(elevation)).T, atol=1e-12)
    for wrong in (1, 36, 52):
        with pytest.raises(ValueError, match=rf"1 \+ 4 n\^2 observers; got {wrong}"):
            on_map(np.zeros(wrong))


def test_a_grid_has_every_combination():
    positions = grid([0.0, 1.0], [-1.0, 0.0, 1.0], -2.0)
    assert positions.shape == (6, 3)
    np.testing.assert_allclose(positions[[0, 5]], [[0, -1, -2], [1, 1, -2]])


def test_directions_undo_points():
    radius, elevation, azimuth = [1.0, 2.0, 5.0], [-80.0, 0.0, 45.0], [-170.0, 20.0, 180.0]
    np.testing.assert_allclose(directions(point(radius, elevation, azimuth))[0], radius)
    np.testing.assert_allclose(
        directions(point(radius, elevation, azimuth))[1], elevation, atol=1e-12
    )
    np.testing.assert_allclose(directions(point(radius, elevation, azimuth))[2], azimuth)


def test_observers_are_named_by_what_tells_them_apart():
    assert labels(arc(1.905, [45.0, 22.5, 0.0, -45.0])) == ["45°", "22.5°", "0°", "-45°"]
    assert labels(point(1.0, [-45.0, 0.0, -90.0], [90.0, -60.0, 30.0])) == [
        "-45°, azimuth 90°",
        "0°, azimuth -60°",
        "-90°, azimuth 0°",
    ]
    assert labels(arc([1.0, 2.5], 0.0)) == ["0°, 1 m", "0°, 2.5 m"]


def test_an_observer_among_the_blades_is_refused_with_its_distance():
    require_outside_rotor(arc(0.14, [0.0, -45.0]), 0.1397)
    with pytest.raises(
        ValueError,
        match=r"observer 2 is inside the source region: 0.1 m from the rotor centre; "
        r"sources reach to 0.1397 m",
    ):
        require_outside_rotor(arc([1.0, 0.1], 0.0), 0.1397)


def test_a_sonic_tip_is_refused_with_its_mach_number():
    require_subsonic_tip(1.0, RotorState(300.0, 100.0, Air(sound_speed=340.0)))
    with pytest.raises(ValueError, match=r"must be below 1 for Formulation 1A; it is 1\.031"):
        require_subsonic_tip(1.0, RotorState(320.0, 140.0, Air(sound_speed=340.0 * 0.9965)))

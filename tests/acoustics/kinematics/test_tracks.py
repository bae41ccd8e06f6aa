"""Microphones on the ground: where a passing rotor is heard from."""

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import poses
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.kinematics.tracks import (
    fixed_observers,
    flyover_track,
    ground_line,
    line_of_sight,
)

C = 340.0


def test_a_line_on_the_ground_is_evenly_spaced_and_at_rest():
    line = ground_line((-100.0, 20.0), (100.0, 20.0), 5, height=1.2)
    np.testing.assert_allclose(line.position[:, 0], [-100, -50, 0, 50, 100])
    np.testing.assert_allclose(line.position[:, 1:], [[20.0, 1.2]] * 5)
    assert not np.any(line.velocity)


@pytest.mark.parametrize(
    ("shaft_angle_deg", "axis"), [(90.0, [1, 0, 0]), (0.0, [0, 0, 1]), (30.0, [0.5, 0, 0.75**0.5])]
)
def test_the_axis_of_a_flying_rotor(shaft_angle_deg, axis):
    pose = poses(flyover_track(100.0, 50.0, shaft_angle_deg), jnp.array([2.0]))
    np.testing.assert_allclose(pose.origin, [[100.0, 0.0, 100.0]])
    np.testing.assert_allclose(pose.rotation[0, :, 2], axis, atol=1e-15)


def test_sound_takes_its_time_and_is_shifted():
    """Closed form of the emission time of a source in level flight, here for times of hearing."""
    height, speed, aside = 150.0, 70.0, 40.0
    observers = fixed_observers([[0.0, aside, 0.0], [30.0, 0.0, 1.2]])
    t = np.linspace(-6.0, 6.0, 25)
    sight = line_of_sight(flyover_track(height, speed), observers, t, C)
    x, y, z = np.asarray(observers.position).T[..., None]
    m = speed / C
    ahead = x - speed * t
    d = (m * ahead + np.sqrt(ahead**2 + (1 - m**2) * (y**2 + (z - height) ** 2))) / (1 - m**2)
    np.testing.assert_allclose(sight.distance, d, rtol=1e-10)
    np.testing.assert_allclose(sight.emission_time, t - d / C, atol=1e-10)
    cosine = (x - speed * (t - d / C)) / d
    np.testing.assert_allclose(sight.doppler, 1 / (1 - m * cosine), rtol=1e-10)
    # The axis points along the flight: elevation is the angle from the plane across it.
    np.testing.assert_allclose(sight.elevation_deg, np.degrees(np.arcsin(cosine)), atol=1e-8)


def test_directions_are_those_of_the_rotor():
    """Right below a propeller is azimuth 0 (its +x axis points down); it hears elevation 0."""
    hovering = flyover_track(10.0, 0.0)
    sight = line_of_sight(hovering, fixed_observers([[0.0, 0.0, 0.0]]), [0.0], C)
    assert float(sight.elevation_deg[0, 0]) == pytest.approx(0.0, abs=1e-12)
    assert float(sight.azimuth_deg[0, 0]) == pytest.approx(0.0, abs=1e-12)
    lifting = line_of_sight(
        flyover_track(10.0, 0.0, 0.0), fixed_observers([[10.0, 0.0, 0.0]]), [0.0], C
    )
    assert float(lifting.elevation_deg[0, 0]) == pytest.approx(-45.0)


def test_flying_along_there_is_no_doppler():
    along = Observers(jnp.array([[30.0, 5.0, 80.0]]), jnp.array([60.0, 0.0, 0.0]))
    sight = line_of_sight(flyover_track(100.0, 60.0), along, np.linspace(0.0, 3.0, 4), C)
    np.testing.assert_allclose(sight.doppler, 1.0, rtol=1e-12)
    assert np.ptp(sight.distance) < 1e-9


@pytest.mark.parametrize(
    ("make", "message"),
    [
        (lambda: ground_line((0, 0), (1, 0), 1), "a line needs at least 2 observers; got 1"),
        (lambda: ground_line((0, 0), (1, 0), 3, -1.0), r"must not be negative \[m\]; got -1"),
        (lambda: flyover_track(0.0, 50.0), r"height of flight must be positive \[m\]; got 0"),
        (lambda: flyover_track(10.0, np.nan), r"speed of flight must be finite \[m/s\]; got nan"),
        (
            lambda: line_of_sight(
                flyover_track(10.0, 400.0), fixed_observers([[900.0, 0, 0]]), [0.0], C
            ),
            r"rotors must be slower than sound \(340 m/s\); their Mach number .* is 1\.176",
        ),
        (
            lambda: line_of_sight(
                flyover_track(10.0, 40.0),
                Observers(jnp.array([[900.0, 0, 0]]), jnp.array([400.0, 0, 0])),
                [0.0],
                C,
            ),
            "observers must be slower than sound",
        ),
    ],
)
def test_what_cannot_be_is_refused(make, message):
    with pytest.raises(ValueError, match=message):
        make()

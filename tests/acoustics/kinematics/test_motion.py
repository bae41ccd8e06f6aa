"""Chains of frames: positions as the matrices say, velocities and accelerations as they follow."""

import numpy as np
import pytest
from scipy.spatial.transform import Rotation

from propmdao.acoustics.kinematics.motion import blade_motions, place, poses, rotation, translation

POINT = np.array([[0.7, -0.2, 0.1]])


def test_the_empty_chain_is_the_ground():
    position, velocity, acceleration = place(poses((), np.array([0.0, 2.0])), POINT)
    np.testing.assert_array_equal(position[1], POINT)
    assert not velocity.any() and not acceleration.any()


def test_a_turning_point_has_centripetal_acceleration():
    motion = (rotation((0, 0, 2), angle=0.3, rate=50.0),)
    position, velocity, acceleration = place(poses(motion, np.linspace(0, 1, 7)), POINT)
    spin = np.array([0, 0, 50.0])
    np.testing.assert_allclose(velocity, np.cross(spin, position), rtol=1e-13, atol=1e-12)
    np.testing.assert_allclose(acceleration, np.cross(spin, velocity), rtol=1e-13, atol=1e-9)


def test_the_first_frame_of_the_chain_is_the_outermost():
    """Translation, tilt and turn of a rotor, multiplied by hand."""
    motion = (
        translation((1, 2, 3), velocity=(10, 0, -4), acceleration=(0, 0, 2)),
        rotation((0, 1, 0), angle=0.2),
        translation((0, 0, 0.5)),
        rotation((0, 0, 1), angle=0.4, rate=30.0),
    )
    t = 0.13
    tilt, turn = Rotation.from_rotvec([0, 0.2, 0]), Rotation.from_rotvec([0, 0, 0.4 + 30 * t])
    expected = np.array([1 + 10 * t, 2, 3 - 4 * t + t**2])
    expected = expected + tilt.apply(np.array([0, 0, 0.5]) + turn.apply(POINT))
    position, _, acceleration = place(poses(motion, np.array([t])), POINT)
    np.testing.assert_allclose(position[0], expected, rtol=1e-13)
    inward = tilt.apply(-900.0 * turn.apply(POINT * [1, 1, 0])) + [0, 0, 2]
    np.testing.assert_allclose(acceleration[0], inward, rtol=1e-12)


def test_derivatives_of_a_precessing_rotor_are_those_of_its_position():
    motion = (
        translation(velocity=(3, 0, 0), acceleration=(0, 1, 0)),
        rotation((1, 1, 0), rate=4.0),
        rotation((0, 0, 1), rate=-9.0),
    )
    t, h = 0.31, 1e-4
    position, velocity, acceleration = place(poses(motion, t + h * np.arange(-1, 2)), POINT)
    # central differences: their error is h^2/6 times the next derivative, 1e-6 of 9^3
    np.testing.assert_allclose(velocity[1], (position[2] - position[0]) / (2 * h), atol=1e-5)
    np.testing.assert_allclose(acceleration[1], (velocity[2] - velocity[0]) / (2 * h), atol=1e-4)


def test_a_flapping_blade_swings_about_its_hinge():
    """Second flap harmonics on a turning rotor: angle by hand, derivatives by differences."""
    omega, swing = 40.0, np.array([[0.05, -0.01], [0.02, 0.004]])
    motion = (
        rotation((0, 0, 1), rate=omega),
        translation((0.1, 0, 0)),
        rotation((0, -1, 0), angle=0.03, swing=swing, swing_rate=omega),
    )
    t, h = 0.21, 1e-5
    position, velocity, acceleration = place(poses(motion, t + h * np.arange(-1, 2)), POINT)
    psi = omega * t * np.array([1, 2])
    flap = 0.03 + swing[0] @ np.cos(psi) + swing[1] @ np.sin(psi)
    blade = np.array([0.1, 0, 0]) + Rotation.from_rotvec([0, -flap, 0]).apply(POINT[0])
    expected = Rotation.from_rotvec([0, 0, omega * t]).apply(blade)
    np.testing.assert_allclose(position[1, 0], expected, rtol=1e-13)
    # h^2 / 6 of derivatives of about 40^3 and 40^4, and rounding over h
    np.testing.assert_allclose(velocity[1], (position[2] - position[0]) / (2 * h), atol=1e-5)
    np.testing.assert_allclose(acceleration[1], (velocity[2] - velocity[0]) / (2 * h), atol=1e-3)


def test_frames_that_turn_swing_or_accelerate_are_not_uniform():
    assert translation((1, 0, 0), (2, 0, 0)).uniform and rotation((0, 0, 1), 0.4).uniform
    swinging = rotation((0, 0, 1), swing=[[0.1], [0.0]], swing_rate=3.0)
    accelerated = translation(acceleration=(0, 0, 1))
    assert not any(f.uniform for f in (rotation((0, 0, 1), rate=1.0), swinging, accelerated))


def test_unequal_blades_of_two_rotors_with_their_own_speed_and_sense():
    left = (translation((0, 1, 0)),)
    right = (translation((0, -1, 0)),)
    t = np.array([0.01])
    for hub, azimuths, omega in ((left, [0.0, 2.9], 100.0), (right, [0.5, 2.0, 4.0], -70.0)):
        motions = blade_motions(azimuths, omega, hub)
        assert len(motions) == len(azimuths)
        for azimuth, motion in zip(azimuths, motions, strict=True):
            tip = np.asarray(place(poses(motion, t), [[1.0, 0.0, 0.0]])[0][0, 0])
            angle = azimuth + omega * 0.01
            expected = np.asarray(hub[0].offset) + [np.cos(angle), np.sin(angle), 0]
            np.testing.assert_allclose(tip, expected, atol=1e-15)


def test_an_axis_without_length_is_refused():
    with pytest.raises(ValueError, match="rotation axis .* got"):
        rotation((0, 0, 0))

"""Circles of observers about the shaft, and what a steady rotor is heard like on them."""

from __future__ import annotations

import numpy as np
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc, sphere
from propmdao.acoustics.kinematics.rings import rings_of


def test_a_sphere_has_a_circle_for_each_elevation():
    positions = sphere(2.0, [-90.0, -45.0, 0.0, 30.0], np.arange(0.0, 360.0, 10.0))
    rings = rings_of(positions)
    assert len(rings.position) == 4
    place = rings.position[rings.ring]
    cos, sin = np.cos(rings.azimuth), np.sin(rings.azimuth)
    x, y, z = place.T
    turned = np.stack([x * cos - y * sin, x * sin + y * cos, z], axis=-1)
    assert_allclose(turned, positions, atol=1e-12)


def test_observers_of_an_arc_stay_where_they_are():
    positions = arc(1.905, [45.0, 0.0, -45.0])
    rings = rings_of(positions)
    np.testing.assert_array_equal(rings.position[rings.ring], positions)
    np.testing.assert_array_equal(rings.azimuth, 0.0)


def test_circles_a_millionth_apart_are_two():
    assert len(rings_of([[1.0, 0.0, 0.0], [1.000001, 0.0, 0.0], [0.0, 1.0, 0.0]]).position) == 2

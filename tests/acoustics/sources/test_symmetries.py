"""What must not change, or change in one known way, whatever the numbers."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.observers import arc
from propmdao.records.loads import PointLoads
from propmdao.records.panels import Panels

OBSERVERS = np.array([[1.2, 0.4, -1.3], [-0.5, 1.0, 0.7]])


def turned(rotor, angle):
    """Blade 1 moved ahead by an angle."""
    cos, sin = np.cos(angle), np.sin(angle)
    matrix = jnp.asarray([[cos, -sin, 0.0], [sin, cos, 0.0], [0.0, 0.0, 1.0]])
    blade = jax.tree.map(lambda q: q @ matrix.T, (rotor.panels, rotor.loads))
    return rotor.with_(panels=blade[0], loads=blade[1])


def assert_same(actual, expected):
    for name, b in expected.parts.items():
        a = actual.parts[name]
        np.testing.assert_allclose(a, b, rtol=1e-9, atol=1e-12 * np.abs(b).max())


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    return slow_flyer.with_(rotation_speed=1500.0, speed=40.0)


def test_turning_the_other_way_is_the_mirror_image(rotor):
    """A mirrored blade turning the other way sounds the same on the mirrored side."""
    mirror = jnp.asarray([1.0, -1.0, 1.0])
    mirrored = rotor.with_(
        panels=Panels(rotor.panels.center * mirror, rotor.panels.vector_area * mirror),
        loads=PointLoads(rotor.loads.position * mirror, rotor.loads.force * mirror),
        rotation_speed=-rotor.rotation_speed,
    )
    expected = rotor.tones(OBSERVERS)
    actual = mirrored.tones(OBSERVERS * np.asarray(mirror))
    # amplitudes of positive frequencies, whichever way a rotor turns
    np.testing.assert_allclose(actual.total, expected.total, rtol=1e-9)
    np.testing.assert_allclose(actual.frequency_hz, expected.frequency_hz)


def test_turning_the_blade_only_turns_the_phase(rotor):
    expected = rotor.tones(OBSERVERS)
    ahead = turned(rotor, 0.3).tones(OBSERVERS)
    phase = np.exp(-1j * 0.3 * rotor.n_blades * np.arange(1, 11))
    np.testing.assert_allclose(ahead.total, expected.total * phase, rtol=1e-9)


def test_an_observer_further_round_hears_the_same_later(rotor):
    angle = 0.7
    cos, sin = np.cos(angle), np.sin(angle)
    around = OBSERVERS @ np.array([[cos, sin, 0.0], [-sin, cos, 0.0], [0.0, 0.0, 1.0]])
    phase = np.exp(1j * angle * rotor.n_blades * np.arange(1, 11))
    expected = rotor.tones(OBSERVERS).total * phase
    np.testing.assert_allclose(rotor.tones(around).total, expected, rtol=1e-9)


def test_three_blades_are_the_sum_of_one_blade_three_times(rotor):
    together = rotor.with_(n_blades=3).tones(OBSERVERS, 4)
    one = rotor.with_(n_blades=1)
    total = sum(turned(one, b * 2 * np.pi / 3).tones(OBSERVERS, 12).total for b in range(3))
    np.testing.assert_allclose(total[:, 2::3], together.total, rtol=1e-9)
    between = np.delete(np.asarray(total), [2, 5, 8, 11], axis=1)
    assert np.abs(between).max() < 1e-12 * np.abs(together.total).max()


def test_no_tone_on_the_axis(rotor):
    on_axis = rotor.tones(np.array([[0.0, 0.0, 1.9]])).total
    assert np.abs(on_axis).max() < 1e-13 * np.abs(rotor.tones(OBSERVERS).total).max()


def test_thrust_alone_is_silent_in_the_rotor_plane_and_odd_across_it(point_force):
    rotor = point_force((0.1, 0.0, 0.0), (0.0, 0.0, -1.0))
    below, plane, above = np.asarray(rotor.tones(arc(1.9, [-30.0, 0.0, 30.0]), 3).parts["loading"])
    np.testing.assert_allclose(below, -above, rtol=1e-12)
    assert np.abs(plane).max() == 0


def test_thickness_scales_with_density_and_loading_with_force(rotor):
    louder = rotor.with_(
        density=2 * rotor.density,
        loads=PointLoads(rotor.loads.position, 3 * rotor.loads.force),
    ).tones(OBSERVERS)
    expected = rotor.tones(OBSERVERS)
    np.testing.assert_allclose(
        louder.parts["thickness"], 2 * expected.parts["thickness"], rtol=1e-9
    )
    np.testing.assert_allclose(louder.parts["loading"], 3 * expected.parts["loading"], rtol=1e-9)


def test_equal_mach_numbers_and_sizes_scale(rotor):
    """Twice as large at half the rotation speed: the same pressure at twice the distance."""
    expected = rotor.tones(OBSERVERS)
    large = rotor.with_(
        panels=Panels(2 * rotor.panels.center, 4 * rotor.panels.vector_area),
        loads=PointLoads(2 * rotor.loads.position, 4 * rotor.loads.force),
        rotation_speed=rotor.rotation_speed / 2,
    )
    assert_same(large.tones(2 * OBSERVERS), expected)


def test_observers_do_not_know_of_each_other(rotor):
    together = rotor.tones(OBSERVERS)
    assert_same(
        jax.tree.map(lambda *q: jnp.concatenate(q), *(rotor.tones(x) for x in OBSERVERS)),
        together,
    )


def test_half_a_turn_of_an_even_body_above_and_below(rotor):
    """A body without twist and camber (mirrored in z) hears no difference in hover."""
    flip = jnp.asarray([1.0, 1.0, -1.0])
    both = rotor.with_(
        panels=Panels(
            jnp.concatenate([rotor.panels.center, rotor.panels.center * flip]),
            jnp.concatenate([rotor.panels.vector_area, rotor.panels.vector_area * flip]),
        ),
        speed=0.0,
    )
    above, below = both.tones(arc(1.9, [25.0, -25.0])).parts["thickness"]
    np.testing.assert_allclose(above, below, rtol=1e-9)

"""Sums of rotors against their records, and the sums that make no sense."""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.broadband.self_noise import SelfNoise
from propmdao.acoustics.kinematics.motion import translation
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.levels.decibels import (
    level_db,
    oaspl_db,
    pressure_history,
    spl_db,
)
from propmdao.acoustics.signals import PressureHistory, Tones
from propmdao.acoustics.sounds.recordings import tone_record
from propmdao.acoustics.sources.formulation1a import tones as rotor_in_axial_flight
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotor_sums import RotorSound, sum_of_rotors
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced, mirrored, rotor_histories
from propmdao.records.air import Air
from propmdao.records.states import RotorState

AIR = Air()
OMEGA = 440.0
PLACES = arc(1.905, [-30.0, 20.0]) + [0.0, 0.5, 0.0]
MECHANISMS = [field.name for field in dataclasses.fields(SelfNoise)]


@pytest.fixture(scope="module")
def pair(slow_flyer):
    """A rotor on the left, its mirror image on the right."""
    left = Rotor(equally_spaced(2, 0.4), OMEGA, slow_flyer.panels, slow_flyer.loads)
    places = [(translation((0.0, y, 0.0)),) for y in (0.2, -0.2)]
    rotors = left, mirrored(left)
    return [dataclasses.replace(r, mount=m) for r, m in zip(rotors, places, strict=True)]


def tones_of(rotor, n_harmonics=6, places=PLACES):
    return rotor_tones(rotor, (0.0, 0.0, 0.0), AIR, places, n_harmonics)


def marched_level(rotors, n=1024):
    """Level of the record of one turn, without its mean."""
    clock = np.arange(n) * 2 * np.pi / OMEGA / n
    still = Observers(jnp.asarray(PLACES), jnp.zeros(3))
    pressure = rotor_histories(rotors, still, clock, AIR).total
    return level_db(np.var(pressure, axis=1))


def noise(value, shape=(2, 5)):
    return SelfNoise(**{name: jnp.full(shape, value) for name in MECHANISMS})


def test_mirrored_rotors_add_up_to_their_record(pair):
    sounds = [RotorSound(tones_of(rotor)) for rotor in pair]
    together = sum_of_rotors(sounds)
    expected = marched_level(pair)
    assert_allclose(level_db(together.mean_square), expected, atol=0.02)
    assert_allclose(oaspl_db(together.tones.total), expected, atol=0.02)
    assert_allclose(together.tones.frequency_hz, sounds[0].tones.frequency_hz)


def test_amplitudes_of_negative_frequency_are_turned_first(pair):
    """Written with frequencies of either sign the sum is the same; their plain sum is another."""
    left, right = (tones_of(rotor) for rotor in pair)
    backward = Tones(-right.frequency_hz, jax.tree.map(jnp.conj, right.parts))
    expected, product = (
        sum_of_rotors([RotorSound(left), RotorSound(other)]) for other in (right, backward)
    )
    assert_allclose(product.tones.total, expected.tones.total, rtol=1e-14)
    plain = oaspl_db(left.total + backward.total)
    assert np.abs(plain - oaspl_db(expected.tones.total)).max() > 0.5


def test_tones_have_positive_frequencies_whichever_way_a_rotor_turns(pair, slow_flyer):
    left, right = (tones_of(rotor) for rotor in pair)
    assert np.all(right.frequency_hz > 0.0)
    assert_allclose(oaspl_db((left + right).total), marched_level(pair), atol=0.02)
    flip = jnp.array([1.0, -1.0, 1.0])
    mirror = jax.tree.map(lambda q: flip * q, (slow_flyer.panels, slow_flyer.loads))
    state = RotorState(-OMEGA, 0.0, AIR)
    found = rotor_in_axial_flight(*mirror, 2, state, PLACES * np.array([1, -1, 1]), 4)
    expected = rotor_in_axial_flight(
        slow_flyer.panels, slow_flyer.loads, 2, dataclasses.replace(state, rotation_speed=OMEGA),
        PLACES, 4,
    )  # fmt: skip
    assert_allclose(found.frequency_hz, expected.frequency_hz)
    scale = np.abs(expected.total).max()
    assert_allclose(found.total, expected.total, atol=1e-12 * scale)


def test_rotors_of_different_speed_keep_their_tones_and_add_their_mean_squares(pair):
    left = tones_of(pair[0], 3)
    faster = tones_of(dataclasses.replace(pair[1], rotation_speed=-1.5 * OMEGA), 2)
    together = sum_of_rotors([RotorSound(left), RotorSound(faster)])
    # 1, 2, 3 and 1.5, 3 times the blade passage: the third of one is the second of the other
    orders = np.array([1.0, 1.5, 2.0, 3.0])
    assert_allclose(together.tones.frequency_hz, orders * OMEGA / np.pi, rtol=1e-12)
    for name in ("thickness", "loading"):
        a, b = (np.asarray(tones.parts[name]) for tones in (left, faster))
        expected = np.stack([a[:, 0], b[:, 0], a[:, 1], a[:, 2] + b[:, 1]], axis=1)
        assert_allclose(together.tones.parts[name], expected, rtol=1e-14)
    energy = np.sum(10 ** (np.asarray(spl_db(together.tones.total)) / 10), axis=1)
    assert_allclose(level_db(together.mean_square), 10 * np.log10(energy), rtol=1e-12)


def test_speeds_of_one_part_in_a_thousand_apart_are_not_in_phase(pair):
    near = dataclasses.replace(pair[1], rotation_speed=1.001 * pair[1].rotation_speed)
    sounds = [RotorSound(tones_of(rotor, 2)) for rotor in (pair[0], near)]
    together = sum_of_rotors(sounds)
    assert together.tones.frequency_hz.size == 4
    assert_allclose(together.mean_square, sounds[0].mean_square + sounds[1].mean_square)


def test_broadband_noise_adds_as_mean_squares(pair):
    sound = tones_of(pair[0])
    one, two = RotorSound(sound, noise(1e-8)), RotorSound(sound, noise(3e-8))
    together = sum_of_rotors([one, two, one])
    assert_allclose(together.broadband.tip, 5e-8)
    tones = sum_of_rotors([RotorSound(sound)] * 3)
    assert_allclose(together.mean_square, tones.mean_square + len(MECHANISMS) * 5 * 5e-8)
    assert_allclose(level_db(tones.mean_square), oaspl_db(sound.total) + 20 * np.log10(3))


def test_derivatives_go_through_amplitudes(pair):
    left, right = (tones_of(rotor) for rotor in pair)

    def level(factor):
        sounds = RotorSound(left), RotorSound(right.each(lambda p: factor * p))
        return jnp.sum(level_db(sum_of_rotors(sounds).mean_square))

    step = 1e-6
    expected = (level(1.0 + step) - level(1.0 - step)) / (2 * step)
    assert float(jax.grad(level)(1.0)) == pytest.approx(float(expected), rel=1e-6)


def test_sums_that_make_no_sense_are_refused(pair):
    sound = tones_of(pair[0], 2)
    faster = dataclasses.replace(sound, frequency_hz=1.001 * sound.frequency_hz)
    elsewhere = sound.each(lambda p: p[:1])
    alone = Tones(sound.frequency_hz, {"loading": sound.parts["loading"]})
    infinite = dataclasses.replace(sound, frequency_hz=jnp.array([1.0, np.inf]))
    for sounds, message in (
        ([], "at least one"),
        ([RotorSound(sound), RotorSound(elsewhere)], "observers .* there are 2 and 1"),
        ([RotorSound(sound), RotorSound(alone)], "sources .* loading, thickness and loading"),
        ([RotorSound(sound), RotorSound(infinite)], "must be finite; got inf"),
        ([RotorSound(sound), RotorSound(sound, noise(1.0))], "broadband noise .* or none"),
        (
            [RotorSound(sound, noise(1.0)), RotorSound(sound, noise(1.0, (2, 6)))],
            r"same bands to be added; it is \(2, 5\) and \(2, 6\)",
        ),
    ):
        with pytest.raises(ValueError, match=message):
            sum_of_rotors(sounds)
    for other, message in (
        (faster, "frequencies of tones must be the same .* number 1 is 140.0563499 and 140.19640"),
        (dataclasses.replace(sound, frequency_hz=-sound.frequency_hz), "is 140.* and -140"),
        (tones_of(pair[0], 3), "there are 2 and 3"),
        (alone, "sources must be the same"),
        (elsewhere, "observers must be the same"),
    ):
        with pytest.raises(ValueError, match=message):
            sound + other
    with pytest.raises(TypeError, match="must be known numbers"):
        jax.jit(lambda tones: sum_of_rotors([RotorSound(tones)]).mean_square)(sound)


def test_records_of_other_times_are_not_added():
    one, two = (PressureHistory(t + np.arange(3.0), {"loading": np.ones((1, 3))}) for t in (0, 1))
    assert_allclose((one + one).total, 2.0)
    with pytest.raises(ValueError, match="times of records .* number 1 is 0 and 1 s"):
        one + two


def test_a_sum_of_different_rotors_has_no_blade_passage_to_repeat():
    tones = Tones(jnp.array([100.0, 140.0]), {"loading": jnp.ones((1, 2), complex)})
    for record in (
        lambda: pressure_history(tones.frequency_hz, tones.total, 16),
        lambda: tone_record(tones.frequency_hz, tones.total, 1.0),
    ):
        with pytest.raises(ValueError, match="multiples of the first, 100 Hz, .* 2 is 140 Hz"):
            record()

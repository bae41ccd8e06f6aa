"""Rotors with any blades, speeds and senses of rotation, heard by marching and as tones."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import rotation, translation
from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.kinematics.reception import Observers, require_outside
from propmdao.acoustics.sources import rotors
from propmdao.acoustics.sources.moving_sources import AperiodicLoads, PeriodicLoads
from propmdao.acoustics.sources.periodic import rotor_tones, symmetry
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced, mirrored, rotor_histories
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads

RHO, C, OMEGA = 1.2, 340.0, 1500.0  # a tip Mach number of 0.6
AIR = Air(density=RHO, sound_speed=C)
PLACES = arc(1.905, [-45.0, 20.0])


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    """Blades at unequal azimuths, on a shaft that is tilted and off the aircraft's axis."""
    return Rotor(
        [0.3, 2.9, 4.4],
        OMEGA,
        slow_flyer.panels,
        slow_flyer.loads,
        (translation((0.1, -0.2, 0.05)), rotation((0, 1, 0), 0.4)),
    )


@pytest.fixture(scope="module")
def periodic(slow_flyer):
    """Loads that follow the sine and cosine of the azimuth."""
    psi = 2 * np.pi * np.arange(72) / 72
    change = 1 + 0.3 * np.cos(psi) - 0.2 * np.sin(2 * psi)
    return PeriodicLoads(
        slow_flyer.loads.position, jnp.asarray(change[:, None, None] * slow_flyer.loads.force)
    )


def flying(velocity, places=PLACES):
    return Observers(jnp.asarray(places), jnp.asarray(velocity, float))


def one_turn(rotor, n=512):
    return np.arange(n) * 2 * np.pi / abs(rotor.rotation_speed) / n


def amplitudes(history, orders):
    """P_n of one turn."""
    return np.conj(np.fft.fft(history))[:, orders] / history.shape[-1]


def agree(rotor, velocity, n_harmonics, decibel=0.01):
    """Marching and the Fourier form, for observers that fly along: harmonics within 40 dB."""
    flight = (translation(velocity=velocity),)
    marched = rotor_histories([rotor], flying(velocity), one_turn(rotor), AIR, flight)
    tones = rotor_tones(rotor, velocity, AIR, PLACES, n_harmonics)
    orders = np.round(tones.frequency_hz / (OMEGA / 2 / np.pi)).astype(int)
    for name in ("thickness", "loading"):
        expected = np.asarray(tones.parts[name])
        product = amplitudes(marched.parts[name], orders)
        loud = np.abs(expected) > 0.01 * np.abs(expected).max(axis=1, keepdims=True)
        ratio = product[loud] / expected[loud]
        assert loud.any(axis=1).all()
        assert np.abs(20 * np.log10(np.abs(ratio))).max() < decibel
        assert np.abs(np.angle(ratio)).max() < 1e-3


@pytest.mark.parametrize("velocity", [(0.0, 0.0, 0.0), (30.0, 10.0, -20.0)])
def test_marching_and_tones_of_unequal_blades_on_a_tilted_shaft(rotor, velocity):
    agree(rotor, velocity, 12)


@pytest.mark.parametrize("mach", [0.2, 0.6])
@pytest.mark.parametrize("n", [512, 1024, 2048, 4096])
def test_records_of_observers_that_fly_along_are_complete(rotor, mach, n):
    """All blades are heard over all of the record, however fine it is and wherever it is taken."""
    velocity = (mach * C, 0.0, 0.0)
    slow = dataclasses.replace(rotor, panels=None, rotation_speed=440.0)
    places = arc(1.905, [-90.0, -45.0, 0.0, 45.0, 90.0]) * np.array([[1.0], [1], [1], [-1], [1]])
    marched = rotor_histories(
        [slow], flying(velocity, places), one_turn(slow, n), AIR, (translation(velocity=velocity),)
    )
    assert np.isfinite(marched.total).all() and marched.total.any(axis=1).all()


def test_observers_as_fast_as_sound_are_refused(rotor):
    with pytest.raises(ValueError, match=r"observers must be slower .* Mach number is 1.000"):
        rotor_histories([rotor], flying((C, 0, 0)), one_turn(rotor), AIR)


def test_marching_and_tones_with_unsteady_loads(rotor, periodic):
    agree(dataclasses.replace(rotor, loads=periodic), (30.0, 0.0, 10.0), 8)


def test_marching_and_tones_of_a_rotor_that_turns_the_other_way(rotor, periodic):
    agree(mirrored(dataclasses.replace(rotor, loads=periodic)), (30.0, 0.0, 10.0), 6)


@pytest.mark.parametrize("speed", [0.0, 30.0])
def test_equal_blades_in_axial_flight_are_the_fast_form(slow_flyer, speed):
    case = slow_flyer.with_(rotation_speed=OMEGA, speed=speed, density=RHO, sound_speed=C)
    rotor = Rotor(equally_spaced(2), OMEGA, case.panels, case.loads)
    general = rotor_tones(rotor, (0, 0, speed), AIR, PLACES, 6)
    fast = case.tones(PLACES, 6)
    np.testing.assert_allclose(general.frequency_hz, fast.frequency_hz)
    for name in ("thickness", "loading"):
        expected = np.asarray(fast.parts[name])
        np.testing.assert_allclose(
            general.parts[name], expected, atol=1e-11 * np.abs(expected).max()
        )


def test_mirror_image_is_heard_at_the_mirrored_place(rotor, periodic):
    rotor = dataclasses.replace(rotor, mount=(), loads=periodic)
    places = PLACES + [0.0, 0.7, 0.0]
    right = rotor_tones(rotor, (20.0, 5.0, 0.0), AIR, places, 6)
    left = rotor_tones(mirrored(rotor), (20.0, -5.0, 0.0), AIR, places * [1, -1, 1], 6)
    np.testing.assert_allclose(left.frequency_hz, right.frequency_hz)
    largest = np.abs(np.asarray(right.total)).max()
    np.testing.assert_allclose(left.total, right.total, atol=1e-12 * largest)


@pytest.mark.parametrize(
    ("azimuths", "expected"),
    [
        ([0.3], 1),
        (equally_spaced(5, 0.2), 5),
        ([0.0, 0.5, np.pi, np.pi + 0.5], 2),
        ([0.0, 2.0, 4.0], 1),
    ],
)
def test_how_often_the_blades_repeat(azimuths, expected):
    assert symmetry(azimuths) == expected


def test_scissored_pairs_have_every_second_harmonic_and_no_other(slow_flyer):
    loads = slow_flyer.loads
    pairs = Rotor([0.0, 0.5, np.pi, np.pi + 0.5], OMEGA, loads=loads)
    blade = rotor_tones(Rotor([0.0], OMEGA, loads=loads), (0, 0, 0), AIR, PLACES, 6)
    both = rotor_tones(pairs, (0, 0, 0), AIR, PLACES, 3)
    np.testing.assert_allclose(both.frequency_hz, blade.frequency_hz[1::2])
    orders = np.array([2, 4, 6])
    expected = np.asarray(blade.parts["loading"])[:, 1::2] * 2 * (1 + np.exp(-0.5j * orders))
    # azimuths enough for order 6 of one blade alone: rounding only
    np.testing.assert_allclose(both.parts["loading"], expected, rtol=1e-9)


def test_two_rotors_are_the_sum_of_their_pressures(rotor, slow_flyer):
    other = mirrored(Rotor([1.0, 4.0], 900.0, loads=slow_flyer.loads))
    other = dataclasses.replace(other, mount=(translation((0, 0.4, 0)),))
    t = np.arange(200) * 1e-5
    listeners = flying((0, 0, 0))
    both = rotor_histories([rotor, other], listeners, t, AIR)
    first, second = (rotor_histories([single], listeners, t, AIR) for single in (rotor, other))
    np.testing.assert_allclose(both.total, (first + second).total, rtol=1e-13)
    assert not second.parts["thickness"].any()


def test_a_record_in_segments_is_the_record_in_one(rotor, periodic, monkeypatch):
    rotor = dataclasses.replace(rotor, panels=None, loads=periodic)
    flight = (translation(velocity=(20.0, 0.0, 0.0)),)
    t = np.arange(700) * 1e-5
    whole = rotor_histories([rotor], flying((0, 0, 0)), t, AIR, flight)
    monkeypatch.setattr(rotors, "_AT_ONCE", 1)
    parts = rotors.segments(700, 1)
    assert [(part.start, part.stop) for part in parts] == [(0, 256), (256, 512), (444, 700)]
    pieces = rotor_histories([rotor], flying((0, 0, 0)), t, AIR, flight)
    # source times of the pieces lie elsewhere: interpolation, 1e-4
    np.testing.assert_allclose(
        pieces.parts["loading"],
        whole.parts["loading"],
        atol=1e-4 * np.ptp(whole.parts["loading"], axis=1).min(),
    )


def test_each_blades_own_loads_over_time(rotor, periodic):
    """The periodic loads, tabulated over time for each blade."""
    tau = np.linspace(-0.05, 0.05, 4001)
    psi = np.asarray(rotor.azimuths)[:, None] + OMEGA * tau
    change = 1 + 0.3 * np.cos(psi) - 0.2 * np.sin(2 * psi)
    steady = np.asarray(periodic.force[0]) / 1.3
    own = AperiodicLoads(
        periodic.position, jnp.asarray(tau), jnp.asarray(change[..., None, None] * steady)
    )
    expected, product = (
        rotor_histories(
            [dataclasses.replace(rotor, panels=None, loads=loads)],
            flying((0, 0, 0)),
            one_turn(rotor),
            AIR,
        ).parts["loading"]
        for loads in (periodic, own)
    )
    np.testing.assert_allclose(product, expected, atol=2e-5 * np.ptp(expected))


def test_loads_that_end_too_early_are_refused(rotor):
    loads = AperiodicLoads(
        rotor.loads.position, jnp.linspace(0, 0.001, 9), jnp.zeros((3, 9, *rotor.loads.force.shape))
    )
    rotor = dataclasses.replace(rotor, loads=loads)
    with pytest.raises(ValueError, match=r"table over 0 \.\.\. 0.001 s is asked for"):
        rotor_histories([rotor], flying((0, 0, 0)), one_turn(rotor), AIR)
    with pytest.raises(ValueError, match="loads of the rotor must repeat every turn"):
        rotor_tones(rotor, (0, 0, 0), AIR, PLACES, 3)


def test_an_observer_in_the_disk_is_refused_with_its_distance(rotor):
    message = (
        r"observer 2 comes to 0.03 m from the centre of the rotor; the region's radius is 0.1\d+ m"
    )
    hub = np.array([0.1, -0.2, 0.05])
    listeners = flying((0, 0, 0), [[2.0, 0, 0], hub + [0, 0.03, 0]])
    with pytest.raises(ValueError, match=message):
        rotor_histories([rotor], listeners, one_turn(rotor), AIR)


def test_what_does_not_turn_has_a_box_for_a_region():
    """A wing 2 m across: close below its middle is outside, in it is inside."""
    wing = [[1.0, -0.1, -0.01], [-1.0, 0.1, 0.01]]
    motion = (translation((5.0, 0, 0), velocity=(10.0, 0, 0)), rotation((0, 0, 1), 0.5))
    along = np.array([np.cos(0.5), np.sin(0.5), 0])
    t = np.linspace(0, 1e-3, 5)
    moving = (10.0, 0.0, 0.0)
    require_outside(motion, wing, flying(moving, [[5.0, 0, -0.05]]), t, "the wing")
    with pytest.raises(
        ValueError, match=r"comes to 0.9 m .* the wing; the region is 2 x 0.2 x 0.0"
    ):
        inside = np.array([5.0, 0, 0]) + 0.9 * along
        require_outside(motion, wing, flying(moving, [inside]), t, "the wing")


def test_flying_through_an_observer_is_refused(rotor):
    flight = (translation((-1.0, 0.2, 0.0), velocity=(50.0, 0, 0)),)
    with pytest.raises(ValueError, match="observer 1 comes to 0.0"):
        rotor_histories(
            [rotor], flying((0, 0, 0), [[0, 0, 0]]), np.linspace(0, 0.04, 400), AIR, flight
        )


def test_supersonic_and_empty_rotors_are_refused(rotor):
    fast = dataclasses.replace(rotor, rotation_speed=2600.0)
    with pytest.raises(ValueError, match="tip Mach number must be below 1"):
        rotor_tones(fast, (0, 0, 0), AIR, PLACES, 3)
    with pytest.raises(ValueError, match="must be slower than sound"):
        rotor_histories([fast], flying((0, 0, 0)), one_turn(fast), AIR)
    with pytest.raises(ValueError, match="neither panels nor loads"):
        rotor_tones(Rotor([0.0], 100.0), (0, 0, 0), AIR, PLACES, 3)


@pytest.mark.parametrize(
    ("air", "what"),
    [(Air(density=0.0), "density"), (Air(sound_speed=-1.0), "sound speed")],
)
def test_air_that_is_none_is_refused(rotor, air, what):
    with pytest.raises(ValueError, match=f"{what} must be positive; it is"):
        rotor_tones(rotor, (0, 0, 0), air, PLACES, 3)
    with pytest.raises(ValueError, match=f"{what} must be positive; it is"):
        rotor_histories([rotor], flying((0, 0, 0)), one_turn(rotor), air)


def test_a_rotor_that_does_not_turn_has_no_tones():
    loads = PointLoads(jnp.array([[0.1, 0, 0]]), jnp.ones((1, 3)))
    tones = rotor_tones(Rotor([0.0], 0.0, loads=loads), (0, 0, 0), AIR, PLACES, 2)
    assert not np.asarray(tones.total).any()

"""Flyovers from tones along the track: the same record as marching, in a hundredth of the time."""

from __future__ import annotations

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.kinematics.motion import rotation, translation
from propmdao.acoustics.kinematics.reception import Observers
from propmdao.acoustics.sources import flyover
from propmdao.acoustics.sources.flyover import flyover_histories
from propmdao.acoustics.sources.moving_sources import PeriodicLoads
from propmdao.acoustics.sources.periodic import rotor_tones
from propmdao.acoustics.sources.rotors import Rotor, equally_spaced, mirrored, rotor_histories
from propmdao.records.air import Air

# A tip Mach number of 0.4: at 5 kHz no tone is within 80 dB of the first.
C, OMEGA = 340.0, 1000.0
AIR = Air(density=1.2, sound_speed=C)
FS = 44100.0
REST = jnp.zeros(3)


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    return Rotor(equally_spaced(2), OMEGA, slow_flyer.panels, slow_flyer.loads)


@pytest.fixture(scope="module")
def tilted(rotor, slow_flyer):
    """Unequal blades with unsteady loads, the shaft 80 deg from the flight."""
    psi = 2 * np.pi * np.arange(36) / 36
    force = (1 + 0.3 * np.cos(psi))[:, None, None] * slow_flyer.loads.force
    return dataclasses.replace(
        rotor,
        azimuths=[0.0, 2.8],
        loads=PeriodicLoads(slow_flyer.loads.position, jnp.asarray(force)),
        mount=(translation((0.3, 0.4, 0.0)), rotation((0, 1, 0), np.radians(-80.0))),
    )


@pytest.mark.parametrize("which", ["axial", "edgewise", "two"])
def test_the_record_is_that_of_marching(rotor, tilted, which):
    """60 m/s past an observer 8 m to the side, around the closest approach."""
    rotors = {"axial": [rotor], "edgewise": [tilted], "two": [tilted, mirrored(tilted)]}[which]
    direction = np.array([0.0, 0.0, 1.0])
    flight = (translation(-30 * direction, 60 * direction),)
    observers = Observers(jnp.array([[8.0, 1.0, 0.0]]), REST)
    t = 0.5 + np.arange(1024) / FS
    fast = flyover_histories(rotors, observers, t, AIR, flight, 5000.0)
    marched = rotor_histories(rotors, observers, t, AIR, flight, step=1 / FS / 3)
    for name in ("thickness", "loading"):
        product, expected = (q.parts[name][0] for q in (fast, marched))
        difference = expected - product
        # the steady field that the march has besides changes over metres of the way
        slow = np.polynomial.Polynomial.fit(t, difference, 2)(t)
        np.testing.assert_allclose(difference, slow, atol=1e-3 * np.ptp(expected))


def test_doppler_shift(rotor):
    """f / (1 - M cos) within 0.1 %, a kilometre ahead and behind."""
    speed, passage = 0.3 * C, 2 * OMEGA / (2 * np.pi)
    flight = (translation((0, 0, -1000.0), velocity=(0, 0, speed)),)
    observers = Observers(jnp.array([[100.0, 0, 0]]), REST)
    for emission in (0.0, 2000.0 / speed):
        z = -1000.0 + speed * emission
        distance = np.hypot(z, 100.0)
        expected = passage / (1 + 0.3 * z / distance)
        t = emission + distance / C + np.arange(2048) / FS
        p = flyover_histories([rotor], observers, t, AIR, flight, 500.0).total[0]
        up = np.flatnonzero((p[:-1] < 0) & (p[1:] >= 0))
        crossing = t[up] - p[up] / (p[up + 1] - p[up]) / FS
        heard = (crossing.size - 1) / (crossing[-1] - crossing[0])
        assert heard == pytest.approx(expected, rel=1e-3)


def test_who_flies_along_hears_steady_tones(rotor):
    velocity = np.array([0.0, 0.0, 30.0])
    place = np.array([[1.5, 0.0, -1.0]])
    n = 256
    t = np.arange(n) * 2 * np.pi / OMEGA / n
    record = flyover_histories(
        [rotor],
        Observers(jnp.asarray(place), jnp.asarray(velocity)),
        t,
        AIR,
        (translation(velocity=velocity),),
        2000.0,
    )
    tones = rotor_tones(rotor, velocity, AIR, place, 4)
    product = np.conj(np.fft.rfft(record.total[0]))[[2, 4, 6, 8]] / n
    np.testing.assert_allclose(product, tones.total[0], atol=1e-10 * np.abs(product).max())


def test_straight_ahead_on_the_axis_of_a_tilted_shaft_there_is_no_miss_distance(tilted):
    flight = (translation((0, -0.4, -0.3), velocity=(0, 0, 40.0)),)
    hub = np.array([0.3, 0.0, -0.3])
    observers = Observers(jnp.asarray([hub + [0, 0, 20.0]]), REST)
    t = np.arange(512) / FS
    arguments = [tilted], observers, t, AIR, flight
    fast, marched = flyover_histories(*arguments, 5000.0), rotor_histories(*arguments)
    difference = (fast.total - marched.total)[0]
    slow = np.polynomial.Polynomial.fit(t, difference, 2)(t)
    np.testing.assert_allclose(difference, slow, atol=1e-3 * np.ptp(marched.total))


class TestRefused:
    def refused(self, message, rotors, **changes):
        case = {
            "place": (50.0, 0, 0),
            "flight": (translation(velocity=(0, 0, 20.0)),),
            "t": np.arange(64) / FS,
            "top": 2000.0,
        } | changes
        observers = Observers(jnp.asarray([case["place"]], float), REST)
        with pytest.raises(ValueError, match=message):
            flyover_histories(rotors, observers, case["t"], AIR, case["flight"], case["top"])

    def test_turning_flight(self, rotor):
        self.refused("flight must be uniform", [rotor], flight=(rotation((0, 0, 1), rate=0.1),))

    def test_an_observer_in_the_way(self, rotor):
        self.refused(
            "observer 1 comes to 0.0.* m from the centre of the rotor; the region's radius is 0.1",
            [rotor],
            place=(0.05, 0, 10.0),
            t=np.arange(441) / 441,
        )

    def test_records_too_coarse_for_the_tones(self, rotor):
        self.refused("samples per second holds no .* Hz", [rotor], t=np.arange(64) / 2000.0)

    def test_nothing_below_the_highest_frequency(self, rotor):
        self.refused("must reach the first tone of the rotor, 318.3", [rotor], top=100.0)

    def test_times_that_are_not_even(self, rotor):
        self.refused("observer times must be evenly spaced", [rotor], t=np.array([0, 1, 3]) / FS)

    def test_tones_that_change_too_fast(self, rotor, monkeypatch):
        monkeypatch.setattr(flyover, "_MOST_POSITIONS", 16)
        monkeypatch.setattr(flyover, "_TOLERANCE", 1e-12)
        self.refused("too fast along the track for 16 positions", [rotor], t=np.arange(FS) / FS)

    def test_supersonic_tips(self, rotor):
        fast = dataclasses.replace(rotor, rotation_speed=2600.0)
        self.refused("tip Mach number must be below 1", [fast])

"""Ground and air around a rotor: two ways of the sound, together again."""

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.acoustics.levels.decibels import level_db, spl_db
from propmdao.acoustics.propagation.absorption import absorption_db_per_m
from propmdao.acoustics.propagation.paths import (
    bands_by_paths,
    sound_paths,
    tones_by_paths,
    way_flying_along,
)
from propmdao.acoustics.signals import Tones
from propmdao.records.air import Air
from propmdao.records.listening import Surroundings
from propmdao.records.states import RotorState

C = 340.0
F = np.array([80.0, 400.0, 2500.0])


def monopole(positions, mach=0.0, incidence=0.0):
    """Tones of a source at rest in the hub; in flight only their phase and spreading are right."""
    velocity = mach * np.array([np.sin(incidence), 0.0, np.cos(incidence)])
    d = np.asarray(way_flying_along(positions, velocity)[0])[:, None]
    p = jnp.asarray(np.exp(2j * np.pi * F / C * d) / d)
    return Tones(jnp.asarray(F), {"thickness": p, "loading": 0.5 * p})


def flying(mach=0.0, air=Air(sound_speed=C), incidence=0.0):  # noqa: B008 - frozen
    return RotorState(0.0, mach * C, air, incidence)


def test_without_surroundings_nothing_changes():
    places = np.array([[3.0, 1.0, -2.0], [1.0, 0.0, 4.0]])
    paths = sound_paths(places, Surroundings())
    np.testing.assert_array_equal(paths, places[None])
    heard = tones_by_paths(monopole(places), paths, flying(0.1), Surroundings())
    np.testing.assert_array_equal(heard.total, monopole(places).total)
    power = np.arange(6.0).reshape(2, 3)
    assert np.all(bands_by_paths(power, F, paths, flying(0.1), Surroundings()) == power)


@pytest.mark.parametrize("level_flight", [False, True])
def test_a_point_source_over_ground_is_that_and_its_image(level_flight):
    around = Surroundings(ground=5.0, level_flight=level_flight)
    along, height = 7.0, 1.2  # of the microphone
    place = around.from_ground_axes([[along, 0.0, height - 5.0]])
    paths = sound_paths(place, around)
    heard = tones_by_paths(monopole(paths.reshape(-1, 3)), paths, flying(), around)
    direct, image = np.hypot(along, 5.0 - height), np.hypot(along, 5.0 + height)
    expected = sum(np.exp(2j * np.pi * F / C * d) / d for d in (direct, image))
    np.testing.assert_allclose(heard.parts["thickness"][0], expected, rtol=1e-12)
    np.testing.assert_allclose(heard.parts["loading"][0], 0.5 * expected, rtol=1e-12)


@pytest.mark.parametrize("ground", ["flush", 5.0])
def test_on_the_ground_pressure_is_doubled(ground):
    around = Surroundings(ground=ground)
    place = np.array([[7.0, 2.0, -5.0]])
    paths = sound_paths(place, around)
    ends = paths.reshape(-1, 3)
    heard = tones_by_paths(monopole(ends), paths, flying(), around)
    np.testing.assert_allclose(heard.total, 2 * monopole(place).total, rtol=1e-12)
    power = np.tile([[1.0, 2.0, 3.0]], (len(ends), 1))
    np.testing.assert_allclose(
        bands_by_paths(power, F, paths, flying(), around), [[4.0, 8.0, 12.0]]
    )


def test_bands_interfere_as_the_tones_of_which_they_are_made():
    """Mean of many tones over a band; far above the ground nothing is left of the phases."""
    around = Surroundings(ground=5.0)
    place = np.array([[7.0, 2.0, -4.6]])
    paths = sound_paths(place, around)
    d = np.linalg.norm(paths[:, 0], axis=-1)
    in_bands = np.asarray(
        bands_by_paths(np.repeat(1 / d[:, None] ** 2, 3, axis=1), F, paths, flying(), around)
    )
    for k, f in enumerate(F):
        fine = np.linspace(f / 10**0.05, f * 10**0.05, 4001)[:, None]
        p = np.sum(np.exp(2j * np.pi * fine / C * d) / d, axis=1)
        assert in_bands[0, k] == pytest.approx(np.mean(np.abs(p) ** 2), rel=1e-3)
    high = np.asarray(
        bands_by_paths(
            np.ones((2, 1)), [1e4], sound_paths([[9.0, 0, 3.0]], around), flying(), around
        )
    )
    assert high[0, 0] == pytest.approx(2.0, rel=0.02)


@pytest.mark.parametrize("incidence", [0.0, 1.2])
def test_air_takes_from_both_ways_at_the_frequency_that_it_hears(incidence):
    air = Air(sound_speed=C)
    around = Surroundings(absorption=True)
    mach = 0.3
    ahead = 100.0 * np.array([np.sin(incidence), 0.0, np.cos(incidence)])
    place = np.stack([ahead, -ahead])
    paths = sound_paths(place, around)
    source, state = monopole(place, mach, incidence), flying(mach, air, incidence)
    heard = tones_by_paths(source, paths, state, around)
    lost = np.asarray(spl_db(source.total) - spl_db(heard.total))
    # Ahead the sound runs after the observer: 100 m / (1 - M), shortened waves.
    for i, sign in enumerate((1.0, -1.0)):
        way, f = 100.0 / (1 - sign * mach), F / (1 - sign * mach)
        np.testing.assert_allclose(lost[i], absorption_db_per_m(f, air) * way, rtol=1e-9)
    bands = bands_by_paths(np.ones((2, 3)), F, paths, state, around)
    np.testing.assert_allclose(level_db(np.ones((2, 3))) - level_db(bands), lost, rtol=1e-9)


def test_way_flying_along_is_that_of_formulation_1a():
    """The sound of a source at rest in the moving frame reaches the observer after d / c."""
    place, mach = np.array([[3.0, -2.0, 4.0]]), np.array([0.3, -0.1, 0.4])
    d, doppler = (float(q[0]) for q in way_flying_along(place, mach))
    way = place[0] + mach * d  # from where the source was to where the observer is
    assert np.linalg.norm(way) == pytest.approx(d, rel=1e-12)
    assert doppler == pytest.approx(1 / (1 - mach @ way / d), rel=1e-12)


@pytest.mark.parametrize("incidence_deg", [0.0, 70.0, 90.0, 110.0])
def test_level_flight_is_along_the_ground(incidence_deg):
    around = Surroundings(ground=5.0, level_flight=True)
    state = flying(0.1, incidence=np.radians(incidence_deg))
    ahead, up = np.asarray(state.velocity) / (0.1 * C), np.array(around.up(incidence_deg))
    turned = around.from_ground_axes(np.eye(3), incidence_deg)
    np.testing.assert_allclose(turned, [ahead, [0.0, 1.0, 0.0], up], atol=1e-15)
    # A shaft that leans forward has its thrust side up, one that lies down has none.
    assert up[2] == pytest.approx(np.sin(np.radians(incidence_deg)))
    _, image = sound_paths(5.0 * ahead[None] - 2.0 * up, around, incidence_deg)
    np.testing.assert_allclose(image[0], 5.0 * ahead - 8.0 * up, atol=1e-12)
    with pytest.raises(ValueError, match="observer 1 is 1 m below the ground"):
        sound_paths(-6.0 * up[None], around, incidence_deg)


def test_observers_below_the_ground_are_refused():
    with pytest.raises(ValueError, match="observer 2 is 1 m below the ground, which is 2 m below"):
        sound_paths([[3.0, 0, -1.0], [3.0, 0, -3.0]], Surroundings(ground=2.0))
    with pytest.raises(ValueError, match="observer 1 is 1 m below the ground"):
        sound_paths([[3.0, 0, -1.0]], Surroundings(ground=2.0, level_flight=True))


def test_surroundings_say_what_they_are():
    assert str(Surroundings()) == "free field"
    full = Surroundings(2.5, level_flight=True, absorption=True)
    assert str(full) == "hard ground 2.5 m below the hub, level flight, absorbing air"


def test_air_that_absorbs_is_one_that_the_standard_knows():
    hot = flying(air=Air(temperature=400.0))
    place = np.array([[3.0, 1.0, -2.0]])
    around = Surroundings(absorption=True)
    paths = sound_paths(place, around)
    with pytest.raises(ValueError, match="absorption: temperature must be within -20 ... 50"):
        tones_by_paths(monopole(place), paths, hot, around)
    with pytest.raises(ValueError, match="absorption: temperature must be within -20 ... 50"):
        bands_by_paths(np.ones((1, 3)), F, paths, hot, around)
    tones_by_paths(monopole(place), paths, hot, Surroundings())

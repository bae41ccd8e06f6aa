"""An analysis at an incidence: what is asked, found, heard, and refused."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

import propmdao as pm
from propmdao.acoustics.broadband.rotor import rotor_self_noise
from propmdao.acoustics.levels.decibels import level_db, mean_square
from propmdao.aerodynamics.solutions.marching.marched_loads import MarchedLoads
from propmdao.aerodynamics.wakes.edgewise import FastEdgewiseWarning
from propmdao.analysis.flights.flyovers import fly_over
from propmdao.analysis.self_noise import BANDS_HZ, strip_flow
from propmdao.analysis.single_point import analyze
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.fidelity import Fidelity
from propmdao.records.wake_law import WakeGrid

COARSE = Fidelity(
    n_chordwise=2,
    n_spanwise=5,
    n_contour=9,
    n_surface_span=6,
    n_harmonics=3,
    n_azimuths=8,
    period_wake=WakeGrid(2.0, 2.0, 1.5, 40.0),
)
PROPELLER = pm.load_propeller("apcsf_11x4.7")
OBSERVERS = pm.arc(1.905, [-90.0, -60.0])


def tilted(**asked):
    point = {"rpm": 4200.0, "speed": 8.0, "incidence_deg": 80.0}
    return analyze(PROPELLER, viscous=False, **{"fidelity": COARSE, **point, **asked})


@pytest.fixture(scope="module")
def edgewise():
    return tilted(observers=OBSERVERS)


def test_hub_loads_and_those_of_the_azimuths_are_in_the_results(edgewise):
    result = edgewise.to_dict()
    assert result["point"]["incidence_deg"] == 80.0
    assert result["hub_force"][2] == pytest.approx(result["thrust"], rel=1e-12)
    assert result["hub_moment"][2] == pytest.approx(-result["torque"], rel=1e-12)
    azimuths = result["azimuths"]
    assert [place["azimuth_deg"] for place in azimuths] == list(np.arange(0.0, 360.0, 45.0))
    mean = np.mean([place["blade_force"] for place in azimuths], axis=0)
    np.testing.assert_allclose(2.0 * mean, result["hub_force"], rtol=1e-12)


def test_revolutions_of_a_march_are_in_the_results(edgewise):
    assert "revolutions" not in edgewise.to_dict()
    loads, thrust = edgewise.loads, np.repeat([3.0, 2.0], COARSE.n_azimuths)
    none = jnp.zeros((0, 3))
    of_march = MarchedLoads(
        **{field.name: getattr(loads, field.name) for field in dataclasses.fields(loads)},
        thrust_history=jnp.asarray(thrust),
        torque_history=jnp.asarray(0.1 * thrust),
        change=jnp.array([0.5]),
        settled=jnp.asarray(False),
        wake=none,
        wake_age=none,
        snapshots=none,
        snapshot_azimuth=none,
        average=2,
    )
    result = dataclasses.replace(edgewise, loads=of_march).to_dict()
    assert result["revolutions"] == [
        {"thrust": 3.0, "torque": pytest.approx(0.3), "change": None},
        {"thrust": 2.0, "torque": pytest.approx(0.2), "change": 0.5},
    ]
    history = result["history"]
    np.testing.assert_allclose(history["azimuth_deg"], 45.0 * np.arange(16.0))
    assert history["thrust"] == thrust.tolist()
    np.testing.assert_allclose(history["torque"], 0.1 * thrust)


def test_the_hub_of_an_axial_rotor_feels_thrust_and_torque_alone():
    result = tilted(incidence_deg=0.0).to_dict()
    assert result["thrust"] > 0.0 and result["torque"] > 0.0
    assert result["hub_force"] == [0.0, 0.0, result["thrust"]]
    assert result["hub_moment"] == [0.0, 0.0, -result["torque"]]
    assert "azimuths" not in result


def test_only_the_part_of_the_flight_along_the_shaft_is_propulsion(edgewise):
    numbers = edgewise.coefficients
    along = numbers.J * np.cos(np.radians(80.0))
    assert numbers.eta == pytest.approx(float(along * numbers.CT / numbers.CP), rel=1e-9)


def test_unsteady_loading_is_heard_on_the_axis(edgewise):
    axial = tilted(incidence_deg=0.0, observers=OBSERVERS)
    heard, silent = (analysis.to_dict()["observers"] for analysis in (edgewise, axial))
    # Steady loads have no tone on the axis at all.
    assert silent[0]["spl_bpf_db"] < -100.0 and heard[0]["spl_bpf_db"] > 40.0
    assert heard[1]["spl_bpf_db"] > silent[1]["spl_bpf_db"] + 10.0


def test_over_ground_and_through_air_the_ways_add(edgewise):
    """Level flight at 80 deg: the shaft leans forward by 10, and so does the mirror."""
    around = pm.Surroundings(ground=3.0, level_flight=True)
    up = np.array(around.up(80.0))
    images = OBSERVERS - 2.0 * (OBSERVERS @ up + 3.0)[:, None] * up
    free = tilted(observers=np.concatenate([OBSERVERS, images])).tones.total
    over_ground = tilted(observers=OBSERVERS, surroundings=around)
    np.testing.assert_allclose(over_ground.tones.total, free[:2] + free[2:], rtol=1e-9)
    absorbed = tilted(observers=OBSERVERS, surroundings=pm.Surroundings(absorption=True))
    lost = edgewise.spl_bpf_db() - absorbed.spl_bpf_db()
    assert np.all((1e-4 < lost) & (lost < 0.1))


def test_broadband_noise_is_that_of_the_flow_at_each_azimuth():
    heard = tilted(observers=OBSERVERS, broadband=True, layers="bpm")
    loads, n = heard.loads, COARSE.n_azimuths
    blade = Blade.from_propeller(PROPELLER)
    radii = strip_interpolation(PROPELLER.r_over_R, COARSE.n_spanwise)

    def flow(speed, lift):
        return strip_flow(loads.strips, speed, lift, blade, radii)

    # An azimuth of which all others are silent, one after the other.
    speed, lift = loads.sections.relative_speed, loads.sections.lift_coefficient
    one_by_one = [
        rotor_self_noise(
            flow(jnp.zeros_like(speed).at[k].set(speed[k]), lift),
            2,
            heard.state,
            OBSERVERS,
            BANDS_HZ,
            n_azimuths=n,
        ).total
        for k in range(n)
    ]
    np.testing.assert_allclose(heard.broadband.total, sum(one_by_one), rtol=1e-9)
    # It is no noise of the mean flow: where the air is fast it is far louder than elsewhere.
    levels = level_db(jnp.stack(one_by_one).sum(axis=2))
    assert np.all(levels.max(axis=0) - levels.min(axis=0) > 6.0)


@pytest.mark.slow
def test_broadband_noise_without_incidence_is_that_of_axial_flight():
    longer = dataclasses.replace(COARSE.period_wake, turns=3.0)  # as in slow edgewise flight
    axial, nearly = (
        tilted(
            incidence_deg=incidence,
            observers=OBSERVERS[1:],
            broadband=True,
            fidelity=dataclasses.replace(COARSE, wake=longer, n_azimuths=24),
        )
        for incidence in (0.0, 1e-7)
    )
    np.testing.assert_allclose(nearly.broadband.total, axial.broadband.total, rtol=1e-6)


def test_rotation_speed_for_a_thrust(edgewise):
    trimmed = tilted(rpm=None, thrust=float(edgewise.loads.thrust))
    assert trimmed.loads.converged
    assert trimmed.rpm == pytest.approx(4200.0, rel=1e-6)


def test_fast_edgewise_flight_is_warned_of():
    with pytest.warns(FastEdgewiseWarning, match=r"advance ratio .* 0\.32\d* is above 0\.3"):
        tilted(speed=20.0)


@pytest.mark.parametrize(
    ("asked", "complaint"),
    [
        ({"incidence_deg": 151.0}, "incidence_deg must be within 0 ... 150 deg; it is 151"),
        ({"incidence_deg": float("nan")}, "incidence_deg must be within 0 ... 150 deg; it is nan"),
    ],
)
def test_what_is_not_modelled_is_refused(asked, complaint):
    with pytest.raises(ValueError, match=complaint):
        tilted(observers=pm.arc(1.905, [-45.0]), **asked)


@pytest.fixture(scope="module")
def flown_over(edgewise):
    return fly_over(edgewise, pm.Flight(height=10.0, duration=4.0, absorption=False))


def test_a_flyover_is_what_is_heard_flying_along_at_every_moment(flown_over):
    """Who flies along is for a moment where the microphone is: mean squares of half a second."""
    lean = np.radians(10.0)
    by_step = {name: power.sum(axis=1) for name, power in flown_over.mean_square.items()}
    for k in (2, 4, 6):
        moments = flown_over.time[k] + 0.5 * (np.arange(9) - 4) / 9
        ahead, down = 8.0 * moments, np.full(9, 10.0)  # of the rotor, from the microphone
        x, z = (
            -np.cos(lean) * ahead + np.sin(lean) * down,
            -np.sin(lean) * ahead - np.cos(lean) * down,
        )
        along = tilted(observers=np.stack([x, 0.0 * x, z], axis=-1), broadband=True)
        heard = {
            name: np.asarray(mean_square(p)).sum(axis=1).mean()
            for name, p in along.tones.parts.items()
        }
        heard["broadband"] = np.asarray(along.broadband.total)[4].sum()  # in the middle of a step
        for name, power in heard.items():
            # Hard ground doubles the pressure. Straight below there is next to no thickness noise.
            loudest = by_step[name].max()
            assert by_step[name][k] == pytest.approx(4.0 * power, rel=0.02, abs=1e-3 * loudest)


def test_distance_elevation_and_doppler_of_a_rotor_that_leans_forward(flown_over):
    lean = np.radians(10.0)
    for step in flown_over.to_dict()["history"]:
        emitted = step["time"] - step["distance"] / 340.294
        way = np.array([-8.0 * emitted, -10.0])  # ahead and up
        assert step["distance"] == pytest.approx(np.linalg.norm(way), rel=1e-9)
        along_shaft = way @ [np.sin(lean), np.cos(lean)] / step["distance"]
        assert step["elevation_deg"] == pytest.approx(np.degrees(np.arcsin(along_shaft)), abs=1e-6)
        doppler = 1 / (1 - 8.0 / 340.294 * way[0] / step["distance"])
        assert step["doppler"] == pytest.approx(doppler, rel=1e-9)

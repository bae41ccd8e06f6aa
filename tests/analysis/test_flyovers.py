"""A flyover against what is heard flying along, and its levels against each other."""

from __future__ import annotations

import dataclasses

import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc, point
from propmdao.acoustics.levels.decibels import oaspl_db
from propmdao.acoustics.levels.time_levels import a_weighted, short_time_level_db
from propmdao.acoustics.sounds.recordings import SAMPLE_RATE
from propmdao.analysis.flights.flyover_results import STEP, Flight
from propmdao.analysis.flights.flyovers import fly_over
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.changes import Change
from propmdao.records.models import NoiseModel, SelfNoiseModel
from propmdao.records.states import OperatingPoint

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")
HEIGHT = 20.0


def run(**options):
    return analyze(PROPELLER, rpm=4200.0, fidelity=COARSE, **options)


def with_records(analysis, **records):
    """The same analysis with other records of what was asked."""
    request = dataclasses.replace(analysis.request, **records)
    return dataclasses.replace(analysis, request=request)


@pytest.fixture(scope="module")
def found():
    """Heard by somebody who flies along below."""
    return run(speed=8.0, broadband=True, observers=arc(HEIGHT, [0.0]))


@pytest.fixture(scope="module")
def heard(found):
    return fly_over(found, Flight(HEIGHT, absorption=False))


def level(mean_square):
    return 10 * np.log10(np.sum(mean_square, axis=-1) / 4e-10)


def from_overhead(heard, part, sound_speed=340.294):
    """Level when the propeller is heard from the nearest point."""
    moment = HEIGHT / sound_speed
    return float(np.interp(moment, heard.time, level(heard.mean_square[part])))


def test_tones_from_overhead_are_those_heard_flying_along_and_the_ground(found, heard):
    # Half a second around: on 4 m of the way, at 20 m height, the level hardly changes.
    along = found.tones
    for part, amplitude in along.parts.items():
        expected = float(oaspl_db(amplitude)[0]) + 20 * np.log10(2)
        assert from_overhead(heard, part) == pytest.approx(expected, abs=0.2)


def test_a_flyover_is_of_the_changed_blade():
    change = Change(twist_offset_deg=1.0, diameter=0.25, n_blades=3)
    flight = Flight(HEIGHT, duration=2.0)
    changed, described = (
        fly_over(analyze(blade, rpm=4200.0, speed=8.0, change=told, fidelity=COARSE), flight)
        for blade, told in ((PROPELLER, change), (change.applied_to(PROPELLER), Change()))
    )
    for part, power in described.mean_square.items():
        np.testing.assert_allclose(changed.mean_square[part], power, rtol=1e-9)


def test_a_blade_tripped_in_the_loads_is_tripped_in_the_noise():
    """Though its analysis had no broadband noise; its layers are those of trips."""
    blade = dataclasses.replace(PROPELLER, trip_upper=0.05, trip_lower=0.05)
    found = analyze(blade, rpm=4200.0, speed=8.0, fidelity=COARSE)
    assert all("trips at x/c 0.05 (upper) and 0.05" in source for source in found.polars.values())
    light = dataclasses.replace(found.model, noise=NoiseModel(SelfNoiseModel()))
    flight = Flight(HEIGHT, duration=2.0)
    noise = [
        fly_over(analysis, flight).mean_square["broadband"]
        for analysis in (found, with_records(found, model=light))
    ]
    np.testing.assert_array_equal(*noise)


def test_a_tip_that_is_described_is_that_of_the_noise():
    """Though its analysis had no broadband noise."""
    rounded, square = (
        analyze(dataclasses.replace(PROPELLER, tip=tip), rpm=4200.0, speed=8.0, fidelity=COARSE)
        for tip in ("rounded", "square")
    )
    noise = NoiseModel(SelfNoiseModel(tip="square"))
    asked = with_records(rounded, model=dataclasses.replace(rounded.model, noise=noise))
    flight = Flight(HEIGHT, duration=2.0)
    of_rounded, of_square, as_asked = (
        fly_over(analysis, flight).mean_square["broadband"] for analysis in (rounded, square, asked)
    )
    np.testing.assert_array_equal(of_square, as_asked)
    assert not np.array_equal(of_square, of_rounded)


def test_a_flyover_is_in_the_air_of_its_analysis():
    along = run(speed=8.0, observers=arc(HEIGHT, [0.0]), density=1.0, sound_speed=330.0)
    heard = fly_over(along, Flight(HEIGHT, duration=2.0, absorption=False))
    for part, amplitude in along.tones.parts.items():
        expected = float(oaspl_db(amplitude)[0]) + 20 * np.log10(2)
        assert from_overhead(heard, part, 330.0) == pytest.approx(expected, abs=0.2)


def test_broadband_noise_at_its_moment_is_that_heard_flying_along_and_the_ground(found):
    # The microphone is for a moment where somebody flying along would be, in the rotor plane.
    heard = fly_over(found, Flight(HEIGHT, duration=2.0, absorption=False))
    k = int(np.argmin(np.abs(heard.time)))
    x = 8.0 * heard.time[k]
    place = np.hypot(HEIGHT, x), -np.degrees(np.arctan2(x, HEIGHT))
    along = run(speed=8.0, broadband=True, observers=point(*place))
    # The Doppler shift moves energy between bands.
    assert level(heard.mean_square["broadband"][k]) == pytest.approx(
        level(np.asarray(along.broadband.total[0])) + 20 * np.log10(2), abs=0.1
    )


def test_energies_add_and_levels_follow(heard):
    summary = heard.to_dict()
    assert len(summary["history"]) == heard.time.size == 60
    assert np.allclose(np.diff(heard.time), STEP)
    assert heard.mean_square.keys() == {"thickness", "loading", "broadband", "total"}
    assert summary["levels"].keys() == heard.mean_square.keys()
    for part in heard.mean_square:
        history = np.array([step[f"{part}_dba"] for step in summary["history"]])
        said = summary["levels"][part]
        assert said["lamax_dba"] == pytest.approx(history.max())
        exposure = 10 * np.log10(np.sum(10 ** (history / 10)) * STEP)
        assert said["sel_dba"] == pytest.approx(exposure)
    assert np.all(heard.mean_square["total"] >= heard.mean_square["broadband"])


def test_distance_elevation_and_doppler_are_those_of_the_geometry(heard):
    for step in heard.to_dict()["history"]:
        emitted = step["time"] - step["distance"] / 340.294
        assert step["distance"] == pytest.approx(np.hypot(HEIGHT, 8.0 * emitted), rel=1e-9)
        ahead = -8.0 * emitted / step["distance"]
        assert step["elevation_deg"] == pytest.approx(np.degrees(np.arcsin(ahead)), abs=1e-6)
        assert step["doppler"] == pytest.approx(1 / (1 - 8.0 / 340.294 * ahead), rel=1e-9)


def test_a_short_flyover_has_no_epnl_and_says_why(found):
    summary = fly_over(found, Flight(HEIGHT, duration=3.0)).to_dict()
    assert summary["epnl"] is None
    assert "must begin and end 10 dB below its maximum" in summary["epnl_failure"]


def test_tripped_blades_and_absorbing_air_are_quieter(found, heard):
    absorbed = fly_over(found, Flight(HEIGHT))
    noise = NoiseModel(SelfNoiseModel("heavy"))
    model = dataclasses.replace(found.model, noise=noise)
    tripped = fly_over(with_records(found, model=model), Flight(HEIGHT))
    loud, less, least = (one.level_dba().max() for one in (heard, absorbed, tripped))
    assert loud > less > least


def test_the_sound_is_as_loud_as_its_levels_say(found):
    flight = Flight(HEIGHT, sideline=5.0, microphone_height=1.2, duration=12.0)
    heard = fly_over(found, flight, sound=True)
    assert heard.pressure.size == 12 * SAMPLE_RATE
    weighted = a_weighted(heard.pressure, SAMPLE_RATE)
    _, recorded = short_time_level_db(weighted, SAMPLE_RATE, STEP)
    # Steps fade into each other: by squares of sines a step keeps 1/2 + 1/pi, its neighbours share
    # the rest. The noise of half a second is random.
    power = np.pad(10 ** (heard.level_dba() / 10), 1, "edge")
    own = 0.5 + 1 / np.pi
    faded = own * power[1:-1] + 0.5 * (1 - own) * (power[:-2] + power[2:])
    np.testing.assert_allclose(recorded, 10 * np.log10(faded), atol=0.4)
    energy = 10 * np.log10(np.sum(10 ** (recorded / 10)) * STEP)
    assert energy == pytest.approx(heard.to_dict()["levels"]["total"]["sel_dba"], abs=0.1)


@pytest.mark.parametrize(
    ("wrong", "message"),
    [
        ({"height": 0.0}, "height of flight must be within 0.001 ... 1000000 m"),
        ({"sideline": np.nan}, "sideline distance must be within .* it is nan"),
        ({"microphone_height": 20.0}, "microphone must be between the ground and the flight"),
        ({"duration": 1.0}, "duration must be within 2 ... 1200 s; it is 1"),
    ],
)
def test_flights_that_are_none(wrong, message):
    with pytest.raises(ValueError, match=message):
        dataclasses.replace(Flight(HEIGHT), **wrong)


def test_flyovers_that_are_none(found):
    hovering = with_records(found, point=OperatingPoint(rpm=4200.0))
    for changed, message in (
        (hovering, "speed of a flyover must be positive"),
        (dataclasses.replace(found, rpm=0.0), "rpm of a flyover must be positive"),
    ):
        with pytest.raises(ValueError, match=message):
            fly_over(changed, Flight(HEIGHT))
    with pytest.raises(ValueError, match="past 2000 m takes 3000 s, at most 1200 s are heard"):
        fly_over(found, Flight(2000.0))

"""What is asked, by records or by single values; a saved result says it, and can be asked again."""

from __future__ import annotations

import dataclasses
import json

import numpy as np
import pytest
from shared_mesh import COARSE

from propmdao.acoustics.kinematics.observers import arc, point
from propmdao.analysis.request import Asked, Request
from propmdao.analysis.single_point import analyze
from propmdao.formats.propellers import load_propeller
from propmdao.propeller.changes import Change
from propmdao.propeller.identity import checksum
from propmdao.records.air import Air, Turbulence
from propmdao.records.fidelity import Marching
from propmdao.records.listening import Listening, ObserverGroup, Surroundings
from propmdao.records.models import LoadModel, Model, NoiseModel, SelfNoiseModel, Transition
from propmdao.records.quantities import ASKED, LEVELS
from propmdao.records.states import OperatingPoint
from propmdao.records.wake_law import WakeGrid, WakeLaw

PROPELLER = load_propeller("apcsf_11x4.7_uiuc")


def test_single_values_go_into_the_records_that_hold_them():
    places = arc(1.905, [-45.0, 0.0])
    request = Request.of(
        thrust=1.2,
        speed=8.0,
        density=1.1,
        sound_speed=330.0,
        twist_offset_deg=1.0,
        n_blades=3,
        stall_delay=False,
        n_crit=9.0,
        wake=WakeLaw(inside=1.5),
        broadband=True,
        trip="light",
        fidelity=COARSE,
        observers=places,
        surroundings=Surroundings(ground=2.0),
    )
    air = Air(density=1.1, sound_speed=330.0)
    assert request.point == OperatingPoint(thrust=1.2, speed=8.0, air=air)
    assert request.change == Change(twist_offset_deg=1.0, n_blades=3)
    loads = LoadModel(stall_delay=False, wake=WakeLaw(inside=1.5), transition=Transition(9.0))
    assert request.model == Model(loads, NoiseModel(SelfNoiseModel("light")), COARSE)
    np.testing.assert_array_equal(request.listening.observers, places)
    assert request.listening.surroundings == Surroundings(ground=2.0)


def test_every_value_of_the_table_may_be_asked_and_is_typed():
    assert set(ASKED) <= set(Asked.__annotations__)
    others = {"wake", "fidelity", "observers", "surroundings"}
    assert set(Asked.__annotations__) - set(ASKED) == others


def test_records_and_single_values_of_other_records_go_together():
    listening = Listening(arc(2.0, [0.0]))
    records = {"listening": listening, "change": None}
    request = Request.of(records, rpm=4000.0, chord_factor=1.1)
    assert request.listening is listening
    assert request.point == OperatingPoint(rpm=4000.0)
    assert request.change == Change(chord_factor=1.1)


@pytest.mark.parametrize(
    ("records", "asked", "message"),
    [
        ({"point": OperatingPoint(rpm=1.0)}, {"rpm": 1.0}, "rpm is given, and point"),
        ({"point": OperatingPoint(rpm=1.0)}, {"density": 1.0}, "density is given, and point"),
        ({"change": Change()}, {"n_blades": 3}, "n_blades is given, and change"),
        ({"model": Model()}, {"fidelity": COARSE}, "fidelity is given, and model"),
        ({"model": Model()}, {"n_crit": 9.0}, "n_crit is given, and model"),
        ({"model": Model()}, {"trip": "none"}, "trip is given, and model"),
        ({"listening": Listening()}, {"observers": []}, "observers is given, and listening"),
    ],
)
def test_a_record_and_a_single_value_of_it_contradict(records, asked, message):
    drive = {} if "point" in records else {"rpm": 4000.0}
    with pytest.raises(ValueError) as error:
        analyze(PROPELLER, **records, **drive, **asked)
    assert str(error.value) == f"{message}, which holds it: give one of them"


@pytest.mark.parametrize("asked", [{}, {"rpm": 4000.0, "thrust": 1.0}])
def test_exactly_one_of_rpm_and_thrust_is_asked(asked):
    with pytest.raises(ValueError, match="^give either rpm or thrust$"):
        analyze(PROPELLER, **asked)


@pytest.mark.parametrize("trip", ["light", "heavy"])
def test_tripping_is_of_broadband_noise(trip):
    with pytest.raises(ValueError, match=f"trip '{trip}' is about broadband noise: ask for"):
        Request.of(rpm=4000.0, trip=trip)
    assert Request.of(rpm=4000.0, trip="none").model == Model()


def test_turbulence_is_of_broadband_noise_and_has_a_length():
    eddies = {"turbulence_intensity": 0.5, "turbulence_length_scale": 0.05}
    with pytest.raises(ValueError, match="0.5 m/s is about broadband noise: ask for broadband"):
        Request.of(rpm=4000.0, **eddies)
    with pytest.raises(ValueError, match="turbulence_length_scale must be above 0 m where there"):
        Request.of(rpm=4000.0, broadband=True, turbulence_intensity=0.5)
    request = Request.of(rpm=4000.0, broadband=True, **eddies)
    assert request.point.turbulent == Turbulence(0.5, 0.05)
    assert Request.of(rpm=4000.0, turbulence_length_scale=0.05).point.turbulent is None
    assert Request.from_dict(request.to_dict()).point == request.point


@pytest.mark.parametrize("name", ["n_crit", "trip_upper", "trip_lower"])
def test_transition_is_of_sections(name):
    with pytest.raises(ValueError, match=f"^{name} is about the polars of the sections: inviscid"):
        Request.of(rpm=4000.0, viscous=False, **{name: 1.0})
    left_open = Request.of(rpm=4000.0, viscous=False, **{name: None})
    assert left_open.model == Request.of(rpm=4000.0, viscous=False).model


def test_what_there_is_not_to_ask_is_named_with_all_there_is():
    with pytest.raises(TypeError, match="'rmp' is nothing that can be asked; there are rpm, "):
        analyze(PROPELLER, rmp=4000.0)


@pytest.mark.parametrize(
    "observers",
    [np.array([[1.905, -45.0], [1.905, 0.0]]), [(1.905, -45.0)], [1.905, -45.0], 1.905],
    ids=["(n, 2) array", "radius and elevation", "one pair", "radius"],
)
def test_observers_by_radius_and_elevation_are_refused_with_what_makes_them(observers):
    with pytest.raises(ValueError, match=r"\(n, 3\) array .*propmdao.arc\(radius, elevation") as e:
        analyze(PROPELLER, rpm=4000.0, observers=observers)
    assert "\n" not in str(e.value)


ASKED_AGAIN: dict[str, Asked] = {
    "nobody listens": {"rpm": 4200.0, "viscous": False},
    "thrust": {"thrust": 1.2, "speed": 8.0, "observers": arc(1.905, [-45.0, 0.0])},
    "everything": {
        "rpm": 4200.0,
        "speed": 8.0,
        "density": 1.1,
        "sound_speed": 335.0,
        "temperature": 270.0,
        "twist_offset_deg": 1.0,
        "chord_factor": 1.1,
        "diameter": 0.25,
        "n_blades": 3,
        "stall_delay": False,
        "n_crit": 7.0,
        "wake": WakeLaw(inside=1.8),
        "broadband": True,
        "trip": "heavy",
        "observers": point(1.905, -10.0, [0.0, 30.0]),
        "surroundings": Surroundings(3.0, level_flight=True, absorption=True),
        "fidelity": dataclasses.replace(COARSE, wake=WakeGrid(turns=5.95)),
    },
}


@pytest.mark.parametrize("asked", ASKED_AGAIN.values(), ids=ASKED_AGAIN)
def test_a_saved_result_is_asked_again_and_gives_the_same_numbers(asked):
    analysis = analyze(PROPELLER, **({"fidelity": COARSE} | asked))
    result = analysis.to_dict()
    saved = json.loads(json.dumps(result, allow_nan=False))
    request = Request.from_dict(saved)
    assert request.to_dict() == analysis.request.to_dict()
    for name in ("point", "change", "model"):
        assert getattr(request, name) == getattr(analysis.request, name)
    np.testing.assert_array_equal(request.listening.observers, analysis.listening.observers)
    assert request.listening.surroundings == analysis.listening.surroundings
    records = {name: getattr(request, name) for name in ("change", "model", "listening")}
    assert analyze(PROPELLER, request.point, **records).to_dict() == result


def test_groups_of_observers_are_saved():
    groups = (ObserverGroup("left", "arc", 1), ObserverGroup("below", "point", 2))
    listening = Listening(arc(2.0, [0.0, -45.0, -90.0]), groups=groups)
    saved = json.loads(json.dumps(Request(OperatingPoint(rpm=1.0), listening=listening).to_dict()))
    assert Request.from_dict(saved).listening.groups == groups


def test_a_saved_result_says_what_was_asked_of_which_blade():
    result = analyze(
        PROPELLER,
        rpm=4200.0,
        n_blades=3,
        density=1.1,
        fidelity=COARSE,
        observers=arc(2.0, [0.0, 30.0]),
    ).to_dict()
    assert result["propeller"] == {
        "name": "apcsf_11x4.7_uiuc",
        "diameter": PROPELLER.diameter,
        "n_blades": 2,  # as described
        "checksum": checksum(PROPELLER),
        "source": PROPELLER.source,
    }
    assert result["change"] == {
        "twist_offset_deg": 0.0,
        "chord_factor": 1.0,
        "diameter": None,
        "n_blades": 3,
    }
    assert result["point"]["rpm"] == 4200.0 and result["point"]["thrust"] is None
    assert result["point"]["air"]["rho"] == result["rho"] == 1.1
    assert result["polars"].keys() == {name for _, name in PROPELLER.airfoils}
    assert all("n_crit 5" in source for source in result["polars"].values())
    loads = result["model"]["loads"]
    used = {"n_crit": 5.0, "trip_upper": 1.0, "trip_lower": 1.0}
    assert loads["viscous"] and loads["transition"] == used
    assert result["model"]["noise"] == {"broadband": None}
    assert result["model"]["fidelity"] == dataclasses.asdict(COARSE)
    assert result["listening"]["observers"] == [[2.0, 0.0, 0.0], pytest.approx([3**0.5, 0, 1])]
    assert set(LEVELS) <= result["observers"][0].keys()


@pytest.mark.parametrize(
    ("spoil", "message"),
    [
        ({"change": {"twist": 1.0}}, "Change has no 'twist'; it has chord_factor, diameter"),
        ({"point": {"rpm": 1.0, "thrust": 1.0}}, "give either rpm or thrust"),
        (
            {"model": {"fidelity": {"n_harmonics": 0}}},
            "n_harmonics must be within 1 ... 1000; it is 0",
        ),
    ],
)
def test_a_saved_request_that_is_none_is_refused(spoil, message):
    saved = Request(OperatingPoint(rpm=1.0)).to_dict()
    with pytest.raises(ValueError, match=message):
        Request.from_dict(saved | spoil)


@pytest.mark.parametrize("value", ["no", 1, Marching(), np.array([True])])
def test_a_switch_is_true_or_false(value):
    with pytest.raises(ValueError, match="unsteady must be True or False; it is .+") as error:
        Request.of(unsteady=value)
    assert "\n" not in str(error.value)


def test_a_switch_of_an_array_is_a_switch():
    request = Request.of(rpm=4000.0, viscous=np.array([False])[0])
    assert not request.model.loads.viscous

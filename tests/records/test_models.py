"""Models know their words and numbers, and are hashable: JAX compiles once for each."""

from __future__ import annotations

import dataclasses

import pytest

from propmdao.records.fidelity import Fidelity
from propmdao.records.models import (
    FREE,
    LoadModel,
    Model,
    NoiseModel,
    SelfNoiseModel,
    Transition,
)
from propmdao.records.plain import from_plain, to_plain


def test_by_default_loads_are_viscous_and_noise_is_of_the_tones():
    model = Model()
    assert model.loads.viscous and model.loads.stall_delay
    assert model.loads.transition.completed() == Transition(5.0, FREE, FREE)
    assert model.noise.broadband is None
    assert SelfNoiseModel() == SelfNoiseModel(trip=None, tip="rounded", layers="sections")


def test_equal_models_are_one_model_to_the_compiler():
    def made():
        return Model(
            loads=LoadModel(transition=Transition(9.0)),
            noise=NoiseModel(SelfNoiseModel("heavy")),
            fidelity=Fidelity(n_spanwise=10),
        )

    assert made() == made() and hash(made()) == hash(made())
    assert made() != Model()


@pytest.mark.parametrize(
    ("record", "asked", "message"),
    [
        (SelfNoiseModel, {"trip": "some"}, "trip must be one of none, light, heavy; it is 'some'"),
        (
            SelfNoiseModel,
            {"trip": ("light", "some")},
            "trip must be one of none, light, heavy; it is 'some'",
        ),
        (SelfNoiseModel, {"tip": "round"}, "tip must be one of rounded, square; it is 'round'"),
        (SelfNoiseModel, {"layers": "own"}, "layers must be one of sections, bpm; it is 'own'"),
        (Transition, {"n_crit": 0.0}, "n_crit must be within 0.1 ... 30; it is 0"),
        (Transition, {"n_crit": float("nan")}, "n_crit must be within 0.1 ... 30; it is nan"),
        (Transition, {"n_crit": 99.0}, "n_crit must be within 0.1 ... 30; it is 99"),
        (Transition, {"trip_upper": -0.1}, "trip_upper must be within 0 ... 1; it is -0.1"),
        (Transition, {"trip_lower": 1.2}, "trip_lower must be within 0 ... 1; it is 1.2"),
        (Fidelity, {"n_chordwise": 1}, "n_chordwise must be within 2 ... 100; it is 1"),
        (Fidelity, {"n_spanwise": 0}, "n_spanwise must be within 2 ... 400; it is 0"),
        (Fidelity, {"n_contour": 4}, "n_contour must be within 5 ... 1001; it is 4"),
        (Fidelity, {"n_surface_span": 1}, "n_surface_span must be within 2 ... 1001; it is 1"),
        (Fidelity, {"n_harmonics": 0}, "n_harmonics must be within 1 ... 1000; it is 0"),
        (
            Fidelity,
            {"n_chordwise": 100, "n_spanwise": 400},
            "n_chordwise times n_spanwise must be at most 4096; it is 40000",
        ),
    ],
)
def test_what_no_model_knows_is_named(record, asked, message):
    with pytest.raises(ValueError) as error:
        record(**asked)
    assert str(error.value) == message


def test_records_cannot_be_changed_under_a_result():
    for record in (Model(), LoadModel(), Fidelity()):
        with pytest.raises(dataclasses.FrozenInstanceError):
            setattr(record, dataclasses.fields(record)[0].name, None)


def test_what_is_asked_of_transition_goes_before_the_description_and_that_before_the_defaults():
    asked, described = Transition(n_crit=9.0), Transition(n_crit=7.0, trip_upper=0.1)
    assert asked.completed(described) == Transition(9.0, 0.1, FREE)
    assert Transition().completed(described) == Transition(7.0, 0.1, FREE)
    assert asked.completed(described).upside_down == Transition(9.0, FREE, 0.1)
    assert str(asked.completed()) == "n_crit 9"
    said = "n_crit 9, trips at x/c 0.1 (upper) and free (lower)"
    assert str(asked.completed(described)) == said


@pytest.mark.parametrize(
    ("upper", "lower", "word", "trip"),
    [
        (FREE, FREE, None, "none"),
        (0.05, FREE, None, "none"),  # the other side sheds its vortices
        (0.05, 0.9, None, "none"),
        (0.05, 0.1, None, "light"),
        (0.0, 0.5, None, "light"),
        (0.05, 0.1, "none", "none"),
        (0.05, 0.1, "heavy", "heavy"),  # what is asked of the noise alone
        (FREE, FREE, "heavy", "heavy"),
    ],
)
def test_blades_tripped_on_both_sides_are_tripped_in_the_noise(upper, lower, word, trip):
    model = Model(
        LoadModel(transition=Transition(trip_upper=upper)),
        NoiseModel(SelfNoiseModel(word, layers="bpm")),
    )
    completed = model.completed(Transition(n_crit=3.0, trip_lower=lower), None, None)
    assert completed.loads.transition == Transition(3.0, upper, lower)
    assert completed.noise.broadband == SelfNoiseModel(trip, layers="bpm")
    assert (
        completed.completed(Transition(), None, "light") == completed
    )  # a saved result, asked again


def test_the_tip_is_that_of_the_propeller_where_nothing_else_is_asked() -> None:
    noisy = Model(noise=NoiseModel(SelfNoiseModel()))
    for described, tip in ((None, "rounded"), ("square", "square"), ("rounded", "rounded")):
        completed = noisy.completed(Transition(), described, None).noise.broadband
        assert completed == SelfNoiseModel("none", tip=tip)
    assert Model().completed(Transition(), "square", "light").noise.broadband is None


@pytest.mark.parametrize(
    ("asked", "described", "trip"),
    [
        (None, None, "none"),
        (None, "heavy", "heavy"),
        (None, ("none", "light", "heavy"), ("none", "light", "heavy")),
        (None, ("light", "light", "light"), "light"),
        ("heavy", ("none", "light", "none"), "heavy"),
        ("none", "light", "none"),
    ],
)
def test_trips_are_those_of_the_propeller_where_nothing_else_is_asked(asked, described, trip):
    noisy = Model(noise=NoiseModel(SelfNoiseModel(asked)))
    noise = noisy.completed(Transition(), None, described).noise.broadband
    assert noise == SelfNoiseModel(trip)
    assert from_plain(SelfNoiseModel, to_plain(noise)) == noise
    assert noise.trips(3) == (trip if isinstance(trip, tuple) else (trip,) * 3)


def test_trips_are_at_the_stations():
    with pytest.raises(ValueError, match="trip has 2 values for 3 stations"):
        SelfNoiseModel(("none", "light")).trips(3)

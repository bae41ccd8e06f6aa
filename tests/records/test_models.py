"""Models know their words and numbers, and are hashable: JAX compiles once for each."""

from __future__ import annotations

import dataclasses

import pytest

from propmdao.records.fidelity import Fidelity
from propmdao.records.models import LoadModel, Model, NoiseModel, SelfNoiseModel, Transition


def test_by_default_loads_are_viscous_and_noise_is_of_the_tones():
    model = Model()
    assert model.loads.viscous and model.loads.stall_delay and model.loads.transition.n_crit == 5.0
    assert model.noise.broadband is None
    assert SelfNoiseModel() == SelfNoiseModel(trip="none", tip="rounded")


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
        (SelfNoiseModel, {"tip": "round"}, "tip must be one of rounded, square; it is 'round'"),
        (Transition, {"n_crit": 0.0}, "n_crit must be within 0.1 ... 30; it is 0"),
        (Transition, {"n_crit": float("nan")}, "n_crit must be within 0.1 ... 30; it is nan"),
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

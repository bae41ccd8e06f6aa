"""Schedules of a march."""

import pytest

from propmdao.records.fidelity import FreeWake, Marching


def test_steps_are_those_of_the_thesis():
    schedule = Marching()
    assert (schedule.revolutions, schedule.average, schedule.timestep_deg) == (4, 3, 3.0)
    assert schedule.steps_per_turn == 120
    assert schedule.n_steps == 480


@pytest.mark.parametrize(
    ("values", "message"),
    [
        ({"timestep_deg": 7.0}, "timestep_deg must divide a revolution of 360 deg; it is 7"),
        ({"timestep_deg": 0.0}, "timestep_deg must be within 0.25 ... 45 deg; it is 0"),
        ({"revolutions": 0}, "revolutions must be within 1 ... 1000; it is 0"),
        ({"revolutions": 2.5}, "revolutions must be a whole number; it is 2.5"),
        ({"average": 5}, "average must be at most the revolutions, 4; it is 5"),
        ({"start": "slow"}, "start must be one of steady, impulsive; it is 'slow'"),
        ({"gust_start": 2.0}, "gust_start is about a gust: give gust_speed, too"),
        (
            {"gust_speed": 2.0, "gust_start": 4.0},
            "gust_start must be below the revolutions of the march, 4; it is 4",
        ),
        (
            {"gust_speed": 2.0, "gust_length": 0.02},
            "gust_length must be at least four time steps, 0.0333 revolutions; it is 0.02",
        ),
        ({"gust_shape": "sharp"}, "gust_shape must be one of cosine, step; it is 'sharp'"),
        ({"wake_motion": "rigid"}, "wake_motion must be one of prescribed, free; it is 'rigid'"),
    ],
)
def test_schedules_that_cannot_be_kept_are_refused_in_one_line(values, message):
    with pytest.raises(ValueError) as refused:
        Marching(**values)
    assert str(refused.value) == message


def test_a_free_wake_of_no_core_is_refused():
    with pytest.raises(ValueError, match="core of a free wake must be within"):
        FreeWake(core=0.0)

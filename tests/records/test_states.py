"""What a user says of the operation, and what the solvers are told of it."""

from __future__ import annotations

import dataclasses
import math

import pytest

from propmdao.records.air import Air
from propmdao.records.states import OperatingPoint, RotorState


@pytest.mark.parametrize("asked", [{}, {"rpm": 4000.0, "thrust": 1.0}, {"rpm": 0.0, "thrust": 1.0}])
def test_exactly_one_of_rpm_and_thrust_is_given(asked):
    with pytest.raises(ValueError, match="^give either rpm or thrust$"):
        OperatingPoint(**asked)


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"rpm": -1.0}, "rpm must be 0 or within 0.001 ... 1000000 rpm; it is -1"),
        ({"rpm": math.nan}, "rpm must be 0 or within 0.001 ... 1000000 rpm; it is nan"),
        ({"rpm": math.inf}, "rpm must be 0 or within 0.001 ... 1000000 rpm; it is inf"),
        ({"thrust": 0.0}, "thrust must be within 1e-09 ... 1000000000 N; it is 0"),
        ({"thrust": math.nan}, "thrust must be within 1e-09 ... 1000000000 N; it is nan"),
        ({"rpm": 1.0, "speed": -2.0}, "speed must be within 0 ... 1000 m/s; it is -2"),
        (
            {"rpm": 1.0, "air": Air(density=0.0)},
            "density must be within 0.0001 ... 2000 kg/m3; it is 0",
        ),
        ({"rpm": "fast"}, "rpm must be a number; it is 'fast'"),
        ({"rpm": 10**400}, "rpm must be 0 or within 0.001 ... 1000000 rpm; it is inf"),
        (
            {"rpm": 1.0, "air": Air(temperature=0.0)},
            "temperature must be within 20 ... 1000 K; it is 0",
        ),
        (
            {"rpm": 1.0, "air": Air(sound_speed=-1.0)},
            "sound_speed must be within 50 ... 3000 m/s; it is -1",
        ),
        (
            {"rpm": 1.0, "air": Air(dynamic_viscosity=math.nan)},
            "dynamic_viscosity must be within 1e-07 ... 1 Pa s; it is nan",
        ),
    ],
)
def test_points_that_no_propeller_can_be_at(asked, message):
    with pytest.raises(ValueError) as error:
        OperatingPoint(**asked)
    assert str(error.value) == message


def test_standing_still_is_a_point():
    assert OperatingPoint(rpm=0.0).rotation_speed == 0.0


def test_the_state_of_the_rotor_is_in_radians_per_second():
    point = OperatingPoint(rpm=3000.0, speed=17.0, air=Air(sound_speed=340.0))
    assert point.rotation_speed == pytest.approx(100 * math.pi)
    state = point.at(point.rotation_speed)
    assert state == RotorState(point.rotation_speed, 17.0, point.air)
    assert state.mach == pytest.approx(0.05)
    assert state.turning(5.0) == RotorState(5.0, 17.0, point.air)
    assert OperatingPoint(thrust=1.0).rotation_speed is None


@pytest.mark.parametrize("name", ["rpm", "thrust", "speed"])
def test_a_point_that_is_no_number_is_named(name):
    drive = {} if name in ("rpm", "thrust") else {"rpm": 4000.0}
    with pytest.raises(ValueError, match=f"^{name} must be .*; it is nan"):
        OperatingPoint(**drive, **{name: float("nan")})


@pytest.mark.parametrize("name", [field.name for field in dataclasses.fields(Air)])
def test_air_that_is_no_number_is_named(name):
    for value in (float("nan"), float("inf")):
        with pytest.raises(ValueError, match=f"^{name} must be .*; it is {value}"):
            OperatingPoint(rpm=4000.0, air=Air(**{name: value}))

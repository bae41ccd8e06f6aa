"""Gusts: how they come, how they carry the wake, and the rotor that they leave."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.marching.gusts import (
    Gust,
    downstream,
    gust_of,
    in_gust,
    mean_of_turn,
)
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.records.air import Air
from propmdao.records.fidelity import FreeWake, Marching
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw

TURN = 2.0 * np.pi
COMES_AND_GOES = Gust(jnp.asarray(3.0), TURN, 2.0 * TURN, 2.0)
STAYS = dataclasses.replace(COMES_AND_GOES, half_waves=1.0)
N = 12
SCHEDULE = Marching(revolutions=6, average=1, timestep_deg=360.0 / N)


def test_a_gust_comes_as_asked():
    at = TURN * np.array([0.0, 1.0, 1.5, 2.0, 3.0, 9.0])
    np.testing.assert_allclose(
        COMES_AND_GOES.speed_at(at), [0.0, 0.0, 1.5, 3.0, 0.0, 0.0], atol=1e-12
    )
    share = 0.5 * (1.0 - np.cos(0.25 * np.pi))
    np.testing.assert_allclose(STAYS.speed_at(at), [0, 0, 3 * share, 1.5, 3, 3], atol=1e-12)
    assert gust_of(Marching(gust_speed=3.0, gust_start=1.0, gust_length=2.0)) == COMES_AND_GOES


@pytest.mark.parametrize("gust", [COMES_AND_GOES, STAYS])
def test_its_way_is_the_integral_of_its_speed(gust):
    azimuth = np.linspace(0.0, 5.0 * TURN, 5001)
    speed = np.asarray(gust.speed_at(azimuth))
    way = np.concatenate([[0.0], np.cumsum(0.5 * (speed[1:] + speed[:-1]) * np.diff(azimuth))])
    np.testing.assert_allclose(gust.way_at(azimuth), way, atol=1e-4)


def test_what_is_shed_after_the_gust_has_come_goes_with_all_of_it():
    state, ages = RotorState(100.0, 4.0, Air()), jnp.asarray([0.0, 0.5 * TURN, 7.0 * TURN])
    way = np.asarray(downstream(STAYS, state, ages, 8.0 * TURN))
    assert way[1] == pytest.approx(7.0 * 0.5 * TURN / 100.0)
    # The oldest has seen a turn without gust and two turns while it came, in the mean half of it.
    assert way[2] == pytest.approx((4.0 * 7.0 + 3.0 * (7.0 - 2.0 + 1.0)) * TURN / 100.0)
    assert mean_of_turn(STAYS, state, 8.0 * TURN).axial_speed == pytest.approx(7.0)


def test_a_gust_along_the_shaft_turns_the_flight_of_a_tilted_rotor():
    met = in_gust(RotorState(100.0, 8.0, Air(), jnp.radians(90.0)), jnp.asarray(6.0))
    assert met.axial_speed == pytest.approx(6.0) and met.edgewise_speed == pytest.approx(8.0)
    assert in_gust(RotorState(100.0, 2.0, Air()), jnp.asarray(-3.0)).axial_speed == -1.0


@pytest.fixture(scope="module")
def case(slow_flyer):
    wake = wake_transport(WakeLaw(), WakeGrid(2.0, 2.0, 1.5, 40.0))
    of_flyer = slow_flyer.case(nodes=slow_flyer.nodes(2, 5))
    state = RotorState(440.0, 6.0, Air())
    return dataclasses.replace(of_flyer, state=state, wake=wake, n_azimuths=N)


def test_a_gust_that_stays_ends_in_the_steady_solution_of_faster_flight(case):
    gust = {"gust_speed": 2.0, "gust_shape": "step", "gust_length": 0.5}
    marched = march(case, dataclasses.replace(SCHEDULE, **gust))
    faster = dataclasses.replace(case.state, speed=8.0)
    before, after = (
        float(axial.solve(dataclasses.replace(case, state=state)).thrust)
        for state in (case.state, faster)
    )
    turns = marched.thrust_by_revolution
    assert after < 0.95 * before
    assert turns[0] == pytest.approx(before, rel=1e-4)
    assert turns[-1] == pytest.approx(after, rel=2e-3)


def test_one_that_goes_leaves_the_rotor_as_it_was(case):
    gust = {"gust_speed": 2.0, "gust_length": 0.5, "wake_motion": "prescribed"}
    marched = march(case, dataclasses.replace(SCHEDULE, **gust))
    turns = marched.thrust_by_revolution
    assert turns[1] < 0.97 * turns[0]
    assert turns[-1] == pytest.approx(turns[0], rel=2e-3)


def test_a_free_wake_is_carried_by_it(case):
    free = {"wake_motion": "free", "free_wake": FreeWake(1.0, 0.05, 5, 30.0), "revolutions": 3}
    still, blown = (
        march(case, dataclasses.replace(SCHEDULE, **free, **gust))
        for gust in ({}, {"gust_speed": 2.0, "gust_length": 0.5})
    )
    lower = np.asarray(still.wake - blown.wake)[0, -1, -1, 2]
    # Half of the largest speed in the mean over half a turn; the rest is what the wake induces.
    assert lower == pytest.approx(1.0 * 0.5 * TURN / 440.0, rel=0.3)

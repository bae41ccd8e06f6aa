"""Marching in time against the steady and the periodic solution."""

import dataclasses

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.chord_lines import LINE_POINTS
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial, periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.marching.flow import march_flow
from propmdao.aerodynamics.solutions.marching.marched import march
from propmdao.aerodynamics.solutions.marching.stepping import advance, march_start
from propmdao.aerodynamics.solutions.result import failure
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.fidelity import FreeWake, Marching
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw
from propmdao.runtime.compilation import compiled

NC, NS, N = 2, 5, 12
COARSE = wake_transport(WakeLaw(), WakeGrid(2.0, 2.0, 1.5, 40.0))
SCHEDULE = Marching(revolutions=4, average=1, timestep_deg=360.0 / N)


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    """The rotor at an incidence, held to its polars or not, as it is or its mirror image."""
    polars = polars_for(load_propeller("apcsf_11x4.7_uiuc"))
    sections = viscous_sections(
        polars, slow_flyer.blade, strip_interpolation(slow_flyer.stations, NS)
    )

    def case(incidence_deg, viscous=True, z_sign=1.0):
        nodes = slow_flyer.nodes(NC, NS).at[..., 2].multiply(z_sign)
        state = RotorState(440.0, 8.0, Air(), jnp.radians(incidence_deg))
        geometry = RotorGeometry(nodes, slow_flyer.radius, 2)
        return RotorCase(geometry, state, sections if viscous else None, COARSE, N)

    return case


@pytest.fixture(scope="module")
def tilted(rotor):
    return march(rotor(70.0, viscous=False), SCHEDULE, snapshots=3)


def test_in_axial_flight_the_steady_solution_stays_what_it_is(rotor):
    marched = march(rotor(0.0), SCHEDULE)
    steady = axial.solve(rotor(0.0))
    assert marched.settled and marched.converged and failure(marched) is None
    # The far wake is in single precision.
    assert marched.thrust == pytest.approx(float(steady.thrust), rel=1e-5)
    assert marched.torque == pytest.approx(float(steady.torque), rel=1e-5)
    np.testing.assert_allclose(marched.thrust_history, float(steady.thrust), rtol=1e-5)


def test_an_impulsive_start_ends_in_the_steady_solution_and_says_that_it_has_not_yet(rotor):
    impulsive = dataclasses.replace(SCHEDULE, start="impulsive", average=3)
    marched = march(rotor(0.0), impulsive)
    steady = float(axial.solve(rotor(0.0)).thrust)
    turns = np.asarray(marched.thrust_history).reshape(4, N)
    # Half the lift at once, as Wagner has it, then too much until the wake is there.
    assert turns[0].mean() > 1.05 * steady
    assert turns[-1].mean() == pytest.approx(steady, rel=0.005)
    assert not marched.settled and not marched.converged
    assert "from one revolution to the next" in failure(marched)


def test_older_wake_is_read_between_points_of_a_strip(rotor, slow_flyer):
    case = rotor(70.0, viscous=False)
    nodes = slow_flyer.nodes(LINE_POINTS + 1, NS)
    case = dataclasses.replace(case, rotor=dataclasses.replace(case.rotor, nodes=nodes))
    flow = march_flow(case, SCHEDULE)
    assert flow.parts.n_young <= flow.parts.n_close < flow.parts.n_near
    everywhere = dataclasses.replace(flow, parts=dataclasses.replace(flow.parts, n_close=None))
    state = march_start(flow, SCHEDULE)
    step = compiled(lambda flow: advance(flow, state, 0.3)[1], optimisation=0)
    read, exact = (step(each) for each in (flow, everywhere))
    # Chordwise segments lie between strips as coarse as what is under them: sums tell.
    total, expected = (loads.force.sum(axis=0) for loads in (read, exact))
    np.testing.assert_allclose(total, expected, atol=1e-3 * np.abs(expected).max())
    assert not np.array_equal(total, expected)


@pytest.mark.parametrize("viscous", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_at_an_incidence_it_ends_in_the_periodic_solution(rotor, tilted, viscous):
    tilted = march(rotor(70.0), SCHEDULE) if viscous else tilted
    period = periodic.solve(rotor(70.0, viscous))
    assert tilted.converged
    assert tilted.thrust == pytest.approx(float(period.thrust), rel=0.005)
    mean = float(jnp.linalg.norm(period.hub_force))
    np.testing.assert_allclose(tilted.hub_force, period.hub_force, atol=0.005 * mean)
    # The mean of the last revolution, but for the blades' unsteady term, which is differenced.
    assert tilted.thrust_by_revolution[-1] == pytest.approx(float(tilted.thrust), rel=1e-3)
    assert tilted.torque_by_revolution[-1] == pytest.approx(float(tilted.torque), rel=5e-3)
    np.testing.assert_allclose(tilted.blade_force, period.blade_force, atol=0.01 * mean)


def test_the_wake_is_kept_at_the_moments_that_were_asked_for(tilted):
    n_nodes = COARSE.ages.size
    assert tilted.snapshots.shape == (3, 2, NS + 1, n_nodes, 3)
    np.testing.assert_allclose(
        tilted.snapshot_azimuth, 2.0 * np.pi / N * np.array([16, 32, 48]), rtol=1e-12
    )
    np.testing.assert_allclose(tilted.snapshots[-1], tilted.wake)
    # After whole turns blade 1 stands at azimuth 0, and its wake goes back from there.
    tip = np.asarray(tilted.wake[0, -1])
    assert np.degrees(np.arctan2(tip[0, 1], tip[0, 0])) == pytest.approx(0.0, abs=10.0)
    assert tip[-1, 2] < -0.5 * np.ptp(tip[:, 1])


def test_a_free_wake_in_hover_contracts_and_descends(rotor):
    case = rotor(0.0)
    case = dataclasses.replace(case, state=dataclasses.replace(case.state, speed=0.0))
    free = FreeWake(turns=1.0, core=0.05, n_filaments=5, step_deg=30.0)
    schedule = dataclasses.replace(SCHEDULE, wake_motion="free", free_wake=free)
    marched = march(case, schedule)
    tip = np.asarray(marched.wake[0, -1]) / 0.1397
    at_half_a_turn = np.abs(np.degrees(COARSE.ages) - 180.0).argmin()
    assert 0.7 < np.hypot(*tip[at_half_a_turn, :2]) < 0.97
    assert tip[-1, 2] < -0.4
    # It is another wake than the prescribed one, and not far from it.
    prescribed = float(march(case, SCHEDULE).thrust)
    assert 1e-3 < abs(float(marched.thrust) / prescribed - 1.0) < 0.1


@pytest.mark.slow
def test_the_mirror_image_of_an_edgewise_rotor_thrusts_the_other_way_in_a_free_wake(rotor):
    schedule = dataclasses.replace(
        SCHEDULE, revolutions=1, wake_motion="free", free_wake=FreeWake(1.0, 0.05, 5, 30.0)
    )
    up, down = (march(rotor(90.0, viscous=False, z_sign=sign), schedule) for sign in (1.0, -1.0))
    assert down.thrust == pytest.approx(-float(up.thrust), rel=1e-6)
    assert down.torque == pytest.approx(float(up.torque), rel=1e-6)
    mirrored = np.asarray(up.wake) * [1.0, 1.0, -1.0]
    np.testing.assert_allclose(down.wake, mirrored, atol=1e-5 * 0.1397)


def test_a_march_beyond_memory_is_refused_before_it_starts(rotor):
    with pytest.raises(ValueError, match=r"needs .* GiB, and 4 GiB are the limit"):
        march(rotor(0.0), SCHEDULE, snapshots=10**6)


def test_a_march_that_has_settled_may_stop(rotor):
    schedule = dataclasses.replace(SCHEDULE, revolutions=9, average=2, stop_when_settled=True)
    marched = march(rotor(0.0), schedule)
    assert marched.settled and marched.thrust_history.size == 2 * N


def test_a_rotor_at_rest_is_refused(rotor):
    case = rotor(0.0)
    with pytest.raises(ValueError, match="does not turn"):
        march(case.turning(0.0), SCHEDULE)

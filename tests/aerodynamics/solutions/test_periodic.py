"""Periodic solution: limits, symmetries, stalled and reversed flow, derivatives."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial, periodic
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import failure
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.wake_law import WakeGrid, WakeLaw

OMEGA, NC, NS, N = 440.0, 2, 5, 8
# Coarse, for all but the tests of convergence: two turns, 26 nodes.
COARSE = wake_transport(WakeLaw(), WakeGrid(2.0, 2.0, 1.5, 40.0))


@pytest.fixture(scope="module")
def rotor(slow_flyer):
    """The rotor at an operating point, inviscid or with its polars."""
    nodes = slow_flyer.nodes(NC, NS)
    polars = polars_for(load_propeller("apcsf_11x4.7_uiuc"))
    middle = strip_interpolation(slow_flyer.stations, NS)
    sections = viscous_sections(polars, slow_flyer.blade, middle)

    def case(speed=8.0, incidence_deg=0.0, viscous=False, omega=OMEGA, nodes=nodes):
        state = RotorState(omega, speed, Air(), jnp.radians(incidence_deg))
        geometry = RotorGeometry(nodes, slow_flyer.radius, 2)
        return RotorCase(geometry, state, sections if viscous else None, COARSE, N)

    return case


def flipped(nodes):
    """Mirror image in the plane of the rotor: it thrusts the other way."""
    return nodes.at[..., 2].multiply(-1.0)


@pytest.mark.parametrize("viscous", [pytest.param(False, marks=pytest.mark.slow), True])
def test_without_incidence_it_is_the_steady_solution(rotor, viscous):
    for speed in (8.0, 0.0):
        case = rotor(speed, viscous=viscous)
        steady, periodic_ = axial.solve(case), periodic.solve(case)
        assert periodic_.converged
        for name in ("thrust", "torque", "induced_velocity"):
            np.testing.assert_allclose(
                getattr(periodic_, name), getattr(steady, name), rtol=1e-9, err_msg=name
            )
        every = np.broadcast_to(steady.circulation, periodic_.circulation.shape)
        np.testing.assert_allclose(periodic_.circulation, every, rtol=1e-8)
        np.testing.assert_allclose(periodic_.hub_force[:2], 0.0, atol=1e-9)


def test_thrust_is_that_of_glauerts_momentum_theory(rotor, slow_flyer):
    loads = periodic.solve(rotor(8.0, 70.0))
    w, area = float(loads.induced_velocity), np.pi * slow_flyer.radius**2
    resultant = np.hypot(8.0 * np.sin(np.radians(70.0)), 8.0 * np.cos(np.radians(70.0)) + w)
    assert loads.converged
    assert float(loads.thrust) == pytest.approx(2 * 1.225 * area * w * resultant, rel=1e-3)


def test_the_advancing_side_carries_more(rotor):
    # The rotor flies along +x and turns from +x to +y: it advances at an azimuth of 270 deg.
    loads = periodic.solve(rotor(8.0, 90.0))
    thrust = np.asarray(loads.blade_force[:, 2])
    assert thrust[[5, 6, 7]].mean() > 1.5 * thrust[[1, 2, 3]].mean()
    # More lift there rolls the rotor to the other side, to which blades retreat: +y is up.
    assert loads.hub_moment[0] < 0.0


def test_flight_the_other_way_turns_the_loads_by_half_a_turn(rotor):
    ahead, back = (periodic.solve(rotor(8.0, angle)) for angle in (70.0, -70.0))
    np.testing.assert_allclose(back.thrust, ahead.thrust, rtol=1e-9)
    np.testing.assert_allclose(back.torque, ahead.torque, rtol=1e-9)
    turned = np.array([-1.0, -1.0, 1.0])
    np.testing.assert_allclose(back.hub_force, turned * ahead.hub_force, rtol=1e-7, atol=1e-9)
    np.testing.assert_allclose(back.hub_moment, turned * ahead.hub_moment, rtol=1e-7, atol=1e-9)
    half = np.roll(ahead.circulation, N // 2, axis=0)
    np.testing.assert_allclose(back.circulation, half, rtol=1e-7)


@pytest.mark.parametrize("incidence_deg", [60.0, 90.0])
def test_mirrored_rotor_has_mirrored_loads(rotor, slow_flyer, incidence_deg):
    nodes = slow_flyer.nodes(NC, NS)
    loads = periodic.solve(rotor(8.0, incidence_deg))
    image = periodic.solve(rotor(8.0, 180.0 - incidence_deg, nodes=flipped(nodes)))
    assert loads.converged and image.converged
    np.testing.assert_allclose(image.thrust, -loads.thrust, rtol=1e-9)
    np.testing.assert_allclose(image.torque, loads.torque, rtol=1e-9)
    np.testing.assert_allclose(image.induced_velocity, -loads.induced_velocity, rtol=1e-8)
    np.testing.assert_allclose(image.hub_force[:2], loads.hub_force[:2], rtol=1e-7)


def test_points_add_up_to_the_hub_loads(rotor):
    loads = periodic.solve(rotor(8.0, 70.0))
    on_fluid = loads.point_loads
    assert on_fluid.force.shape[0] == N
    np.testing.assert_allclose(
        -2 * on_fluid.force[..., 2].sum(axis=1).mean(), loads.thrust, rtol=1e-12
    )
    moment = jnp.cross(on_fluid.position, on_fluid.force)[..., 2].sum(axis=1).mean()
    np.testing.assert_allclose(2 * moment, loads.torque, rtol=1e-12)
    np.testing.assert_allclose(loads.hub_force[2], loads.thrust, rtol=1e-12)
    np.testing.assert_allclose(2 * loads.strip_thrust.sum(), loads.thrust, rtol=1e-12)
    np.testing.assert_allclose(2 * loads.strip_torque.sum(), loads.torque, rtol=1e-12)
    np.testing.assert_allclose(2 * loads.blade_force.mean(axis=0), loads.hub_force, rtol=1e-12)


@pytest.mark.parametrize(("speed", "incidence_deg"), [(12.0, 90.0), (20.0, 90.0), (6.0, 110.0)])
def test_stalled_and_reversed_flow_has_a_solution(rotor, speed, incidence_deg):
    loads = periodic.solve(rotor(speed, incidence_deg, viscous=True))
    assert loads.converged, failure(loads)
    assert np.abs(loads.sections.residual).max() < 1e-9
    behind = np.asarray(loads.attached) < 0.5
    # Air comes from behind where the flight is faster than the blade turns, on the retreating side.
    expected = OMEGA * np.asarray(loads.strips.radius) < 0.9 * speed
    assert behind[N // 4].sum() >= expected.sum()
    assert not behind[3 * N // 4].any()


@pytest.mark.slow
def test_the_guess_changes_nothing_but_the_work(rotor):
    case = rotor(12.0, 90.0, viscous=True)
    poor, wild = (periodic.solve(case, thrust) for thrust in (0.1, 300.0))
    assert poor.converged and wild.converged
    for name in ("thrust", "torque", "hub_force", "circulation"):
        np.testing.assert_allclose(
            getattr(poor, name), getattr(wild, name), rtol=1e-8, atol=1e-9, err_msg=name
        )


def test_what_does_not_agree_is_named_with_its_azimuth(rotor):
    loads = periodic.solve(rotor(12.0, 90.0, viscous=True))
    wrong = loads.sections.residual.at[3, 2].set(0.4)
    loads = dataclasses.replace(
        loads,
        converged=jnp.asarray(False),
        sections=dataclasses.replace(loads.sections, residual=wrong),
    )
    place = f"r/R {float(loads.strips.r_over_R[2]):.2f}, azimuth 135 deg"
    assert failure(loads) == f"lift coefficients of lattice and polar differ by 0.4 at {place}"


def test_a_rotor_that_does_not_turn_has_no_loads(rotor):
    loads = periodic.solve(rotor(8.0, 70.0, omega=0.0))
    assert loads.thrust == 0.0 and not np.any(loads.point_loads.force) and loads.converged


@pytest.mark.parametrize(("n_blades", "found"), [(1, 10), (2, 10), (3, 12), (4, 12), (7, 14)])
def test_azimuths_are_a_multiple_of_the_blades(rotor, n_blades, found):
    case = rotor(8.0, 70.0)
    geometry = dataclasses.replace(case.rotor, n_blades=n_blades)
    case = dataclasses.replace(case, rotor=geometry, n_azimuths=10)
    assert periodic.TiltedFlow(case, None).n_azimuths == found


@pytest.mark.slow
def test_derivatives_are_those_of_the_converged_solution(rotor, slow_flyer):
    nodes = slow_flyer.nodes(NC, NS)
    direction = jnp.asarray(np.random.default_rng(3).normal(size=nodes.shape)) * 1e-4

    @jax.jit
    def outputs(step):
        case = rotor(
            12.0 + 0.3 * step, 80.0 + 2.0 * step, True, OMEGA + step, nodes + step * direction
        )
        loads = periodic.solve(case)
        blade = loads.blade_force[:, 2]
        return jnp.stack([loads.thrust, loads.torque, loads.hub_moment[0], blade[1], blade[5]])

    exact = jax.jit(lambda x: jax.jvp(outputs, (x,), (1.0,))[1])(0.0)
    reverse = jax.jit(lambda x: jax.vmap(jax.vjp(outputs, x)[1])(jnp.eye(5))[0])(0.0)
    np.testing.assert_allclose(reverse, exact, rtol=1e-9)
    h = 1e-3
    near, far = ((outputs(s * h) - outputs(-s * h)) / (2 * s * h) for s in (1, 2))
    np.testing.assert_allclose(exact, (4 * near - far) / 3, rtol=1e-6)

"""The lattice held to section polars: its inviscid limit, robustness, drag and derivatives."""

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import ViscousSections
from propmdao.aerodynamics.sections.polars.family import blade_tables
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.sections.polars.table import (
    PolarTable,
    curve_coefficients,
    section_curves,
)
from propmdao.aerodynamics.solutions import axial
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.solutions.result import failure
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import (
    lattice_interpolation,
    lattice_nodes,
    strip_interpolation,
)
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S
from propmdao.runtime.compilation import compiled

NC, NS = 4, 10
AIR = Air(density=1.2, sound_speed=340.0, dynamic_viscosity=1.8e-5)
INCOMPRESSIBLE = dataclasses.replace(AIR, sound_speed=1e9)


class Rotor:
    """A propeller of the catalogue, coarse so that the tests are quick."""

    def __init__(self, name, offset_deg=0.0):
        propeller = load_propeller(name)
        propeller = dataclasses.replace(propeller, beta_deg=propeller.beta_deg + offset_deg)
        stations, blade = propeller.r_over_R, Blade.from_propeller(propeller)
        self.radius = 0.5 * propeller.diameter
        span = lattice_interpolation(stations, NS)
        self.nodes = lattice_nodes(blade, span, NC)
        at = strip_interpolation(stations, NS)
        self.table = blade_tables(polars_for(propeller), blade, at)

    def case(self, rotation_speed, speed, sections=None, air=AIR):
        state = RotorState(rotation_speed, float(speed), air)
        return RotorCase(RotorGeometry(self.nodes, self.radius, 2), state, sections)

    def solve(self, rpm, speed, table=None, delay=1.0, **others):
        sections = ViscousSections(table or self.table, delay)
        return axial.solve(self.case(rpm * RAD_PER_S, speed, sections), **others)


@pytest.fixture(scope="module")
def slow_flyer():
    return Rotor("apcsf_11x4.7_uiuc")


@pytest.fixture(scope="module")
def thin_electric():
    return Rotor("apce_10x7_uiuc")


def thin_airfoils(rotor, drag=1e-12):
    """Polars of thin-airfoil theory within +-40 deg, from the angles that the lattice has."""
    inviscid = axial.solve(rotor.case(400.0, 8.0))
    alpha = rotor.table.alpha
    cl = 2.0 * jnp.pi * (alpha - inviscid.strips.zero_lift_angle[:, None])
    values = jnp.stack([cl, jnp.full_like(cl, np.log(drag)), 0.0 * cl], axis=1)[:, :, None, :]
    return PolarTable(alpha, rotor.table.log_re[:2], jnp.repeat(values, 2, axis=2))


@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_polars_of_thin_airfoil_theory_are_the_inviscid_lattice(slow_flyer, speed):
    # Incompressible, and without the delay of a stall that there is not.
    sections = ViscousSections(thin_airfoils(slow_flyer), 0.0)
    held = axial.solve(slow_flyer.case(400.0, speed, sections, INCOMPRESSIBLE))
    free = axial.solve(slow_flyer.case(400.0, speed))
    np.testing.assert_allclose(held.circulation, free.circulation, rtol=1e-9)
    assert float(held.torque) == pytest.approx(float(free.torque), rel=1e-9)


def test_profile_drag_of_thin_airfoils_is_the_integral_over_the_blade(slow_flyer):
    cd = 0.02
    sections = ViscousSections(thin_airfoils(slow_flyer, cd), 0.0)
    free = axial.solve(slow_flyer.case(400.0, 8.0))
    held = axial.solve(slow_flyer.case(400.0, 8.0, sections, INCOMPRESSIBLE))
    s, climb = held.strips, 8.0 + float(held.induced_velocity)
    w, inflow = np.hypot(400.0 * s.radius, climb), np.arctan2(climb, 400.0 * s.radius)
    drag = 0.5 * 1.2 * w**2 * s.chord * s.width * cd
    torque = 2.0 * float((drag * np.cos(inflow) * s.radius).sum())
    assert float(held.torque - free.torque) == pytest.approx(torque, rel=0.03)
    assert float(held.thrust) < float(free.thrust)


@pytest.mark.parametrize("rpm", [1700.0, 4000.0, 6500.0])
@pytest.mark.parametrize("advance_ratio", [0.0, 0.2, 0.5, 0.7, 1.0])
@pytest.mark.parametrize("delay", [0.0, 1.0])
def test_it_settles_from_hover_to_the_windmill(
    slow_flyer, thin_electric, rpm, advance_ratio, delay
):
    for rotor in (slow_flyer, thin_electric):
        speed = advance_ratio * rpm / 60.0 * 2.0 * rotor.radius
        solution = rotor.solve(rpm, speed, delay=delay)
        assert solution.converged, failure(solution)
        assert np.abs(solution.sections.residual).max() < 1e-9


@pytest.mark.parametrize("offset", [-12.0, 15.0, 30.0])
def test_it_settles_with_all_of_the_blade_stalled(offset):
    rotor = Rotor("apcsf_11x4.7_uiuc", offset)
    for speed in (0.0, 6.0):
        solution = rotor.solve(4000.0, speed)
        assert solution.converged, failure(solution)


def test_lift_of_the_strips_is_that_of_their_polars_where_these_are_straight(slow_flyer):
    # Attached flow at a moderate angle: the mean over the span changes little.
    solution = slow_flyer.solve(5000.0, 4.0, delay=0.0)
    states, strips = solution.sections, solution.strips
    re = 1.2 * states.relative_speed * strips.chord / 1.8e-5
    curves = section_curves(slow_flyer.table, re, states.relative_speed / 340.0)
    cl, cd, _ = curve_coefficients(curves, states.angle_of_attack)
    outer = slice(4, 9)
    np.testing.assert_allclose(states.lift_coefficient[outer], cl[outer], atol=0.05)
    # The loads are those on a straight line between the last two trials of the search.
    np.testing.assert_allclose(states.drag_coefficient, cd, rtol=1e-9)


@pytest.mark.parametrize("guess", [0.0, 0.3, 3.0, 12.0])
def test_one_answer_from_any_start(thin_electric, guess):
    # Hover of a steep blade: half of it is stalled.
    plain = thin_electric.solve(5000.0, 0.0)
    guessed = thin_electric.solve(5000.0, 0.0, thrust_guess=guess)
    assert float(guessed.thrust) == pytest.approx(float(plain.thrust), rel=1e-7)
    assert float(guessed.torque) == pytest.approx(float(plain.torque), rel=1e-7)


def test_points_and_strips_add_up_with_drag(slow_flyer):
    solution = slow_flyer.solve(4000.0, 5.0)
    on_fluid = solution.point_loads
    moment = jnp.cross(on_fluid.position, on_fluid.force)[:, 2].sum()
    np.testing.assert_allclose(2 * solution.strip_thrust.sum(), solution.thrust, rtol=1e-12)
    np.testing.assert_allclose(2 * solution.strip_torque.sum(), solution.torque, rtol=1e-12)
    np.testing.assert_allclose(2 * moment, solution.torque, rtol=1e-12)
    drag = on_fluid.force[-NS:]
    # Drag drags the air along with the blade: toward +y, and down where the blade moves up.
    assert (drag[:, 1] > 0.0).all()


def test_thrust_grows_with_the_reynolds_number(slow_flyer):
    coefficient = [float(slow_flyer.solve(rpm, 0.0).thrust) / rpm**2 for rpm in (1700.0, 6000.0)]
    assert coefficient[1] > 1.02 * coefficient[0]


@pytest.fixture(scope="module")
def outputs(slow_flyer):
    """Thrust, torque and induced velocity along a direction in all arguments at once."""
    rng = np.random.default_rng(5)
    direction = jnp.asarray(rng.normal(size=slow_flyer.nodes.shape)) * 1e-5
    change = jnp.asarray(rng.normal(size=slow_flyer.table.values.shape)) * 1e-3

    def outputs(step, speed):
        values = slow_flyer.table.values + step * change
        table = dataclasses.replace(slow_flyer.table, values=values)
        air = dataclasses.replace(AIR, density=1.2 + 0.01 * step, sound_speed=340.0 + step)
        case = RotorCase(
            RotorGeometry(slow_flyer.nodes + step * direction, slow_flyer.radius, 2),
            RotorState(420.0 + step, speed + 0.1 * step, air),
            ViscousSections(table, 1.0),
        )
        solution = axial.solve(case)
        return jnp.stack([solution.thrust, solution.torque, solution.induced_velocity])

    return outputs


@pytest.fixture(scope="module")
def forward(outputs):
    """Outputs at a step and a flight speed, and their derivatives along the step."""

    def forward(step, speed):
        return jax.jvp(lambda s: outputs(s, speed), (step,), (jnp.ones_like(step),))

    return compiled(forward, optimisation=0)


@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_derivatives_are_those_of_the_converged_solution(forward, speed):
    h = 1e-3
    central = (forward(h, speed)[0] - forward(-h, speed)[0]) / (2 * h)
    # Differences see the piecewise cubic polars' third derivative.
    np.testing.assert_allclose(forward(0.0, speed)[1], central, rtol=5e-6)


@pytest.mark.slow
def test_derivatives_are_the_same_backwards(outputs, forward):
    reverse = jax.jit(jax.vmap(jax.vjp(lambda s: outputs(s, 8.0), 0.0)[1]))(jnp.eye(3))[0]
    np.testing.assert_allclose(reverse, forward(0.0, 8.0)[1], rtol=1e-9)


def test_a_polar_that_cannot_be_met_says_so(slow_flyer):
    table = slow_flyer.table
    broken = dataclasses.replace(table, values=table.values.at[5, 0].set(jnp.nan))
    solution = slow_flyer.solve(4000.0, 5.0, table=broken)
    assert not solution.converged
    assert "polar" in failure(solution)

"""Blade elements at an incidence: axial flight, momentum, Pitt and Peters' inflow, derivatives."""

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import propmdao as pm
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import blade_element
from propmdao.aerodynamics.solutions.period import tilted_elements
from propmdao.geometry.lattice import strip_interpolation
from propmdao.runtime.compilation import compiled

OMEGA, DENSITY, RADIUS = 440.0, 1.225, 0.1397
N_SPANWISE, N_AZIMUTHS = 5, 12


@pytest.fixture(scope="module")
def at(slow_flyer):
    """``at(speed, incidence_deg)``: the slow flyer held to its polars, in a state."""
    propeller = pm.load_propeller("apcsf_11x4.7_uiuc")
    middle = strip_interpolation(propeller.r_over_R, N_SPANWISE)
    sections = viscous_sections(polars_for(propeller), slow_flyer.blade, middle)
    case = slow_flyer.case(OMEGA, 0.0, nodes=slow_flyer.nodes(3, N_SPANWISE))
    case = dataclasses.replace(case, sections=sections, n_azimuths=N_AZIMUTHS)

    def at(speed, incidence_deg):
        incidence = np.radians(incidence_deg)
        state = dataclasses.replace(case.state, speed=speed, incidence=incidence)
        return dataclasses.replace(case, state=state)

    return at


@pytest.mark.parametrize("speed", [0.0, 8.0, 18.0])
def test_axial_flight_is_that_of_the_annuli(at, speed):
    """To rounding: hover, flight, and a windmill."""
    tilted, axial = tilted_elements.solve(at(speed, 0.0)), blade_element.solve(at(speed, 0.0))
    for name in ("thrust", "torque", "strip_thrust", "strip_torque", "induced_velocity"):
        expected = getattr(axial, name)
        assert_allclose(getattr(tilted, name), expected, rtol=1e-11, atol=1e-12, err_msg=name)
    assert_allclose(tilted.hub_moment[:2], 0.0, atol=1e-12)
    assert_allclose(tilted.sections.angle_of_attack, [axial.sections.angle_of_attack] * N_AZIMUTHS)
    assert bool(tilted.converged)


@partial(compiled, optimisation=0)
def momentum_of(case):
    """Thrust, inflow, and radius, width and tip loss of the annuli."""
    flow = tilted_elements.flow_at(case)
    thrust, inflow = tilted_elements.evaluate(flow, 0.0, OMEGA)
    r, (u, v) = flow.strips.radius, OMEGA * RADIUS * jnp.stack(jnp.split(inflow[:-3], 2))
    loss = blade_element.loss_at(flow, jnp.arctan2(case.state.axial_speed + u, OMEGA * r - v))
    return thrust, inflow, (r, flow.outer - flow.inner, loss)


@pytest.mark.parametrize(("speed", "incidence_deg"), [(6.0, 30.0), (10.0, 70.0), (14.0, 90.0)])
def test_annuli_and_the_disk_keep_their_momentum(at, speed, incidence_deg):
    """The thrust is Glauert's of the annuli; the harmonics of the inflow are Pitt and Peters'."""
    case = at(speed, incidence_deg)
    thrust, inflow, annuli = momentum_of(case)
    loads, tip_speed = tilted_elements.solve(case), OMEGA * RADIUS
    assert bool(loads.converged)
    assert_allclose(float(thrust), float(loads.thrust), rtol=1e-12)
    u, v = (tip_speed * np.asarray(part) for part in np.split(np.asarray(inflow[:-3]), 2))
    r, dr, loss = (np.asarray(q) for q in annuli)
    edgewise = speed * np.sin(np.radians(incidence_deg))
    axial = speed * np.cos(np.radians(incidence_deg))
    flux = 4.0 * np.pi * DENSITY * r * dr * loss * np.hypot(axial + u, edgewise)
    assert_allclose(2.0 * loads.strip_thrust, flux * u, rtol=1e-3, atol=1e-4)
    assert_allclose(2.0 * loads.strip_torque, flux * v * r, rtol=1e-3, atol=1e-5)

    l_1, l_c, l_s = np.asarray(inflow[-3:])
    psi = 2.0 * np.pi * np.arange(N_AZIMUTHS)[:, None] / N_AZIMUTHS + np.pi  # from downstream
    lift = -2.0 * np.asarray(loads.point_loads.force)[..., 2]
    unit = DENSITY * np.pi * RADIUS**2 * tip_speed**2
    c_t = lift.sum(axis=1).mean() / unit
    c_c, c_s = (
        (lift * r * wave(psi)).sum(axis=1).mean() / (unit * RADIUS) for wave in (np.cos, np.sin)
    )
    w, mu = float(loads.induced_velocity) / tip_speed, edgewise / tip_speed
    through = axial / tip_speed + w
    total, chi = np.hypot(mu, through), np.arctan2(mu, through)
    mass = (mu**2 + through * (through + w)) / total
    x = 15.0 * np.pi / 64.0 * np.tan(0.5 * chi)
    assert_allclose(l_1, -x * c_c / mass, rtol=1e-7, atol=1e-10)
    assert_allclose(l_s, 4.0 * c_s / mass / (1.0 + np.cos(chi)), rtol=1e-7)
    expected = x * c_t / total + 4.0 * np.cos(chi) * c_c / mass / (1.0 + np.cos(chi))
    assert_allclose(l_c, expected, rtol=1e-7)
    # More air goes down behind the hub and where the blade advances, which carries more.
    assert l_c > 0.0 < l_s and float(loads.hub_moment[0]) < 0.0


@pytest.fixture(scope="module")
def responses(at):
    """Thrust, torque and a moment by rotation, speed, incidence and nodes, at 9 m/s and 60 deg."""
    case = at(9.0, 60.0)
    direction = jnp.asarray(np.random.default_rng(3).standard_normal(case.rotor.nodes.shape))

    def responses(x):
        nodes = case.rotor.nodes + 1e-3 * x[3] * direction
        rotor = dataclasses.replace(case.rotor, nodes=nodes)
        state = dataclasses.replace(
            case.state, rotation_speed=OMEGA + x[0], speed=9.0 + x[1],
            incidence=case.state.incidence + x[2],
        )  # fmt: skip
        loads = tilted_elements.solve(dataclasses.replace(case, rotor=rotor, state=state))
        return jnp.stack([loads.thrust, 60.0 * loads.torque, 60.0 * loads.hub_moment[0]])

    return responses


@pytest.fixture(scope="module")
def forward(responses):
    """Responses and their derivatives along `WAY`."""
    return compiled(lambda x: jax.jvp(responses, (x,), (WAY,)), optimisation=0)


WAY = jnp.asarray([0.7, -0.4, 0.05, 1.1])


def test_derivatives_are_those_of_differences(forward):
    step = 1e-5
    ends = [forward(sign * step * WAY)[0] for sign in (1.0, -1.0)]
    differences = (ends[0] - ends[1]) / (2.0 * step)
    assert_allclose(forward(jnp.zeros(4))[1], differences, rtol=1e-6, atol=1e-9)


@pytest.mark.slow
def test_derivatives_back_are_those_forward(responses, forward):
    weights = jnp.asarray([1.0, -0.5, 2.0])
    gradient = jax.jit(jax.grad(lambda x: weights @ responses(x)))(jnp.zeros(4))
    # By speed and incidence they agree to rounding, by rotation speed and nodes to 1e-9 of the sum.
    assert_allclose(gradient @ WAY, weights @ forward(jnp.zeros(4))[1], rtol=1e-8)

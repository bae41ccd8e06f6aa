"""Blade elements in annuli: closed forms, momentum, derivatives, and the lattice beside them."""

import dataclasses
from functools import partial

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from numpy.testing import assert_allclose

import propmdao as pm
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.sections.polars.propeller_polars import polars_for
from propmdao.aerodynamics.solutions import axial, blade_element
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.aerodynamics.trim import Bounds, solve_for_thrust
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.runtime.compilation import compiled

OMEGA, DENSITY = 440.0, 1.225
N_SPANWISE = 6


def flat_blade(radii, chord, blade_angle):
    """Lattice of a blade of flat plates, feathering about the quarter chord, (2, n, 3) [m]."""
    angle = np.broadcast_to(blade_angle, radii.shape)
    edges = []
    for share in (-0.25, 0.75):  # leading edge ahead in the sense of rotation, and above
        y, z = -share * chord * np.cos(angle), -share * chord * np.sin(angle)
        edges.append(np.stack([radii, np.broadcast_to(y, radii.shape), z], axis=1))
    return jnp.asarray(edges)


def viscous(slow_flyer, speed, **changes):
    """The slow flyer held to its polars."""
    propeller = pm.load_propeller("apcsf_11x4.7_uiuc")
    middle = strip_interpolation(propeller.r_over_R, N_SPANWISE)
    sections = viscous_sections(polars_for(propeller), slow_flyer.blade, middle)
    case = slow_flyer.case(OMEGA, speed, nodes=slow_flyer.nodes(4, N_SPANWISE))
    return dataclasses.replace(case, sections=sections, **changes)


def test_ideal_twist_in_hover_has_the_closed_form():
    """Uniform inflow of ideal twist, lambda = (s/16) (sqrt(1 + 32 theta/s) - 1), s = sigma 2 pi.

    Leishman, Principles of Helicopter Aerodynamics (2006), eq. 3.61 with theta r = theta_tip. It
    holds for small angles, and for so many blades that nothing is lost at the tip.
    """
    radius, n_blades, tip_angle = 1.0, 1000, np.radians(2.0)
    radii = np.linspace(0.3, 1.0, 41)
    solidity = 0.05
    chord = solidity * np.pi * radius / n_blades
    nodes = flat_blade(radii, chord, tip_angle / radii)
    state = RotorState(100.0, 0.0, Air(density=DENSITY))
    loads = blade_element.solve(RotorCase(RotorGeometry(nodes, radius, n_blades), state))
    slope = 2.0 * np.pi * solidity
    inflow = slope / 16.0 * (np.sqrt(1.0 + 32.0 * tip_angle / slope) - 1.0)
    r, dr = np.asarray(loads.strips.r_over_R), np.diff(radii)
    expected = 4.0 * np.pi * DENSITY * (100.0 * inflow) ** 2 * r * dr / n_blades
    inside = slice(2, -3)  # a thousand blades lose lift at the very ends, too
    assert_allclose(loads.strip_thrust[inside], expected[inside], rtol=5e-3)


@partial(compiled, optimisation=0)
def annuli_of(case):
    """Inflow angle, radius, width and edges of the annuli."""
    flow = blade_element.flow_at(case)
    ends = flow.inner[0], flow.outer[-1]
    return blade_element.inflow_angles(flow), flow.strips.radius, flow.outer - flow.inner, ends


@pytest.mark.parametrize("speed", [0.0, 8.0, 16.0])
def test_annuli_keep_their_momentum(slow_flyer, speed):
    """Thrust and torque are the momentum and the swirl that the air of the annuli takes up."""
    case = viscous(slow_flyer, speed)
    phi, r, dr, (root, tip) = jax.tree.map(np.asarray, annuli_of(case))
    loads = jax.tree.map(np.asarray, blade_element.solve(case))
    w = loads.sections.relative_speed  # no sweep: the air lies in the plane of the sections
    sine = np.abs(np.sin(phi))
    loss = (2.0 / np.pi) ** 2 * (
        np.arccos(np.exp(-(tip - r) / (r * sine))) * np.arccos(np.exp(-(r - root) / (root * sine)))
    )
    flux = 4.0 * np.pi * DENSITY * loss * r * dr * w * sine
    assert_allclose(2.0 * loads.strip_thrust, flux * (w * np.sin(phi) - speed), rtol=2e-3)
    swirl = OMEGA * r - w * np.cos(phi)
    assert_allclose(2.0 * loads.strip_torque, flux * swirl * r, rtol=2e-3, atol=2e-5)
    assert bool(loads.converged)
    assert float(np.abs(loads.sections.residual).max()) < 1e-9


def test_thrust_falls_evenly_from_hover_to_windmill(slow_flyer):
    """One root all the way: no jump, no kink, converged wherever momentum theory holds."""
    speeds = jnp.linspace(0.0, 24.0, 49)
    case = viscous(slow_flyer, 0.0)

    def at(speed):
        loads = blade_element.solve(
            dataclasses.replace(case, state=dataclasses.replace(case.state, speed=speed))
        )
        return loads.thrust, loads.converged

    thrust, converged = jax.vmap(at)(speeds)
    assert np.all(np.diff(thrust) < 0.0)
    assert float(thrust[0]) > 0.0 > float(thrust[-1])
    assert bool(converged.all())
    assert np.abs(np.diff(thrust, n=2)).max() < 0.02 * float(thrust[0])


@pytest.fixture(scope="module")
def responses(slow_flyer):
    """Thrust, torque and an angle by speed, rotation and nodes."""
    case = viscous(slow_flyer, 8.0)
    direction = jnp.asarray(np.random.default_rng(3).standard_normal(case.rotor.nodes.shape))

    def responses(x):
        nodes = case.rotor.nodes + 1e-3 * x[2] * direction
        rotor = dataclasses.replace(case.rotor, nodes=nodes)
        state = dataclasses.replace(case.state, rotation_speed=OMEGA + x[0], speed=8.0 + x[1])
        loads = blade_element.solve(dataclasses.replace(case, rotor=rotor, state=state))
        return jnp.stack([loads.thrust, loads.torque, loads.sections.angle_of_attack[3]])

    return responses


WAY, WEIGHTS = np.array([0.7, -0.4, 1.1]), np.array([1.0, 60.0, 30.0])  # of numbers of one size


@pytest.fixture(scope="module")
def with_rows(responses):
    """Responses and the derivatives of each."""

    def with_rows(x):
        values, back = jax.vjp(responses, x)
        return values, jax.vmap(back)(jnp.eye(3))[0]

    return compiled(with_rows, optimisation=0)


def test_derivatives_are_those_of_differences(with_rows):
    step = 1e-5
    ends = [with_rows(sign * step * WAY)[0] for sign in (1.0, -1.0)]
    differences = (ends[0] - ends[1]) / (2.0 * step)
    assert_allclose(with_rows(np.zeros(3))[1] @ WAY, differences, rtol=1e-6, atol=1e-9)


@pytest.mark.slow
def test_derivatives_forward_are_the_same(responses, with_rows):
    forward = jax.jit(lambda x: jax.jvp(responses, (x,), (jnp.asarray(WAY),))[1])(jnp.zeros(3))
    along = with_rows(np.zeros(3))[1] @ WAY
    assert_allclose(WEIGHTS @ along, WEIGHTS @ forward, rtol=1e-9)


def test_trimmed(slow_flyer):
    """The rotation speed for a thrust gives it, and its derivative is that of the root."""
    case = viscous(slow_flyer, 8.0)
    thrust = float(blade_element.solve(case).thrust)
    trimmed = solve_for_thrust(blade_element, case, thrust, Bounds(200.0, 900.0))
    assert_allclose(float(trimmed.rotation_speed), OMEGA, rtol=1e-8)
    assert_allclose(float(trimmed.loads.thrust), thrust, rtol=1e-8)


def test_inviscid_slender_blades_are_those_of_the_lattice():
    """Where the chord is small, elements and lattice agree; on wide blades they do not."""
    radii, radius = np.linspace(0.15, 1.0, 17), 1.0
    state = RotorState(100.0, 8.0, Air(density=DENSITY))
    ratios = []
    for chord in (0.02, 0.08, 0.2):
        nodes = flat_blade(radii, chord, np.arctan(0.18 / radii))
        case = RotorCase(RotorGeometry(nodes, radius, 2), state)
        thrust, lattice = (float(s.solve(case).thrust) for s in (blade_element, axial))
        ratios.append(thrust / lattice)
    assert_allclose(ratios[0], 1.0, atol=0.03)
    assert np.all(np.diff(ratios) > 0.0)
    assert ratios[-1] < 1.25


def test_at_rest_there_are_no_loads(slow_flyer):
    loads = blade_element.solve(slow_flyer.case(0.0, 8.0))
    assert float(loads.thrust) == float(loads.torque) == 0.0
    assert bool(loads.converged)

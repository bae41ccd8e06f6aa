"""Aerodynamics at a rotation speed or a thrust: values of the physics, derivatives, failures."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.sections.laws import viscous_sections
from propmdao.aerodynamics.solutions.axial import solve
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.components import AerodynamicsComp, RotationSpeedComp, TrimmedAerodynamicsComp
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import strip_interpolation
from propmdao.records.air import Air
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

DIAMETER = 0.2794


@pytest.fixture(scope="module")
def nodes(meshes):
    return meshes.get_val("lattice_nodes")


@pytest.fixture(scope="module")
def rotor(small):
    return {"n_blades": 2, "fidelity": small}


@pytest.fixture(scope="module")
def problem(nodes, problem_of):
    """Problem of a component with the small blade, at 8 m/s, and the given values."""
    blade = {"lattice_nodes": nodes, "diameter": DIAMETER, "speed": 8.0}
    return lambda comp, **values: problem_of(comp, **(blade | values))


def case_of(nodes, rpm, sections=None):
    """The small blade at 8 m/s as the solvers take it."""
    state = RotorState(float(rpm) * RAD_PER_S, 8.0, Air())
    return RotorCase(RotorGeometry(nodes, DIAMETER / 2, 2), state, sections)


# --- aerodynamics -------------------------------------------------------------------------------


def test_values_are_those_of_the_steady_lattice(nodes, problem, rotor):
    prob = problem(AerodynamicsComp(**rotor), rpm=4200.0)
    prob.run_model()
    omega = 4200.0 * RAD_PER_S
    solution = solve(case_of(nodes, 4200.0))
    thrust, torque = float(solution.thrust), float(solution.torque)
    assert thrust > 0.5
    assert_allclose(prob.get_val("thrust"), thrust, rtol=1e-12)
    assert_allclose(prob.get_val("torque"), torque, rtol=1e-12)
    assert_allclose(prob.get_val("shaft_power"), torque * omega, rtol=1e-12)
    assert_allclose(prob.get_val("efficiency"), thrust * 8.0 / (torque * omega), rtol=1e-12)
    assert_allclose(prob.get_val("J"), 8.0 / (70.0 * 0.2794), rtol=1e-12)
    assert_allclose(prob.get_val("CT"), thrust / (1.225 * 70.0**2 * 0.2794**4), rtol=1e-12)
    assert_allclose(prob.get_val("CP"), 2.0 * np.pi * prob.get_val("CQ"), rtol=1e-12)
    # the fluid gets what the blade does not: -1/2 of the thrust from each of two blades
    assert_allclose(prob.get_val("load_force").sum(axis=0)[2], -thrust / 2, rtol=1e-12)
    assert prob.get_val("circulation").shape == (2, 4)


@pytest.fixture(scope="module")
def viscous(meshes, problem, rotor, polars):
    """Problem with an `AerodynamicsComp` held to polars, at 4200 rpm."""

    def viscous(speed, **options):
        prob = problem(
            AerodynamicsComp(**{**rotor, **options}, polars=polars),
            section_polars=meshes.get_val("section_polars"),
            section_thickness_over_chord=meshes.get_val("section_thickness_over_chord"),
            rpm=4200.0,
            speed=speed,
        )
        prob.run_model()
        return prob

    return viscous


def test_viscous_values_are_those_of_the_steady_lattice(viscous, nodes, propeller, polars):
    prob = viscous(8.0)
    middle = strip_interpolation(propeller.r_over_R, 4)
    sections = viscous_sections(polars, Blade.from_propeller(propeller), middle)
    solution = solve(case_of(nodes, 4200.0, sections))
    for name, value in (
        ("thrust", solution.thrust),
        ("torque", solution.torque),
        ("circulation", solution.circulation),
        ("load_force", solution.point_loads.force),
        ("section_speed", solution.sections.relative_speed),
        ("section_lift_coefficient", solution.sections.lift_coefficient),
    ):
        assert_allclose(prob.get_val(name), value, rtol=1e-9, atol=1e-9, err_msg=name)


def test_stall_delay_is_an_option(viscous):
    # in hover, where the inner sections stall; which way it goes is for the section laws to say
    with_it, without = (viscous(0.0, stall_delay=on).get_val("thrust")[0] for on in (True, False))
    assert abs(with_it / without - 1.0) > 1e-4


FORWARD = pytest.param(True, marks=pytest.mark.slow)  # compiling it takes most of the time


@pytest.mark.parametrize("forward", [False, FORWARD])
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_aerodynamic_partials(viscous, assert_directional, speed, forward):
    # Hover is the least speed, and differences on both sides of it ask for a bit of one.
    prob = viscous(max(speed, 0.2))
    # the induced velocity is good to 1e-9 of itself, its differences to some 1e-6
    assert_directional(prob, 1e-5, forward)


@pytest.mark.slow
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_inviscid_aerodynamic_partials(problem, rotor, assert_partials, speed):
    prob = problem(AerodynamicsComp(**rotor), rpm=4200.0, speed=max(speed, 0.2))
    prob.run_model()
    assert_partials(prob, 1e-5)


def test_rpm_zero_gives_zero_loads(problem, rotor):
    prob = problem(AerodynamicsComp(**rotor), rpm=0.0)
    prob.run_model()
    for name in ("thrust", "torque", "shaft_power", "efficiency", "CT", "load_force"):
        assert_allclose(prob.get_val(name), 0.0)


def test_windmill_beyond_momentum_theory_is_a_failed_analysis(problem, rotor):
    many_blades = AerodynamicsComp(**{**rotor, "n_blades": 24})
    prob = problem(many_blades, rpm=1000.0, speed=20.0)
    with pytest.raises(om.AnalysisError, match="momentum theory: .*limit, at 1000 rpm and 20 m/s"):
        prob.run_model()


# --- rotation speed -----------------------------------------------------------------------------


@pytest.fixture
def trim(problem, rotor):
    """Problem with a component that finds the rotation speed for a thrust."""

    def trim(thrust, component=TrimmedAerodynamicsComp, **options):
        return problem(component(**rotor, **options), thrust_required=thrust)

    return trim


@pytest.fixture
def viscous_trim(meshes, trim, polars):
    """Problem with the lattice held to polars at the rotation speed for a thrust."""

    def viscous_trim(thrust, **options):
        prob = trim(thrust, polars=polars, **options)
        prob.set_val("section_polars", meshes.get_val("section_polars"))
        prob.run_model()
        return prob

    return viscous_trim


def thrust_at(nodes, rpm):
    return float(solve(case_of(nodes, rpm)).thrust)


@pytest.mark.parametrize("thrust", [0.5, 1.2, 6.0])
def test_thrust_is_the_required_one(nodes, trim, thrust):
    prob = trim(thrust)
    prob.run_model()
    assert_allclose(thrust_at(nodes, prob.get_val("rpm")[0]), thrust, rtol=1e-6)
    assert_allclose(prob.get_val("thrust"), thrust, rtol=1e-6)


def test_trimmed_loads_are_those_at_the_rotation_speed_found(problem, trim, rotor):
    trimmed = trim(1.2)
    trimmed.run_model()
    rpm = trimmed.get_val("rpm")
    at_rpm = problem(AerodynamicsComp(**rotor), rpm=rpm)
    at_rpm.run_model()
    for name in at_rpm.model.comp.get_io_metadata(iotypes="output"):
        # the trim is good to 1e-8 of the rotation speed
        value = at_rpm.get_val(name)
        assert_allclose(
            trimmed.get_val(name), value, rtol=1e-6, atol=1e-7 * np.abs(value).max(), err_msg=name
        )


@pytest.mark.parametrize("forward", [False, FORWARD])
def test_trimmed_partials(viscous_trim, assert_directional, forward):
    assert_directional(viscous_trim(1.2), 1e-5, forward)


def test_derivatives_belong_to_the_inputs_they_are_asked_for(viscous_trim):
    """What is kept of one point is not taken for another, nor for the same after another."""
    prob = viscous_trim(1.2)
    totals = {}
    for thrust in (1.2, 2.4, 1.2):
        prob.set_val("thrust_required", thrust)
        prob.run_model()
        (value,) = prob.compute_totals(of=["torque"], wrt=["speed"]).values()
        totals.setdefault(thrust, []).append(value)
    assert_allclose(totals[1.2][1], totals[1.2][0], rtol=1e-12)
    assert np.abs(totals[2.4][0] / totals[1.2][0] - 1.0) > 0.1
    # also where the model has not run at the inputs that the derivatives are asked for
    comp, gradient = prob.model.comp, {"speed": np.zeros(1)}
    inputs = {name: prob.get_val(name) for name in comp.get_io_metadata(iotypes="input")}
    inputs["thrust_required"] = np.array([2.4])
    comp.compute_jacvec_product(inputs, gradient, {"torque": np.ones(1)}, "rev")
    assert_allclose(gradient["speed"], totals[2.4][0].ravel(), rtol=1e-9)


@pytest.mark.slow
@pytest.mark.parametrize(
    ("component", "bounds"),
    [(TrimmedAerodynamicsComp, (2000.0, 9000.0)), (RotationSpeedComp, None)],
)
def test_inviscid_trim_partials(trim, assert_partials, component, bounds):
    """The rule of the thesis depends on its bounds, which by default follow the diameter."""
    prob = trim(1.2, component, rpm_bounds=bounds)
    prob.run_model()
    # the root is good to 1e-8 relative, so its differences over steps of 1e-3 to some 1e-5
    assert_partials(prob, 1e-4)


def test_two_point_is_the_rule_of_the_thesis_and_misses_the_thrust_a_little(nodes, trim):
    prob = trim(1.2, RotationSpeedComp, rpm_bounds=(3500.0, 5000.0))
    prob.run_model()
    rpm = prob.get_val("rpm")[0]
    low, high = (thrust_at(nodes, end) for end in (3500.0, 5000.0))
    assert_allclose(rpm, 3500.0 + 1500.0 * (1.2 - low) / (high - low), rtol=1e-6)
    # T is convex in rpm, so the chord overshoots and the thrust falls short
    assert 0.85 < thrust_at(nodes, rpm) / 1.2 < 1.0


def test_thrust_can_be_required_in_other_units(nodes, trim):
    prob = trim(1.2)
    prob.set_val("thrust_required", 1.2 / 4.4482216152605, units="lbf")
    prob.run_model()
    assert_allclose(thrust_at(nodes, prob.get_val("rpm", units="rpm")[0]), 1.2, rtol=1e-6)
    assert_allclose(prob.get_val("rpm", units="rad/s"), prob.get_val("rpm") * np.pi / 30.0)


@pytest.mark.parametrize("component", [TrimmedAerodynamicsComp, RotationSpeedComp])
def test_thrust_out_of_reach_is_a_failed_analysis_with_the_reason(trim, component):
    with pytest.raises(om.AnalysisError, match=r"thrust 500 N .* rpm"):
        trim(500.0, component).run_model()


@pytest.mark.parametrize("component", [TrimmedAerodynamicsComp, RotationSpeedComp])
def test_a_flight_too_fast_to_trim_is_a_failed_analysis(trim, component):
    """Its bounds enclose nothing, and a search between them finds nan."""
    prob = trim(1.2, component)
    prob.set_val("speed", 310.0)
    with pytest.raises(om.AnalysisError, match="speed must be below 306.265 m/s to trim; it is 31"):
        prob.run_model()


def test_derivatives_do_not_know_the_bounds_of_the_search(viscous_trim):
    totals = []
    for bounds in (None, (1000.0, 5000.0)):
        prob = viscous_trim(1.2, rpm_bounds=bounds)
        wrt = ["speed", "diameter", "thrust_required"]
        totals.append(prob.compute_totals(of=["torque"], wrt=wrt))
    for key, total in totals[0].items():
        # the roots agree to 1e-8
        assert_allclose(totals[1][key], total, rtol=1e-6, err_msg=key)


@pytest.mark.parametrize("component", [TrimmedAerodynamicsComp, RotationSpeedComp])
def test_bounds_that_are_no_bounds_are_an_error(trim, component):
    with pytest.raises(
        ValueError, match="rpm bounds must be positive and increasing; they are 5000 and 4000"
    ):
        trim(1.2, component, rpm_bounds=(5000.0, 4000.0))

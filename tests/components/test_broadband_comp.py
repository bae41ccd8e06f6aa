"""BroadbandComp: the noise of the physics, levels, derivatives, silence, a supersonic tip."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels.weighting import a_weighting
from propmdao.aerodynamics.sections.edge_layers.propeller_layers import layers_for
from propmdao.analysis.self_noise import BANDS_HZ
from propmdao.components import BroadbandComp, PropellerGroup

OBSERVERS = arc(1.9, [-45.0, -20.0])


POINTS = {
    "section_speed": np.array([[14.0, 30.0, 47.0, 59.0], [17.0, 36.0, 56.0, 70.0]]),
    "section_angle_of_attack": np.radians([[4.4, 3.4, 2.5, 1.4], [5.5, 4.6, 3.3, 2.4]]),
    "section_lift_coefficient": np.array([[0.9, 0.8, 0.7, 0.5], [1.0, 0.9, 0.8, 0.7]]),
    "rpm": np.array([4200.0, 5000.0]),
    "speed": np.array([8.0, 1.0]),
    "density": np.array([1.225, 1.1]),
    "sound_speed": np.array([340.294, 330.0]),
    "oaspl_db": np.array([[50.0, 49.0], [54.0, 55.0]]),
    "oaspl_dba": np.array([[35.0, 34.0], [39.0, 40.0]]),
}


@pytest.fixture
def problem_at(meshes, propeller, small, problem_of):
    """Problem with a `BroadbandComp` of so many nodes and the given values."""

    def problem_at(num_nodes, turbulent_inflow=False, **values):
        comp = BroadbandComp(
            propeller=propeller,
            observers=OBSERVERS,
            fidelity=small,
            num_nodes=num_nodes,
            layers=layers_for(propeller),
            turbulent_inflow=turbulent_inflow,
        )
        return problem_of(comp, lattice_nodes=meshes.get_val("lattice_nodes"), **values)

    return problem_at


@pytest.fixture
def problem(problem_at):
    sections = ("section_speed", "section_angle_of_attack", "section_lift_coefficient")
    names = (*sections, "rpm", "speed")
    return problem_at(None, **{name: POINTS[name][0] for name in names})


def level(mean_square):
    return 10.0 * np.log10(mean_square / 20e-6**2)


def test_levels_are_sums_over_the_bands(problem):
    problem.run_model()
    power = problem.get_val("broadband_mean_square_pressure")
    assert_allclose(problem.get_val("band_frequency"), BANDS_HZ)
    assert_allclose(problem.get_val("oaspl_broadband_db"), level(power.sum(axis=1)))
    weighted = level((power * a_weighting(BANDS_HZ) ** 2).sum(axis=1))
    assert_allclose(problem.get_val("oaspl_broadband_dba"), weighted)
    assert (weighted > 20.0).all()


def test_totals_are_the_noise_alone_until_tones_are_connected(problem):
    problem.run_model()
    for weighting in ("db", "dba"):
        noise = problem.get_val(f"oaspl_broadband_{weighting}").copy()
        assert_allclose(problem.get_val(f"oaspl_total_{weighting}"), noise)
        # two equal levels make 3.01 dB more, and so do two that are not correlated
        problem.set_val(f"oaspl_{weighting}", noise)
        problem.run_model()
        twice = noise + 10.0 * np.log10(2.0)
        assert_allclose(problem.get_val(f"oaspl_total_{weighting}"), twice)


def test_twice_as_far_is_six_decibels_quieter(problem):
    problem.set_val("observer_position", 20.0 * OBSERVERS)
    problem.run_model()
    near = problem.get_val("oaspl_broadband_db").copy()
    problem.set_val("observer_position", 40.0 * OBSERVERS)
    problem.run_model()
    assert_allclose(near - problem.get_val("oaspl_broadband_db"), 6.02, atol=0.05)


def test_the_fits_of_the_report_ask_for_no_layers(propeller, small, problem_of):
    comp = BroadbandComp(propeller=propeller, observers=OBSERVERS, fidelity=small)
    problem_of(comp)
    inputs = comp.get_io_metadata(iotypes="input")
    assert not {"section_layers", "section_angle_of_attack"} & set(inputs)


def test_standing_still_is_silence(problem):
    for name in ("rpm", "speed", "section_speed", "section_lift_coefficient"):
        problem.set_val(name, 0.0)
    problem.run_model()
    for name in ("oaspl_broadband_db", "oaspl_broadband_dba"):
        assert_allclose(problem.get_val(name), -200.0, atol=1e-3)


@pytest.mark.parametrize("forward", [False, pytest.param(True, marks=pytest.mark.slow)])
def test_broadband_partials(problem, assert_directional, forward):
    problem.set_val("oaspl_db", 50.0)
    problem.set_val("oaspl_dba", 35.0)
    problem.run_model()
    assert_directional(problem, 1e-6, forward)


def test_turbulence_that_flows_in(problem, problem_at):
    problem.run_model()
    calm = problem.get_val("broadband_mean_square_pressure")
    sections = ("section_speed", "section_angle_of_attack", "section_lift_coefficient")
    point = {name: POINTS[name][0] for name in (*sections, "rpm", "speed")}
    assert "turbulence_intensity" not in problem.model.comp.get_io_metadata(iotypes="input")
    windy = problem_at(None, turbulent_inflow=True, **point)
    windy.run_model()
    assert_allclose(windy.get_val("broadband_mean_square_pressure"), calm)
    windy.set_val("turbulence_intensity", 0.5, units="m/s")
    with pytest.raises(om.AnalysisError, match="turbulence_length_scale must be above 0 m"):
        windy.run_model()
    windy.set_val("turbulence_length_scale", 50.0, units="mm")
    windy.run_model()
    once = windy.get_val("broadband_mean_square_pressure") - calm
    assert np.all(once > 0.0)
    windy.set_val("turbulence_intensity", 1.0)
    windy.run_model()
    twice = windy.get_val("broadband_mean_square_pressure") - calm
    assert_allclose(twice, 4.0 * once, rtol=1e-6)


def test_a_group_hears_turbulence_as_broadband_noise_alone(propeller, small):
    group = PropellerGroup(
        propeller=propeller, observers=OBSERVERS, fidelity=small, turbulent_inflow=True
    )
    with pytest.raises(ValueError, match="turbulent_inflow is heard as broadband noise"):
        om.Problem(group, reports=False).setup()


@pytest.mark.slow
def test_partials_with_turbulence(problem_at, assert_directional):
    sections = ("section_speed", "section_angle_of_attack", "section_lift_coefficient")
    point = {name: POINTS[name][0] for name in (*sections, "rpm", "speed")}
    eddies = {"turbulence_intensity": 0.5, "turbulence_length_scale": 0.05}
    problem = problem_at(None, turbulent_inflow=True, **point, **eddies)
    problem.run_model()
    assert_directional(problem, 1e-6, False)


def test_supersonic_tip_is_a_failed_analysis(problem):
    problem.set_val("rpm", 24000.0)
    with pytest.raises(om.AnalysisError, match="relative tip Mach number must be below 1"):
        problem.run_model()


def test_each_node_is_heard_as_if_alone(problem_at):
    both = problem_at(2, **POINTS)
    both.run_model()
    outputs = set(both.model.comp.get_io_metadata(iotypes="output"))
    assert both.get_val("band_frequency").shape == BANDS_HZ.shape
    for node in range(2):
        one = problem_at(None, **{name: values[node] for name, values in POINTS.items()})
        one.run_model()
        for name in outputs - {"band_frequency"}:
            assert_allclose(both.get_val(name)[node], one.get_val(name), rtol=1e-12, err_msg=name)


def test_partials_at_nodes(problem_at, assert_directional):
    prob = problem_at(2, **POINTS)
    prob.run_model()
    assert_directional(prob, 1e-6)


def test_layers_bring_their_trips_along(propeller, small):
    options = {"propeller": propeller, "observers": OBSERVERS, "fidelity": small}
    comp = BroadbandComp(layers=layers_for(propeller), trip="heavy", **options)
    prob = om.Problem(reports=False)
    prob.model.add_subsystem("comp", comp)
    with pytest.raises(ValueError, match="trip 'heavy' is about the fits of NASA RP-1218"):
        prob.setup()
    with pytest.raises(ValueError, match="trip must be one of none, light, heavy; it is 'some'"):
        BroadbandComp(trip="some", **options)

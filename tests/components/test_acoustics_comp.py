"""AcousticsComp: the levels of the physics, their derivatives, a supersonic tip."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.acoustics.levels import decibels as levels
from propmdao.acoustics.levels.weighting import oaspl_dba
from propmdao.acoustics.sources.formulation1a import tones
from propmdao.components import AcousticsComp
from propmdao.geometry.surface import surface_panels
from propmdao.records.air import Air
from propmdao.records.loads import PointLoads
from propmdao.records.states import RotorState
from propmdao.records.units import RAD_PER_S

OBSERVERS = arc(1.9, [-45.0, 0.0])
# along the quarter-chord line of a blade that gives some 1.4 N for 0.06 N m; as many as the small
# lattice has
RADIUS = np.linspace(0.05, 0.135, 22)
POSITION = np.stack([RADIUS, -0.02 * RADIUS, 0.01 * RADIUS], axis=1)
FORCE = np.outer(RADIUS / RADIUS.sum(), [0.04, -0.3, -0.7])


@pytest.fixture
def problem_at(meshes, small, problem_of):
    """Problem with an `AcousticsComp` of so many nodes and the given values."""

    def problem_at(num_nodes, **values):
        comp = AcousticsComp(
            n_blades=2, n_loads=22, observers=OBSERVERS, fidelity=small, num_nodes=num_nodes
        )
        loads = {"load_position": POSITION, "load_force": FORCE}
        return problem_of(comp, surface_nodes=meshes.get_val("surface_nodes"), **(loads | values))

    return problem_at


@pytest.fixture
def problem(problem_at):
    return problem_at(None, rpm=6000.0, speed=8.0)


def test_levels_are_those_of_formulation_1a(problem):
    problem.run_model()
    panels = surface_panels(problem.get_val("surface_nodes"))
    state = RotorState(6000.0 * RAD_PER_S, 8.0, Air())
    sound = tones(panels, PointLoads(POSITION, FORCE), 2, state, OBSERVERS, 2)
    assert_allclose(problem.get_val("spl_bpf_db"), levels.spl_db(sound.total)[:, 0])
    assert_allclose(problem.get_val("oaspl_db"), levels.oaspl_db(sound.total))
    assert set(sound.parts) == {"thickness", "loading"}
    for name, part in sound.parts.items():
        assert_allclose(problem.get_val(f"oaspl_{name}_db"), levels.oaspl_db(part))
    assert_allclose(problem.get_val("oaspl_dba"), oaspl_dba(sound.frequency_hz, sound.total))
    assert_allclose(problem.get_val("frequency"), [200.0, 400.0])
    total = problem.get_val("mean_square_pressure").sum(axis=1)
    assert_allclose(10.0 * np.log10(total / 20e-6**2), problem.get_val("oaspl_db"))
    assert (problem.get_val("oaspl_db") > 20.0).all()


def test_acoustic_partials(problem, assert_partials):
    problem.run_model()
    assert_partials(problem, 1e-5)


def test_each_node_is_heard_as_if_alone(problem_at):
    points = [
        {"load_force": FORCE, "rpm": 6000.0, "speed": 8.0, "density": 1.2, "sound_speed": 340.0},
        {"load_force": 2 * FORCE, "rpm": 5000.0, "speed": 0.0, "density": 1.0, "sound_speed": 320},
    ]
    both = problem_at(2, **{n: np.array([point[n] for point in points]) for n in points[0]})
    both.run_model()
    for node, point in enumerate(points):
        one = problem_at(None, **point)
        one.run_model()
        for name in one.model.comp.get_io_metadata(iotypes="output"):
            assert_allclose(both.get_val(name)[node], one.get_val(name), rtol=1e-12, err_msg=name)


def test_partials_at_nodes(problem_at, assert_directional):
    prob = problem_at(2, rpm=[6000.0, 5000.0], speed=[8.0, 2.0])
    prob.run_model()
    assert_directional(prob, 1e-6, forward=True)


@pytest.mark.parametrize("num_nodes", [None, 2])
def test_standing_still_is_silence_with_finite_derivatives(problem_at, num_nodes):
    prob = problem_at(num_nodes, rpm=0.0, speed=0.0, load_force=0.0)
    prob.run_model()
    assert_allclose(prob.get_val("oaspl_db"), -200.0)
    assert_allclose(prob.get_val("mean_square_pressure"), 0.0)
    inputs = list(prob.model.comp.get_io_metadata(iotypes="input"))
    for total in prob.compute_totals(of=["oaspl_db", "oaspl_dba"], wrt=inputs).values():
        assert np.isfinite(total).all()


def test_supersonic_tip_is_a_failed_analysis(problem):
    problem.set_val("rpm", 24000.0)
    with pytest.raises(om.AnalysisError, match="relative tip Mach number must be below 1"):
        problem.run_model()


def test_observer_inside_the_rotor_is_a_failed_analysis(problem):
    problem.set_val("observer_position", 0.05 * OBSERVERS)
    with pytest.raises(om.AnalysisError, match="observer 1 is inside the source region: 0.095 m"):
        problem.run_model()


def test_observers_can_be_moved(problem):
    problem.set_val("observer_position", 20.0 * OBSERVERS)
    problem.run_model()
    near = problem.get_val("oaspl_db").copy()
    problem.set_val("observer_position", 40.0 * OBSERVERS)
    problem.run_model()
    # in the far field a doubled distance costs 6.02 dB; at 38 m, some 20 wavelengths, nearly so
    assert_allclose(near - problem.get_val("oaspl_db"), 6.02, atol=0.05)

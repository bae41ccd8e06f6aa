"""The lattice at nodes: derivatives with and without loads, what is solved anew, rest."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import AerodynamicsComp, RotationSpeedComp, TrimmedAerodynamicsComp

AIR = {
    "speed": np.array([8.0, 0.5]),
    "density": np.array([1.225, 1.1]),
    "sound_speed": np.array([340.294, 335.0]),
}
GIVEN = {
    AerodynamicsComp: {"rpm": np.array([4200.0, 4600.0])},
    TrimmedAerodynamicsComp: {"thrust_required": np.array([1.2, 2.0])},
}


@pytest.fixture
def problem(meshes, small, polars, problem_of):
    """Problem with a component of so many nodes at the given values."""

    def problem(kind, num_nodes, values, **options):
        options = {"n_blades": 2, "fidelity": small, "polars": polars, **options}
        prob = problem_of(kind(num_nodes=num_nodes, **options), **values)
        of_blade = {"lattice_nodes", "diameter", "section_polars", "section_thickness_over_chord"}
        for name in of_blade & set(prob.model.comp.get_io_metadata(iotypes="input")):
            prob.set_val(name, meshes.get_val(name))
        prob.run_model()
        return prob

    return problem


FORWARD = pytest.param(True, marks=pytest.mark.slow)  # compiling it takes most of the time


@pytest.mark.parametrize("loads", [False, FORWARD])
@pytest.mark.parametrize(
    "kind", [TrimmedAerodynamicsComp, pytest.param(AerodynamicsComp, marks=pytest.mark.slow)]
)
def test_partials_at_nodes(problem, assert_directional, kind, loads):
    """Without loads the forward products are sums over kept gradients, which compile nothing."""
    prob = problem(kind, 2, {**AIR, **GIVEN[kind]}, loads=loads)
    # the root is good to 1e-9 of itself, its differences to some 1e-6
    assert_directional(prob, 1e-5, forward=True)


@pytest.mark.slow  # derivatives of the search compile for long
def test_what_a_call_has_searched_for_is_known_to_derivatives(problem, monkeypatch):
    """By blade elements, which compile soonest: the same derivatives, and no search but the call's.

    A node that has not changed takes no part in a further call.
    """
    kind = TrimmedAerodynamicsComp
    values, options = {**AIR, **GIVEN[kind]}, {"blade_element": True, "loads": False}
    of, wrt = ["comp.rpm", "comp.torque"], ["comp.speed", "comp.thrust_required"]
    with monkeypatch.context() as one_by_one:
        one_by_one.setattr(kind, "points_in_a_call", lambda self: 1)
        alone = problem(kind, 2, values, **options).compute_totals(of, wrt)
    together = problem(kind, 2, values, **options)
    comp = together.model.comp
    assert comp.points_in_a_call() == 2
    monkeypatch.setattr(comp, "found_at", lambda _: pytest.fail("searched once more"))
    for key, expected in alone.items():
        assert_allclose(together.compute_totals(of, wrt)[key], expected, rtol=1e-6, atol=1e-12)
    asked, found = [], comp.found_at_all
    monkeypatch.setattr(
        comp, "found_at_all", lambda points, size: asked.extend(points) or found(points, size)
    )
    together.set_val("comp.speed", [8.0, 1.0])
    together.run_model()
    assert [point["speed"][0] for point in asked] == [1.0]


@pytest.mark.slow  # it compiles the lattice twice
def test_three_nodes_of_the_lattice_are_those_of_single_calls(problem):
    values = {"speed": [8.0, 4.0, 0.0], "rpm": [4200.0, 4400.0, 4600.0]}
    three = problem(AerodynamicsComp, 3, values)
    assert three.model.comp.points_in_a_call() == 3
    for node in range(3):
        one = problem(AerodynamicsComp, None, {name: value[node] for name, value in values.items()})
        for name in ("thrust", "torque", "circulation", "load_force"):
            expected = np.squeeze(one.get_val(f"comp.{name}"))
            assert_allclose(three.get_val(f"comp.{name}")[node], expected, rtol=1e-8, atol=1e-10)


@pytest.mark.parametrize("kind", [AerodynamicsComp, TrimmedAerodynamicsComp])
def test_the_lattice_is_solved_anew_only_where_a_node_changed(problem, kind, monkeypatch):
    prob = problem(kind, 2, {**AIR, **GIVEN[kind]})
    solved = []
    check = prob.model.comp.check  # of what a search has found
    monkeypatch.setattr(
        prob.model.comp, "check", lambda at, found: solved.append(at) or check(at, found)
    )
    prob.run_model()
    assert not solved
    before = prob.get_val("torque").copy()
    prob.set_val("speed", [8.0, 1.0])
    prob.run_model()
    assert [at["speed"][0] for at in solved] == [1.0]
    assert prob.get_val("torque")[0] == before[0]
    assert prob.get_val("torque")[1] != before[1]


def test_two_point_rule_at_nodes(problem):
    thrust = np.array([1.2, 0.0, 2.0])
    kind, inviscid = RotationSpeedComp, {"polars": None}
    three = problem(kind, 3, {"thrust_required": thrust, "speed": 8.0}, **inviscid)
    assert three.get_val("rpm")[1] == 0.0
    for node in (0, 2):
        one = problem(kind, None, {"thrust_required": thrust[node], "speed": 8.0}, **inviscid)
        assert_allclose(three.get_val("rpm")[node], one.get_val("rpm")[0], rtol=1e-12)
    with pytest.raises(om.AnalysisError, match="node 1: thrust 500 N needs .* rpm"):
        problem(kind, 2, {"thrust_required": [1.2, 500.0]}, **inviscid)

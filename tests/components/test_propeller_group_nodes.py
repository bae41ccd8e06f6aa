"""PropellerGroup at several operating points: values, shapes, rest, failures, derivatives."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.components import PropellerGroup

OBSERVERS = arc(1.905, [-45.0, 0.0])
POINTS = {
    "speed": np.array([8.0, 0.5]),
    "density": np.array([1.225, 1.1]),
    "sound_speed": np.array([340.294, 335.0]),
    "thrust_required": np.array([1.2, 2.0]),
}
AT_RPM = {**POINTS, "rpm": np.array([4200.0, 4600.0])}
del AT_RPM["thrust_required"]


@pytest.fixture(scope="module")
def problem(propeller, small):
    """Problem with a `PropellerGroup` of so many nodes at the given values."""

    def problem(num_nodes, values, **options):
        options = {"propeller": propeller, "fidelity": small, **options}
        prob = om.Problem(reports=False)
        group = PropellerGroup(num_nodes=num_nodes, **options)
        prob.model.add_subsystem("propeller", group, promotes=["*"])
        prob.setup(mode="rev")
        for name, value in values.items():
            prob.set_val(name, value)
        prob.run_model()
        return prob

    return problem


def outputs(prob):
    """Outputs of the group's components by promoted name."""
    metadata = prob.model.propeller.get_io_metadata(iotypes="output")
    return {meta["prom_name"] for meta in metadata.values()}


BLADE = {
    "lattice_nodes",
    "surface_nodes",
    "section_polars",
    "section_layers",
    "section_thickness_over_chord",
    "band_frequency",
}


@pytest.mark.parametrize("trim", ["thrust", "rpm"])
def test_each_node_is_as_if_alone(problem, trim):
    values = POINTS if trim == "thrust" else AT_RPM
    options = {"trim": trim, "observers": OBSERVERS, "broadband": True}
    both = problem(2, values, **options)
    for node in range(2):
        at = {name: value[node] for name, value in values.items()}
        one = problem(None, at, **options)
        single = problem(1, at, **options)
        assert outputs(one) == outputs(both)
        for name in outputs(both) - BLADE:
            alone = one.get_val(name)
            assert_allclose(both.get_val(name)[node], np.squeeze(alone) if alone.shape == (1,) else
                            alone, rtol=1e-12, atol=1e-15, err_msg=name)  # fmt: skip
            assert single.get_val(name).shape == (1, *both.get_val(name).shape[1:])
        for name in BLADE:
            assert_allclose(both.get_val(name), one.get_val(name))


def test_without_observers_there_is_performance_alone(problem):
    heard = problem(2, POINTS, observers=OBSERVERS)
    quiet = problem(2, POINTS)
    assert not {"load_force", "oaspl_db", "circulation"} & outputs(quiet)
    wrt = ["speed", "thrust_required", "beta", "chord_over_R"]
    for name in ("rpm", "thrust", "torque", "shaft_power", "efficiency", "J", "CT", "CQ", "CP"):
        assert_allclose(quiet.get_val(name), heard.get_val(name), rtol=1e-12, err_msg=name)
        ours, theirs = (prob.compute_totals(of=[name], wrt=wrt) for prob in (quiet, heard))
        for key, expected in theirs.items():
            largest = np.abs(expected).max()
            assert_allclose(ours[key], expected, rtol=0.0, atol=1e-9 * largest + 1e-15)


def test_broadband_noise_asks_for_observers(problem):
    with pytest.raises(ValueError, match="broadband noise is heard at observers; there are none"):
        problem(None, {}, broadband=True)


@pytest.mark.parametrize("given", ["thrust_required", "rpm"])
@pytest.mark.parametrize("speed", [0.0, 8.0])
def test_a_propeller_at_rest_is_zeros_and_silence(problem, given, speed):
    values = {"speed": [speed, 8.0], given: [0.0, 1.2 if given == "thrust_required" else 4200.0]}
    trim = "rpm" if given == "rpm" else "thrust"
    prob = problem(2, values, trim=trim, observers=OBSERVERS, broadband=True)
    for name in ("rpm", "thrust", "torque", "shaft_power", "efficiency", "CT", "load_force"):
        assert_allclose(prob.get_val(name)[0], 0.0)
    for name in ("oaspl_db", "oaspl_total_dba"):
        assert_allclose(prob.get_val(name)[0], -200.0, atol=3.02)  # two silences make three more
        assert (prob.get_val(name)[1] > 20.0).all()
    totals = prob.compute_totals(
        of=["torque", "oaspl_total_dba"], wrt=["speed", given, "beta", "observer_position"]
    )
    for key, total in totals.items():
        assert np.isfinite(total).all(), key


def test_a_failing_node_is_named(problem):
    with pytest.raises(om.AnalysisError, match="node 1: thrust 500 N is out of reach at 0.5 m/s"):
        problem(2, {**POINTS, "thrust_required": [1.2, 500.0]})
    with pytest.raises(om.AnalysisError, match="node 0: relative tip Mach number must be below 1"):
        problem(2, {**AT_RPM, "rpm": [24000.0, 4000.0]}, trim="rpm", observers=OBSERVERS)


def test_derivatives_of_a_node_are_its_own(problem):
    prob = problem(2, POINTS, observers=OBSERVERS)
    of, wrt = ["torque", "oaspl_db"], ["speed", "density", "thrust_required"]
    for key, total in prob.compute_totals(of=of, wrt=wrt).items():
        total = total.reshape(2, -1, 2)
        assert (total[[0, 1], :, [0, 1]] != 0.0).all(), key
        assert (total[[0, 1], :, [1, 0]] == 0.0).all(), key


@pytest.mark.parametrize("trim", ["thrust", "rpm"])
def test_totals_against_differences(problem, trim, assert_totals, point_inputs):
    values = POINTS if trim == "thrust" else AT_RPM
    prob = problem(2, values, trim=trim, observers=OBSERVERS)
    wrt = ["diameter", "beta", "chord_over_R", "observer_position"]
    wrt += point_inputs(prob.model.propeller)
    of = ["rpm" if trim == "thrust" else "thrust", "torque", "efficiency", "oaspl_db"]
    assert_totals(prob, of, wrt)

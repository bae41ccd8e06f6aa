"""PropellerGroup: the components together, its derivatives, and optimisers on it."""

import dataclasses
import importlib
import tomllib

import jax.numpy as jnp
import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.acoustics.kinematics.observers import arc
from propmdao.analysis.single_point import analyze
from propmdao.components import DifferentialEvolutionDriver, PropellerGroup
from propmdao.propeller.catalog import propeller_file
from propmdao.propeller.checks import PropellerError
from propmdao.records.quantities import BROADBAND_LEVELS, LEVELS, RESULTS
from propmdao.records.wake_law import WakeLaw

OBSERVERS = arc(1.905, [-45.0, 0.0])


@pytest.fixture
def problem(propeller, small):
    """Problem with a `PropellerGroup` of the given options at 8 m/s and 1.2 N."""

    def problem(driver=None, **options):
        prob = om.Problem(driver=driver, reports=False)
        defaults = {"propeller": propeller, "observers": OBSERVERS, "fidelity": small}
        options = {**defaults, **options}
        prob.model.add_subsystem("propeller", PropellerGroup(**options), promotes=["*"])
        prob.model.set_input_defaults("speed", 8.0, units="m/s")
        if options.get("trim") != "rpm":
            prob.model.set_input_defaults("thrust_required", 1.2, units="N")
        return prob

    return problem


@pytest.mark.parametrize(
    ("viscous", "trip"),
    [(True, "outside"), pytest.param(True, "heavy", marks=pytest.mark.slow), (False, "none")],
)
def test_group_agrees_with_analyze(problem, propeller, small, viscous, trip):
    if trip == "outside":
        trip = tuple("light" if r > 0.6 else "none" for r in propeller.r_over_R)
    prob = problem(viscous=viscous, broadband=viscous, trip=trip)
    prob.setup()
    prob.run_model()
    assert_allclose(prob.get_val("thrust"), 1.2, rtol=1e-6)
    expected = analyze(
        propeller,
        rpm=prob.get_val("rpm").item(),
        speed=8.0,
        viscous=viscous,
        broadband=viscous,
        trip=trip,
        observers=OBSERVERS,
        fidelity=small,
    ).to_dict()
    for name in ("thrust", "torque", "shaft_power", "eta", "J", "CT", "CQ", "CP"):
        quantity = RESULTS[name]
        value = prob.get_val(quantity.variable)
        assert_allclose(value, expected[quantity.json], rtol=1e-6, err_msg=name)
    for quantity in {**LEVELS, **(BROADBAND_LEVELS if viscous else {})}.values():
        levels = [observer[quantity.json] for observer in expected["observers"]]
        assert_allclose(prob.get_val(quantity.variable), levels, atol=1e-4, err_msg=quantity.name)


def test_tripped_blades_without_broadband_noise_are_an_error(problem):
    with pytest.raises(ValueError, match="trip 'light' is about broadband noise: ask for"):
        problem(trip="light").setup()


def test_a_propeller_is_described_or_found_by_its_name_or_file(problem, propeller, tmp_path):
    file = tmp_path / "blade.toml"
    file.write_text(propeller_file("apcsf_11x4.7_uiuc").read_text("utf-8"), "utf-8")
    torque = []
    for described in (propeller, "apcsf_11x4.7_uiuc", file, str(file)):
        prob = problem(propeller=described)
        prob.setup()
        prob.run_model()
        torque.append(prob.get_val("torque")[0])
    assert torque == torque[:1] * 4


def test_a_name_that_there_is_not_is_refused_with_near_ones(problem):
    with pytest.raises(PropellerError, match="unknown propeller 'apcsf_11x4'; near: apcsf_11x4.7"):
        problem(propeller="apcsf_11x4")


def test_observers_that_are_no_positions_are_refused(problem):
    for wrong in (np.array([[1.905, -45.0]]), np.zeros(3)):
        with pytest.raises(ValueError, match=r"observers must be positions .*: propmdao.arc\("):
            problem(observers=wrong)


def test_the_law_of_the_wake_is_an_option(problem):
    """A wake that stays nearer to the blades takes more of their thrust."""
    thrust = []
    for wake in (WakeLaw(), WakeLaw(inside=1.0)):
        prob = problem(trim="rpm", wake=wake)
        prob.setup()
        prob.set_val("speed", 0.0)
        prob.run_model()
        thrust.append(prob.get_val("thrust")[0])
    assert 0.5 < thrust[1] / thrust[0] < 0.99


def test_transition_is_an_option(problem, propeller, small):
    """The air of a quiet tunnel (n_crit 9) takes lift from a blade at this Reynolds number."""
    thrust = []
    for n_crit in (None, 9.0):
        prob = problem(trim="rpm", n_crit=n_crit)
        prob.setup()
        prob.set_val("rpm", 4200.0)
        prob.set_val("speed", 0.0)
        prob.run_model()
        thrust.append(prob.get_val("thrust")[0])
    assert 0.85 < thrust[1] / thrust[0] < 0.99
    analysis = analyze(propeller, rpm=4200.0, n_crit=9.0, fidelity=small)
    assert_allclose(thrust[1], float(analysis.loads.thrust), rtol=1e-6)


@pytest.mark.slow
def test_derivatives_at_another_transition(problem):
    """Polars are an input of the components: their derivatives know no transition."""
    prob = problem(trim="rpm", n_crit=8.0)
    prob.setup()
    thrust = []
    for rpm in (4195.0, 4205.0, 4200.0):
        prob.set_val("rpm", rpm)
        prob.run_model()
        thrust.append(prob.get_val("thrust")[0])
    slope = prob.compute_totals(of=["thrust"], wrt=["rpm"])["thrust", "rpm"]
    assert_allclose(slope, (thrust[1] - thrust[0]) / 10.0, rtol=1e-3)


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"n_crit": 0.0}, "n_crit must be within 0.1 ... 30; it is 0"),
        ({"trip_upper": -0.1}, "trip_upper must be within 0 ... 1; it is -0.1"),
        ({"trip_lower": 0.1, "viscous": False}, "trip_lower is about the polars of the sections"),
    ],
)
def test_transitions_that_there_are_not_are_refused(problem, options, message):
    with pytest.raises(ValueError, match=message):
        problem(**options).setup()


def test_polars_of_ones_own_have_a_transition_of_their_own(problem, polars):
    with pytest.raises(ValueError, match="transition of their own: n_crit does not go along"):
        problem(polars=polars, n_crit=9.0).setup()


def test_drag_costs_torque(problem):
    """What polars change: more torque at the same thrust."""
    torque = []
    for viscous in (True, False):
        prob = problem(viscous=viscous)
        prob.setup()
        prob.run_model()
        torque.append(prob.get_val("torque")[0])
    assert torque[0] > 1.2 * torque[1]


def test_polars_of_ones_own(problem, polars):
    """Twice the drag of the catalogue is more torque at the same rotation speed."""
    prob = problem(trim="rpm", polars=polars)
    prob.setup()
    prob.run_model()
    draggy = dataclasses.replace(polars, values=polars.values.at[:, :, :, 1].add(jnp.log(2.0)))
    doubled = problem(trim="rpm", polars=draggy)
    doubled.setup()
    doubled.run_model()
    assert doubled.get_val("torque")[0] > 1.1 * prob.get_val("torque")[0]


def test_rpm_can_be_given_instead_of_the_thrust(problem):
    prob = problem(trim="rpm")
    prob.setup()
    prob.set_val("rpm", 2.0 * np.pi * 70.0, units="rad/s")
    prob.run_model()
    at_4200 = prob.get_val("thrust")[0]
    trimmed = problem()
    trimmed.setup()
    trimmed.set_val("thrust_required", at_4200)
    trimmed.run_model()
    assert_allclose(trimmed.get_val("rpm"), 4200.0, rtol=1e-6)


def test_control_points_start_on_the_propeller_and_lead_the_distribution(problem, propeller):
    prob = problem(
        design_distributions={"beta": [0.15, 0.5, 1.0], "chord_over_R": [0.15, 1.0]},
        control="values",
    )
    with pytest.warns(UserWarning, match="slinear curves through control points change the"):
        prob.setup()
    prob.run_model()
    r = propeller.r_over_R
    at = np.interp([0.15, 0.5, 1.0], r, propeller.beta_deg)
    assert_allclose(prob.get_val("beta_cp", units="deg"), at)
    assert_allclose(prob.get_val("beta", units="deg")[0], np.interp(r, [0.15, 0.5, 1.0], at))
    prob.set_val("beta_cp", [20.0, 15.0, 10.0], units="deg")
    prob.set_val("chord_over_R_cp", [0.2, 0.1])
    prob.run_model()
    linear = np.interp(r, [0.15, 0.5, 1.0], [20.0, 15.0, 10.0])
    assert_allclose(prob.get_val("beta", units="deg")[0], linear)
    assert_allclose(prob.get_val("chord_over_R")[0], np.interp(r, [0.15, 1.0], [0.2, 0.1]))


@pytest.mark.parametrize("method", ["akima", "cubic"])
def test_other_splines_pass_through_the_control_points(problem, propeller, method):
    prob = problem(
        design_distributions={"chord_over_R": [0.15, 0.4, 0.7, 1.0]},
        control="values",
        spline_method=method,
    )
    with pytest.warns(UserWarning, match=f"{method} curves through control points change the"):
        prob.setup()
    prob.set_val("chord_over_R_cp", [0.1, 0.2, 0.15, 0.05])
    prob.run_model()
    chord = prob.get_val("chord_over_R")[0]
    at = np.searchsorted(propeller.r_over_R, [0.15, 0.4, 0.7, 1.0])
    assert_allclose(propeller.r_over_R[at], [0.15, 0.4, 0.7, 1.0])
    assert_allclose(chord[at], [0.1, 0.2, 0.15, 0.05])


@pytest.mark.parametrize(
    ("distributions", "message"),
    [
        ({"twist": [0.15, 1.0]}, "unknown distribution 'twist'; there are chord_over_R, beta"),
        (
            {"beta": [0.15, 0.9]},
            "of beta must reach from 0.15 to 1 r/R; they reach from 0.15 to 0.9",
        ),
        ({"beta": [1.0, 0.15]}, r"of beta must be at least two rising r/R; they are \[1.0, 0.15\]"),
    ],
)
def test_wrong_control_points_are_clear_errors(problem, distributions, message):
    with pytest.raises(ValueError, match=message):
        problem(design_distributions=distributions).setup()


@pytest.mark.parametrize(
    ("trim", "speed"),
    [
        ("thrust", 0.5),
        ("rpm", 8.0),
        pytest.param("thrust", 8.0, marks=pytest.mark.slow),
        pytest.param("rpm", 0.5, marks=pytest.mark.slow),
    ],
)
def test_totals_against_differences(problem, assert_totals, point_inputs, trim, speed):
    """From blade, operating point and observers to loads and noise, trim in between.

    Hover is the least speed, so its derivatives are checked a little beside it.
    """
    prob = problem(
        trim=trim,
        design_distributions={"beta": [0.15, 0.5, 1.0], "thickness_over_chord": [0.15, 1.0]},
        control="values",
        camber="design_lift_coefficient",
        broadband=True,
    )
    prob.setup(mode="rev")
    prob.set_val("speed", speed)
    if trim == "rpm":
        prob.set_val("rpm", 4200.0)
    prob.run_model()
    of = ["thrust", "torque", "spl_bpf_db", "oaspl_dba", "oaspl_broadband_db", "oaspl_total_dba"]
    of[:1] = ["thrust"] if trim == "rpm" else ["rpm"]
    wrt = ["diameter", "beta_cp", "thickness_over_chord_cp", "chord_over_R"]
    wrt += ["design_lift_coefficient", "observer_position", *point_inputs(prob.model.propeller)]
    # broadband noise has corners in every band: none is left only where the root's 1e-9 shows
    assert_totals(prob, of, wrt, {"oaspl_broadband_db": 1e-5, "oaspl_total_dba": 1e-5})


def test_unreachable_thrust_is_a_failed_analysis(problem):
    prob = problem(rpm_bounds=(1000.0, 5000.0))
    prob.setup()
    prob.set_val("thrust_required", 10.0)
    with pytest.raises(
        om.AnalysisError, match=r"thrust 10 N is out of reach at 8 m/s: .* 5000 rpm"
    ):
        prob.run_model()


def quieter(problem, driver):
    """Twist and chord for less noise below the rotor at about the torque of the start."""
    prob = problem(
        driver,
        design_distributions={"beta": [0.15, 0.5, 1.0], "chord_over_R": [0.15, 0.5, 1.0]},
        control="values",
        rpm_bounds=(3000.0, 6000.0),
        viscous=False,  # quicker; it is the driver that is looked at
    )
    prob.model.add_design_var("beta_cp", lower=[3.0] * 3, upper=[30.0, 25.0, 15.0], units="deg")
    prob.model.add_design_var("chord_over_R_cp", lower=0.03, upper=0.3)
    prob.model.add_objective("oaspl_db", index=0)
    prob.model.add_constraint("torque", upper=0.028, ref=0.028)
    prob.setup()
    prob.run_model()
    return prob, prob.get_val("oaspl_db")[0]


def test_differential_evolution_finds_a_quieter_blade(problem, tmp_path):
    driver = DifferentialEvolutionDriver(
        seed=4, max_gen=8, pop_size=16, disp=False, best_file=tmp_path / "best.json"
    )
    prob, baseline = quieter(problem, driver)
    assert prob.run_driver().success
    assert prob.get_val("oaspl_db")[0] < baseline - 0.5
    assert prob.get_val("torque")[0] <= 0.028
    assert_allclose(prob.get_val("thrust"), 1.2, rtol=1e-6)
    # blades that cannot give 1.2 N between the bounds came up and were passed over
    assert driver.failed_candidates > 0
    assert "out of reach" in driver.last_failure
    assert (tmp_path / "best.json").exists()


def test_gradients_lead_another_driver_to_a_quieter_blade(problem):
    driver = om.ScipyOptimizeDriver(optimizer="SLSQP", maxiter=8, disp=False)
    prob, baseline = quieter(problem, driver)
    prob.run_driver()
    assert prob.get_val("oaspl_db")[0] < baseline - 0.5
    assert prob.get_val("torque")[0] <= 0.028 * (1.0 + 1e-3)


def test_reports_and_recorders_of_openmdao_work_on_it(problem, tmp_path):
    prob = problem()
    prob.add_recorder(om.SqliteRecorder(str(tmp_path / "cases.sql")))
    prob.setup()
    prob.run_model()
    prob.record("final")
    om.n2(prob, outfile=str(tmp_path / "n2.html"), show_browser=False)
    assert (tmp_path / "n2.html").exists()
    prob.cleanup()
    case = om.CaseReader(str(tmp_path / "cases.sql")).get_case("final")
    assert_allclose(case["rpm"], prob.get_val("rpm"))


def test_entry_points_name_what_there_is(checkout):
    project = tomllib.loads((checkout / "pyproject.toml").read_text())["project"]
    bases = {
        "openmdao_component": om.ExplicitComponent,
        "openmdao_group": om.Group,
        "openmdao_driver": type(om.Problem().driver),
    }
    for group, base in bases.items():
        for target in project["entry-points"][group].values():
            module, name = target.split(":")
            assert issubclass(getattr(importlib.import_module(module), name), base)


def test_the_group_is_a_model_by_itself(propeller, small):
    group = PropellerGroup(propeller=propeller, observers=OBSERVERS, fidelity=small)
    prob = om.Problem(group, reports=False)
    prob.setup()
    prob.run_model()
    assert_allclose(prob.get_val("thrust"), 1.0, rtol=1e-6)

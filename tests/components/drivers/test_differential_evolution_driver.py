"""The driver finds known constrained optima, runs each design once and survives failures."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import DifferentialEvolutionDriver


def designs_of(prob):
    return prob.model.comp.designs


def rosenbrock(x):
    return 100.0 * (x[1] - x[0] ** 2) ** 2 + (1.0 - x[0]) ** 2


def g06(x):
    """Floudas and Pardalos 1987: a crescent of 0.003 % of the domain is feasible."""
    return (x[0] - 10) ** 3 + (x[1] - 20) ** 3, [
        100 - (x[0] - 5) ** 2 - (x[1] - 5) ** 2,
        (x[0] - 6) ** 2 + (x[1] - 5) ** 2 - 82.81,
    ]


def g08(x):
    """Schoenauer and Xanthakis 1993: many maxima, one of them feasible and best."""
    value = np.sin(2 * np.pi * x[0]) ** 3 * np.sin(2 * np.pi * x[1])
    value /= x[0] ** 3 * (x[0] + x[1])
    return -value, [x[0] ** 2 - x[1] + 1, 1 - x[0] + (x[1] - 4) ** 2]


# --- known optima -------------------------------------------------------------------------------


def test_rosenbrock_with_active_inequality(problem):
    prob = problem(
        lambda x: (rosenbrock(x), x.sum()), [0.0, 0.0], [2.0, 2.0], constraint={"upper": 1.9},
        tol=1e-8, max_gen=200,
    )  # fmt: skip
    result = prob.run_driver()
    assert result.success and not prob.driver.fail
    # optimum on x + y = 1.9: 400 x^3 + 600 x^2 - ... = 0, solved to 8 digits by scipy's manual
    assert_allclose(prob.get_val("x"), [0.96632622, 0.93367155], atol=1e-5)
    assert prob.get_val("g")[0] <= 1.9


def test_g06(problem):
    prob = problem(g06, [13.0, 0.0], [100.0, 100.0], n_g=2, constraint={"upper": 0.0},
                   tol=1e-9, max_gen=150, pop_size=40)  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), [14.095, 0.84296], atol=1e-3)
    assert_allclose(prob.get_val("f"), -6961.81388, rtol=1e-6)
    assert (prob.get_val("g") <= 0.0).all()


def test_g08(problem):
    prob = problem(g08, [1e-3, 1e-3], [10.0, 10.0], n_g=2, constraint={"upper": 0.0},
                   tol=1e-6, max_gen=100)  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), [1.2279713, 4.2453733], atol=1e-3)
    assert_allclose(prob.get_val("f"), -0.095825, atol=1e-6)


@pytest.mark.parametrize("active", [0, 1, 2])
def test_every_element_of_a_vector_constraint_is_enforced(problem, active):
    lower = np.full(3, -10.0)
    lower[active] = 1.0
    prob = problem(
        lambda x: (x @ x, x), [-2.0] * 3, [2.0] * 3, n_g=3, constraint={"lower": lower}, tol=1e-6
    )
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), np.eye(3)[active], atol=2e-3)


@pytest.mark.parametrize(("sign", "optimum"), [(-1.0, 0.5), (1.0, -0.25)])
def test_both_sides_of_a_two_sided_constraint_are_enforced(problem, sign, optimum):
    prob = problem(
        lambda x: (sign * x[0] + 3.0, x), [-1.0], [1.0],
        constraint={"lower": -0.25, "upper": 0.5}, tol=1e-8,
    )  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), optimum, atol=1e-5)
    assert -0.25 <= prob.get_val("g")[0] <= 0.5


def test_equality_holds_within_the_declared_tolerance(problem):
    prob = problem(
        lambda x: (x @ x, x.sum()), [-1.0] * 2, [1.0] * 2, constraint={"equals": 1.0},
        tol=1e-8, equality_tolerance=1e-3,
    )  # fmt: skip
    assert prob.run_driver().success
    assert abs(prob.get_val("g")[0] - 1.0) <= 1e-3
    # the optimum sits at the near edge of the tolerance band: x = y = 0.4995
    assert_allclose(prob.get_val("f"), 0.5 * 0.999**2, atol=2e-5)


def circle(x):
    return x.sum(), x @ x


def g11(x):
    """Koziel and Michalewicz 1999."""
    return x[0] ** 2 + (x[1] - 1.0) ** 2, x[1] - x[0] ** 2


@pytest.mark.parametrize("seed", [1, 2])
@pytest.mark.parametrize(
    ("function", "bound", "equals", "optimum"), [(circle, 2.0, 2.0, -2.0), (g11, 1.0, 0.0, 0.75)]
)
def test_a_curved_equality_is_followed_to_the_optimum(
    problem, seed, function, bound, equals, optimum
):
    prob = problem(function, [-bound] * 2, [bound] * 2, constraint={"equals": equals}, seed=seed,
                   x0=[0.5, 0.5])  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("f"), optimum, atol=1e-3)
    deviation = abs(prob.get_val("g")[0] - equals)
    assert deviation <= 1e-4
    assert f"off its equalities by up to {deviation:.3g}" in prob.driver.message


def test_designs_run_once_while_an_equality_tightens(problem):
    prob = problem(
        lambda x: (x[0], x[:2].sum()), [-1.0, -1.0, 0.3], [1.0, 1.0, 0.3],
        constraint={"equals": 0.7}, max_gen=10, pop_size=9, tol=0.0,
    )  # fmt: skip
    prob.run_driver()
    designs = np.array(designs_of(prob))
    assert len(np.unique(designs, axis=0)) == len(designs) - 1 <= 9 * 11
    assert [row.generation for row in prob.driver.history] == list(range(11))


def test_an_equality_that_no_design_meets_says_what_is_left(problem):
    prob = problem(lambda x: (x[0], x @ x), [1.0], [2.0], constraint={"equals": 0.5}, max_gen=20)
    assert not prob.run_driver().success
    assert "no feasible design" in prob.driver.message
    assert "off its equalities by up to 0.5" in prob.driver.message


def test_fixed_and_free_elements_of_one_variable(problem):
    prob = problem(lambda x: (x @ x, x[:1]), [-1.0, 0.5], [1.0, 0.5], tol=1e-6)
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), [0.0, 0.5], atol=1e-3)


# --- scaling, units, indices --------------------------------------------------------------------


def scaled_problem(x_scaling, g_scaling, f_scaling):
    prob = om.Problem(
        driver=DifferentialEvolutionDriver(seed=3, disp=False, best_file=None, max_gen=15),
        reports=False,
    )
    prob.model.add_subsystem(
        "comp",
        om.ExecComp(
            ["f = sum((x - 0.3)**2)", "g = 2 * x"],
            x={"val": np.full(4, 0.1), "units": "rad"},
            g={"val": np.zeros(4), "units": "rad"},
        ),
        promotes=["*"],
    )
    prob.model.add_design_var("x", lower=-20, upper=30, units="deg", indices=[0, 2], **x_scaling)
    prob.model.add_constraint("g", upper=[20, 90], units="deg", indices=[0, 2], **g_scaling)
    prob.model.add_objective("f", **f_scaling)
    prob.setup()
    prob.run_driver()
    return prob


@pytest.mark.parametrize(
    "x_scaling",
    [
        {"ref": 5.0},
        {"ref": -4.0, "ref0": 1.0},
        {"scaler": [2.0, 0.1], "adder": [1.0, -7.0]},
    ],
)
def test_scaling_of_design_variables_does_not_change_the_search(x_scaling):
    plain = scaled_problem({}, {}, {})
    scaled = scaled_problem(x_scaling, {}, {})
    assert_allclose(scaled.get_val("x"), plain.get_val("x"), rtol=1e-9)


def test_units_indices_and_bounds_of_elements():
    prob = scaled_problem({}, {}, {})
    x = prob.get_val("x", units="deg")
    assert_allclose(x[[1, 3]], np.rad2deg(0.1))  # not design variables
    assert_allclose(x[0], 10.0, atol=0.5)  # constraint 2 x <= 20 deg is active
    assert x[0] <= 10.0
    assert_allclose(x[2], np.rad2deg(0.3), atol=0.5)


def test_negative_scaling_of_a_constraint_keeps_its_sense():
    plain = scaled_problem({}, {}, {})
    flipped = scaled_problem({}, {"ref": -1.0}, {})
    assert_allclose(flipped.get_val("x"), plain.get_val("x"), rtol=1e-12)


def test_negative_ref_maximises_and_history_keeps_the_objective_as_it_is():
    prob = scaled_problem({}, {}, {"ref": -2.0})
    assert_allclose(prob.get_val("x", units="deg")[[0, 2]], -20.0, atol=0.5)
    best = [row.best_objective for row in prob.driver.history]
    assert_allclose(best[-1], prob.get_val("f")[0])
    assert (np.diff(best) >= 0.0).all()


# --- one run per design -------------------------------------------------------------------------


def test_one_model_run_per_design_plus_one_at_the_end(problem):
    prob = problem(
        lambda x: (rosenbrock(x), x.sum()), [0.0] * 2, [2.0] * 2, constraint={"upper": 1.9},
        tol=0.0, max_gen=7, pop_size=11, strategy="rand1bin", recombination=1.0,
    )  # fmt: skip
    result = prob.run_driver()
    designs = np.array(designs_of(prob))
    assert len(designs) == 11 * 8 + 1 == result.model_evals == prob.driver.iter_count
    assert len(np.unique(designs, axis=0)) == 11 * 8
    assert (designs[-1] == prob.get_val("x")).all()
    assert prob.driver.history[-1].evaluations == 11 * 8


def test_nothing_is_run_twice_while_no_design_is_feasible(problem):
    """Scipy would evaluate the whole population again in every generation."""
    prob = problem(
        lambda x: (x @ x, 1.0 + x @ x), [-1.0] * 2, [1.0] * 2, constraint={"upper": 0.5},
        max_gen=6, pop_size=8, strategy="rand1bin", recombination=1.0,
    )  # fmt: skip
    prob.run_driver()
    assert len(designs_of(prob)) == 8 * 7 + 1


def test_initial_design_is_the_first_candidate_clipped_to_its_bounds(problem):
    prob = problem(lambda x: (x @ x, x[:1]), [-1.0] * 2, [1.0] * 2, max_gen=0, x0=[0.25, 3.0])
    with pytest.warns(om.DriverWarning, match="out of their specified bounds"):
        prob.run_driver()
    assert_allclose(designs_of(prob)[0], [0.25, 1.0])


def test_same_seed_same_search_and_another_seed_another(problem):
    def designs(seed):
        prob = problem(lambda x: (rosenbrock(x), x), [0.0] * 2, [2.0] * 2, n_g=2, seed=seed,
                       max_gen=4, pop_size=6)  # fmt: skip
        prob.run_driver()
        return np.array(designs_of(prob))

    assert (designs(5) == designs(5)).all()
    assert not (designs(5) == designs(6)).all()


@pytest.mark.parametrize(
    "options",
    [{"init": "halton"}, {"init": "sobol", "pop_size": 16}, {"strategy": "rand2exp"},
     {"mutation": 0.6, "recombination": 0.9}, {"strategy": "currenttobest1bin"}],
)  # fmt: skip
def test_other_strategies_and_samplers_find_the_optimum(problem, options):
    prob = problem(lambda x: (x @ x, x[:1]), [-1.0] * 2, [2.0] * 2, constraint={"lower": 0.5},
                   max_gen=80, **options)  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("x"), [0.5, 0.0], atol=0.02)


def test_history_is_a_convergence_figure(problem):
    prob = problem(g06, [13.0, 0.0], [100.0, 100.0], n_g=2, constraint={"upper": 0.0},
                   tol=0.0, max_gen=60, pop_size=20)  # fmt: skip
    prob.run_driver()
    history = prob.driver.history
    assert [row.generation for row in history] == list(range(61))
    # a trial that equals a known design is not run again, so 20 a generation is the most
    runs = np.diff([0] + [row.evaluations for row in history])
    assert ((runs > 10) & (runs <= 20)).all()
    assert history[-1].evaluations == len(designs_of(prob)) - 1
    feasible = np.array([row.max_violation == 0.0 for row in history])
    best = np.array([row.best_objective for row in history])
    assert not feasible[0] and feasible[-1]
    assert (np.isnan(best) == ~feasible).all()
    assert (np.diff(best[feasible]) <= 0.0).all()
    assert best[-1] == prob.get_val("f")[0]


def test_converged_search_stops_before_max_gen_and_says_so(problem, capsys):
    prob = problem(lambda x: (1.0 + x @ x, x[:1]), [-1.0] * 2, [1.0] * 2, tol=0.1, disp=True)
    prob.run_driver()
    assert len(prob.driver.history) < 50
    assert "converged" in prob.driver.message
    out, err = capsys.readouterr()
    assert prob.driver.message in out
    assert err == ""  # no progress bar where stderr is no terminal


def test_every_generation_is_told_when_it_has_ended(problem):
    prob = problem(lambda x: (np.sum(x**2), 0.0), [-1.0, -1.0], [1.0, 1.0], max_gen=3, tol=0.0)
    told = []
    prob.driver.watch = lambda generation: told.append((generation, len(prob.model.comp.designs)))
    prob.run_driver()
    assert [generation for generation, _ in told] == prob.driver.history
    assert len(told) == 4
    assert all(n == generation.evaluations for generation, n in told)

"""Cost of a design in an optimisation: the driver alone, the group, and the group's gradient."""

from __future__ import annotations

import openmdao.api as om
import pytest

from propmdao.components import DifferentialEvolutionDriver


def test_driver_alone_1000_designs(benchmark):
    """Ten variables and a constraint on a model that costs next to nothing.

    On two cores 250 ms; the floor is 1000 runs of the model without a driver, 100 ms.
    """
    driver = DifferentialEvolutionDriver(
        max_gen=9, pop_size=100, tol=0.0, seed=1, disp=False, best_file=None
    )
    prob = om.Problem(driver=driver, reports=False)
    prob.model.add_subsystem(
        "comp", om.ExecComp(["f = sum(x**2)", "g = sum(x)"], x={"shape_by_conn": True})
    )
    prob.model.add_subsystem("x", om.IndepVarComp("x", [0.1] * 10))
    prob.model.connect("x.x", "comp.x")
    prob.model.add_design_var("x.x", lower=-1.0, upper=1.0)
    prob.model.add_constraint("comp.g", lower=0.5)
    prob.model.add_objective("comp.f")
    prob.setup()
    benchmark.pedantic(prob.run_driver, rounds=3, warmup_rounds=1)


@pytest.fixture(scope="module")
def low_noise(models):
    """The low-noise design of `worker_models`."""
    return models.low_noise()


def test_one_design(benchmark, low_noise):
    """Trim, loads and noise of one blade."""
    benchmark.pedantic(low_noise.run_model, rounds=5, warmup_rounds=1)


def test_gradient_of_noise_and_torque(benchmark, low_noise):
    """Two responses by any number of variables, reverse mode."""
    low_noise.run_model()
    benchmark.pedantic(
        low_noise.compute_totals,
        kwargs={"of": ["oaspl_db", "torque"], "wrt": ["beta_cp", "chord_over_R_cp"]},
        rounds=3,
        warmup_rounds=1,
    )

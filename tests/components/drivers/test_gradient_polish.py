"""SLSQP from the best design of evolution: several equalities are met, and nothing is lost."""

import numpy as np
import openmdao.api as om
import pytest
from numpy.testing import assert_allclose

from propmdao.components import DifferentialEvolutionDriver


def circle(x):
    return x.sum(), x @ x


def g11(x):
    """Koziel and Michalewicz 1999."""
    return x[0] ** 2 + (x[1] - 1.0) ** 2, x[1] - x[0] ** 2


def g13(x):
    """Hock and Schittkowski 1981, problem 80, without its third equality."""
    return np.exp(x.prod()), [x @ x - 10.0, x[1] * x[2] - 5.0 * x[3] * x[4]]


def two_equalities(x):
    """Hock and Schittkowski 1981, problem 48: five variables, optimum 0 at 1."""
    value = (x[0] - 1) ** 2 + (x[1] - x[2]) ** 2 + (x[3] - x[4]) ** 2
    return value, [x.sum() - 5.0, x[2] - 2 * (x[3] + x[4]) + 3.0]


@pytest.mark.parametrize("seed", [1, 2, 3, 4])
@pytest.mark.parametrize(
    ("function", "bound", "n_g", "equals", "optimum", "generations"),
    [
        (circle, 2.0, 1, 2.0, -2.0, 20),
        (g11, 1.0, 1, 0.0, 0.75, 20),
        (two_equalities, 3.0, 2, 0.0, 0.0, 20),
    ],
)
def test_equalities_are_met_at_the_optimum(
    problem, seed, function, bound, n_g, equals, optimum, generations
):
    n = 2 if n_g == 1 else 5
    prob = problem(
        function, [-bound] * n, [bound] * n, n_g=n_g, constraint={"equals": equals}, seed=seed,
        x0=[0.5] * n, max_gen=generations, polish=True,
    )  # fmt: skip
    assert prob.run_driver().success
    assert_allclose(prob.get_val("g"), equals, atol=1.01e-4)
    # The optimum moves by the tolerance of the equalities times their multipliers.
    assert_allclose(prob.get_val("f"), optimum, atol=3e-4)
    assert " and polished by " in prob.driver.message

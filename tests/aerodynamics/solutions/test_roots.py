"""Roots of a scalar: what is known before a search, and results on a straight line."""

import jax
import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.solutions.roots import Guess, at_root, decreasing_root

TOLERANCE = 1e-9


def search(a, guess, slope, straight):
    """Root of a - x - x^3 / 10 between -10 and 10; results are the root's cube, and the trials."""

    def residual(x, last):
        return a - x - 0.1 * x**3, (x**3, last[1] + 1.0)

    start = (jnp.zeros(()), jnp.zeros(()))
    guess = Guess(guess, start, slope)
    return decreasing_root(residual, -10.0, 10.0, guess, TOLERANCE, straight)


ROOT = 1.5
A = ROOT + 0.1 * ROOT**3


@pytest.mark.parametrize("straight", [False, True])
@pytest.mark.parametrize(("guess", "slope"), [(1.4, -1.0), (-8.0, -1.0), (1.6, -1.7)])
def test_root_and_the_results_there(guess, slope, straight):
    root, (cube, _) = jax.jit(lambda a: search(a, guess, slope, straight))(A)
    np.testing.assert_allclose(root, ROOT, rtol=10 * TOLERANCE)
    np.testing.assert_allclose(cube, ROOT**3, rtol=10 * TOLERANCE)


def test_results_on_a_straight_line_save_a_trial():
    # The count of trials is a result as well, and lies on the line through the last two.
    once_more, line = (float(search(A, 1.501, -1.675, s)[1][1]) for s in (False, True))
    assert line == pytest.approx(once_more - 1.0, abs=0.01)


def test_derivatives_may_come_from_known_results():
    def evaluate(a, x):
        return 2.0 * x + 0.0 * a

    def residual(a, x, results):
        return a - x - 0.1 * x**3

    def solve(a):
        root, _ = search(a, 1.4, -1.0, True)
        return root, 2.0 * root, None

    def again(a, x, known):
        return evaluate(a, x) + 0.0 * known

    slopes = [
        jax.grad(lambda a, model=model: at_root(solve, evaluate, residual, a, model)[1])(A)
        for model in (None, again)
    ]
    np.testing.assert_allclose(slopes, 2.0 / (1.0 + 0.3 * ROOT**2), rtol=1e-8)

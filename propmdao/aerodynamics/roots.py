"""Scalar roots that keep inside their bracket and carry exact derivatives."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any

import jax
import jax.numpy as jnp
from jax import Array

_MAX_EVALUATIONS = 60


def decreasing_root(
    residual: Callable[[Array], Array], low: Array, high: Array, guess: Array, tolerance: float
) -> Array:
    """Root of a decreasing function by the secant method, kept inside a shrinking bracket.

    Differentiable as `implicit_root` is.

    Parameters
    ----------
    residual : callable
        Continuous function of slope about -1, positive at `low` and negative at `high`; the ends are
        not evaluated.
    low, high, guess : float
        Bracket and first trial.
    tolerance : float
        Relative error allowed. For a slope of about -1 a secant step leaves an error of about the
        product of the last two steps, and the first step one below the residual.

    Returns
    -------
    float
        The root; where none is found in 60 evaluations, the last trial.
    """

    def solve(f: Callable[[Array], Array], start: Array) -> Array:
        def unfinished(state: tuple[Array, ...]) -> Array:
            count, _, _, x, x_before, f_before, moved = state
            by_product = jnp.abs((x - x_before) * moved) > tolerance * x * x
            by_residual = jnp.abs(f_before) > tolerance * jnp.abs(x)
            return (count < _MAX_EVALUATIONS) & by_product & by_residual

        def step(state: tuple[Array, ...]) -> tuple[Array, ...]:
            count, lo, hi, x, x_before, f_before, _ = state
            fx = f(x)
            lo, hi = jnp.where(fx > 0.0, x, lo), jnp.where(fx > 0.0, hi, x)
            # The first step has no secant: bisecting would throw the guess away, so move as if
            # the slope were -1, which is that of x = g(x) with a constant g.
            slope = jnp.where(count == 0, -1.0, (fx - f_before) / (x - x_before))
            trial = x - fx / slope
            inside = (trial > lo) & (trial < hi)
            following = jnp.where(inside | (fx == 0.0), trial, 0.5 * (lo + hi))
            return count + 1, lo, hi, following, x, fx, x - x_before

        none = jnp.asarray(jnp.inf)
        state = (0, jnp.asarray(low, float), jnp.asarray(high, float), start, none, none, none)
        return jax.lax.while_loop(unfinished, step, state)[3]

    return implicit_root(residual, guess, lambda f, start: (solve(f, start), None))[0]


def implicit_root(
    residual: Callable[[Array], Array],
    start: Array,
    solve: Callable[[Callable[[Array], Array], Array], tuple[Array, Any]],
) -> tuple[Array, Any]:
    """Root found by any means, with the derivative of the implicit function theorem.

    Parameters
    ----------
    residual : callable
        Function of one scalar; it may close over differentiable values.
    start : float
        Handed to `solve`.
    solve : callable
        ``solve(residual, start) -> (root, other results)``.

    Returns
    -------
    root, other : float, any
        The root, differentiable in what `residual` closes over, and the other results.
    """

    def tangent_solve(linear: Callable[[Array], Array], y: Array) -> Array:
        return y / linear(jnp.ones_like(y))

    start = jax.lax.stop_gradient(jnp.asarray(start, float))
    return jax.lax.custom_root(residual, start, solve, tangent_solve, has_aux=True)

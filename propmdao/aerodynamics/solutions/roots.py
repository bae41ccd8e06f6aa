"""Scalar roots that keep inside their bracket and carry exact derivatives."""

from __future__ import annotations

from collections.abc import Callable
from functools import partial
from typing import Any, Generic, NamedTuple, TypeVar

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar

_MAX_EVALUATIONS = 60

Params = TypeVar("Params")
Results = TypeVar("Results")
Other = TypeVar("Other")
Notes = TypeVar("Notes")


class Guess(NamedTuple, Generic[Results]):
    """What is known of a root before the search.

    Attributes
    ----------
    root : float
        The first trial.
    results : pytree
        Results to start from there, in the shape of those of a trial.
    slope : float
        Slope of the residual; -1 is that of x = g(x) with a constant g.
    """

    root: Scalar
    results: Results
    slope: Scalar = -1.0

    def holding(self, results: Other) -> Guess[Other]:
        """The same guess with other results to start from."""
        return Guess(self.root, results, self.slope)


def decreasing_root(
    residual: Callable[[Array, Results], tuple[Array, Results]],
    low: Scalar,
    high: Scalar,
    guess: Guess[Results],
    tolerance: float,
    straight: bool = False,
) -> tuple[Array, Results]:
    """Root of a decreasing function by the secant method, kept inside a shrinking bracket.

    Parameters
    ----------
    residual : callable
        ``residual(x, last)`` returns the residual and the results computed on the way to it, any
        pytree of floats; `last` are the results of the trial before, to start from.
        The residual is continuous, of slope about -1, positive at `low` and negative at `high`;
        the ends are not evaluated.
    low, high : float
        Both ends of the bracket.
    guess : Guess
        The first trial, and what is known there.
    tolerance : float
        Relative error allowed. For a slope of about -1 a secant step leaves an error of about the
        product of the last two steps, and the first step one below the residual.
    straight : bool
        Whether the results at the root are those on the straight line through the last two trials,
        whose error is that of the root, or computed once more.

    Returns
    -------
    root, results : float, pytree
        The root and the results there; where none is found in 60 evaluations, the last trial.
        `at_root` makes them differentiable.
    """

    def unfinished(state: _Search) -> Array:
        return (state.n_trials < _MAX_EVALUATIONS) & ~state.done.all()

    def step(state: _Search) -> _Search:
        x = state.trial
        f, results = residual(x, state.results)
        lo, hi = jnp.where(f > 0.0, x, state.low), jnp.where(f > 0.0, state.high, x)
        # The first step has no secant: bisecting would throw the guess away.
        secant = (f - state.last_residual) / (x - state.last_trial)
        slope = jnp.where(state.n_trials == 0, guess.slope, secant)
        trial = x - f / slope
        inside = (trial > lo) & (trial < hi)
        following = jnp.where(inside | (f == 0.0), trial, 0.5 * (lo + hi))
        close = jnp.abs((following - x) * (x - state.last_trial)) <= tolerance * following**2
        close = close | (jnp.abs(f) <= tolerance * jnp.abs(following))
        if straight:
            share = jnp.where(close, (following - x) / (x - state.last_trial), 0.0)
            results = jax.tree.map(
                lambda at, last: at + share * (at - last), results, state.results
            )
        # Where the next trial will do, it is evaluated once more, for the results there, unless
        # they lie on a straight line.
        done = close if straight else state.close
        following = jnp.where(state.close | state.done, x, following)
        return _Search(
            n_trials=state.n_trials + 1,
            low=lo,
            high=hi,
            trial=following,
            last_trial=x,
            last_residual=f,
            results=results,
            close=close,
            done=done | state.done,
        )

    trial = jnp.asarray(guess.root, float)
    none, no = jnp.full_like(trial, jnp.inf), jnp.full_like(trial, False, bool)
    start = _Search(
        n_trials=0,
        low=jnp.asarray(low, float),
        high=jnp.asarray(high, float),
        trial=trial,
        last_trial=none,
        last_residual=none,
        results=guess.results,
        close=no,
        done=no,
    )
    end = jax.lax.while_loop(unfinished, step, start)
    return end.trial, end.results


class _Search(NamedTuple):
    """State of `decreasing_root`."""

    n_trials: Array | int
    low: Array
    high: Array
    trial: Array
    last_trial: Array
    last_residual: Array
    results: Any
    close: Array  # whether the next trial will do
    done: Array


def empty(function: Callable[..., Results], *arguments: Any) -> Results:
    """Zeros in the shape of a function's results, to start a loop with."""
    shapes = jax.eval_shape(function, *(jnp.asarray(x, float) for x in arguments))
    return jax.tree.map(lambda shape: jnp.zeros(shape.shape, shape.dtype), shapes)


def at_root(
    solve: Callable[[Params], tuple[Array, Results, Notes]],
    evaluate: Callable[[Params, Array], Results],
    residual: Callable[[Params, Array, Results], Array],
    params: Params,
    again: Callable[[Params, Array, Results], Results] | None = None,
) -> tuple[Array, Results, Notes]:
    """Evaluate a model at the root of its residual, with the derivative of the implicit function.

    With r(p, x) = 0 the root moves by dx = -(r_p dp) / r_x, and the results by their change at
    fixed x plus their slope in x times dx. Nothing is differentiated through the iterations, and
    the model is transposed once for root and results together.

    Parameters
    ----------
    solve : callable
        ``solve(params) -> (x, results, notes)`` finds the root, a scalar, by any means, and the
        results there; notes on the search, a pytree of floats, are passed on without a derivative.
        Returning the results as well keeps the model from being compiled twice.
    evaluate : callable
        ``evaluate(params, x)`` gives the results, any pytree of floats.
    residual : callable
        ``residual(params, x, results)`` is zero at the root.
    params : pytree
        Everything that the three depend on: they may close over nothing that is traced.
    again : callable, optional
        ``again(params, x, results)`` evaluates the model where its results are known; by default
        they are of no use to `evaluate`.

    Returns
    -------
    root, results, notes : float, pytree, pytree
        Root, results at the root, and the notes of `solve`.
    """

    @jax.custom_jvp
    def converged(params: Params) -> tuple[Array, Results, Notes]:
        return solve(params)

    @converged.defjvp
    def derivative(primals: tuple[Params], tangents: tuple[Params]) -> tuple[Any, Any]:
        x, results, notes = converged(*primals)
        known = results

        def model(params: Params, x: Array) -> tuple[Results, Array]:
            results = evaluate(params, x) if again is None else again(params, x, known)
            return results, residual(params, x, results)

        by_x = jax.jvp(partial(model, *primals), (x,), (jnp.ones_like(x),))[1]
        by_params = jax.jvp(lambda p: model(p, x), primals, tangents)[1]
        dx = -by_params[1] / by_x[1]
        d_results = jax.tree.map(lambda d, slope: d + slope * dx, by_params[0], by_x[0])
        return (x, results, notes), (dx, d_results, jax.tree.map(jnp.zeros_like, notes))

    return converged(params)

"""Compilation of functions, in half the time."""

from __future__ import annotations

import inspect
from collections.abc import Callable
from functools import cache, wraps
from itertools import zip_longest
from typing import Any, ParamSpec, TypeVar

import jax
import jax.extend.core
import numpy as np

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made
from propmdao.runtime.kept_programs import are_kept, kept_program

_Parameters = ParamSpec("_Parameters")
_Result = TypeVar("_Result")


def _place_in_traces() -> Any:
    return jax.extend.core.get_opaque_trace_state(convention="flax")


_OUTSIDE = _place_in_traces()


def compiled(
    function: Callable[_Parameters, _Result],
    *,
    static_argnums: tuple[int, ...] | None = None,
    static_argnames: str | tuple[str, ...] | None = None,
) -> Callable[_Parameters, _Result]:
    """``jax.jit`` for functions that are called by themselves as well as within others.

    By itself, a function is compiled as `_options` have it, once for numbers and arrays of one
    element alike. Within another one, or where JAX differentiates or maps it, it is a part of that,
    compiled as that is.

    Parameters
    ----------
    function : callable
        Function of arrays that is decorated.
    static_argnums, static_argnames
        Arguments that are compiled in, as ``jax.jit`` takes them.

    Returns
    -------
    callable
        The function, compiled when it is called.
    """
    static: dict[str, Any] = {"static_argnums": static_argnums, "static_argnames": static_argnames}
    as_part = jax.jit(function, **static)

    @cache
    def alone() -> Any:
        return jax.jit(function, compiler_options=_options(), **static)

    parameters = list(inspect.signature(function).parameters)
    names = {static_argnames} if isinstance(static_argnames, str) else set(static_argnames or ())
    names |= {parameters[place] for place in static_argnums or ()}

    @wraps(function)
    def call(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
        if _place_in_traces() != _OUTSIDE:
            return as_part(*args, **kwargs)
        # *args of a function have no names
        places = list(zip_longest(parameters[: len(args)], args))
        positional = [a if k in names else _of_one_type(a) for k, a in places]
        named = {k: a if k in names else _of_one_type(a) for k, a in kwargs.items()}
        if are_kept():
            fixed = tuple((k, a) for k, a in [*places, *kwargs.items()] if k in names)
            by_place = tuple(
                a for (k, _), a in zip(places, positional, strict=True) if k not in names
            )
            by_name = {k: a for k, a in named.items() if k not in names}
            program = kept_program(
                call,
                fixed,
                (by_place, by_name),
                lambda: alone().lower(*positional, **named).compile(),
            )
            if program is not None:
                return program(*by_place, **by_name)
        return alone()(*positional, **named)

    return call


def _of_one_type(argument: Any) -> Any:
    """Make numbers arrays: JAX compiles a function anew for each place that holds a plain float."""
    return jax.tree.map(_as_array, argument)


def _as_array(leaf: Any) -> Any:
    if type(leaf) is float:
        return np.float64(leaf)
    if isinstance(leaf, jax.Array) and leaf.weak_type:  # made of plain floats alone
        return jax.lax.convert_element_type(leaf, np.dtype(leaf.dtype))
    return leaf


@cache
def _options() -> dict[str, Any] | None:
    """Options of XLA for the backend that is used; None where there are none to set.

    Of its two code generators for processors the older one compiles these functions in 0.55 of the
    time, and what it makes is as fast or faster: the lattice to 5 %, gradients 0.7 to 0.9, tones
    and flyovers 0.6 to 0.7 of the time (`benchmarks/`, XLA_FLAGS=--xla_cpu_use_fusion_emitters).
    """
    if jax.default_backend() != "cpu":
        return None
    options = {"xla_cpu_use_fusion_emitters": False}
    try:
        jax.jit(lambda: 0.0, compiler_options=options)()
    except jax.errors.JaxRuntimeError:  # a version of XLA without the choice
        return None
    return options

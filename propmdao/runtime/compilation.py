"""Compilation of functions, in half the time."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Hashable
from concurrent.futures import Future, ThreadPoolExecutor
from contextlib import suppress
from functools import cache, wraps
from itertools import zip_longest
from typing import Any, NamedTuple, ParamSpec, TypeVar

import jax
import jax.extend.core
import numpy as np

import propmdao.runtime.jax_setup  # noqa: F401 - before any array is made
from propmdao.runtime.kept_programs import are_kept, drop_program, kept_program, kind_of

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
    optimisation: int = 2,
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
    optimisation : int
        How hard XLA tries on a processor, 0 to 3. With 2 all takes an eighth less to compile than
        with 3, and runs as fast but for 4 % of blade elements; with 1 the derivatives of the
        lattice take five sixths of that again and are as fast, the lattice itself is 5 % slower.

    Returns
    -------
    callable
        The function, compiled when it is called.
    """
    static: dict[str, Any] = {"static_argnums": static_argnums, "static_argnames": static_argnames}
    as_part = jax.jit(function, **static)

    @cache
    def alone() -> Any:
        return jax.jit(function, compiler_options=_options(optimisation), **static)

    parameters = list(inspect.signature(function).parameters)
    names = {static_argnames} if isinstance(static_argnames, str) else set(static_argnames or ())
    names |= {parameters[place] for place in static_argnums or ()}

    def of_one_type(args: tuple[Any, ...], kwargs: dict[str, Any]) -> tuple[Any, dict[str, Any]]:
        places = zip_longest(parameters[: len(args)], args)  # *args of a function have no names
        by_place = tuple(a if k in names else _of_one_type(a) for k, a in places)
        return by_place, {k: a if k in names else _of_one_type(a) for k, a in kwargs.items()}

    def parted(args: tuple[Any, ...], kwargs: dict[str, Any]) -> _Parted:
        places = list(zip_longest(parameters[: len(args)], args))
        return _Parted(
            tuple((k, a) for k, a in [*places, *kwargs.items()] if k in names),
            tuple(a for k, a in places if k not in names),
            {k: a for k, a in kwargs.items() if k not in names},
        )

    begun: dict[Hashable, Future[None]] = {}  # ahead, and not called yet
    over: set[Hashable] = set()

    @wraps(function)
    def call(*args: _Parameters.args, **kwargs: _Parameters.kwargs) -> _Result:
        if _place_in_traces() != _OUTSIDE:
            return as_part(*args, **kwargs)
        by_place, by_name = of_one_type(args, kwargs)
        if begun and (compilation := begun.get(kinds := parted(by_place, by_name).kinds)):
            compilation.result()  # its own error is met below, where it belongs
            over.add(kinds)
            begun.pop(kinds, None)
        if are_kept():
            parts = parted(by_place, by_name)
            program = kept_program(
                call, parts.fixed, parts.moving, lambda: alone().lower(*by_place, **by_name)
            )
            if program is not None:
                try:
                    return program(*parts.by_place, **parts.by_name)
                except jax.errors.JaxRuntimeError:  # an error of its own comes again below
                    drop_program(call, parts.fixed, parts.moving)
        return alone()(*by_place, **by_name)

    def lower(*args: Any) -> Any:
        by_place, _ = of_one_type(args, {})
        return alone().lower(*by_place)

    call.lower = lower  # type: ignore[attr-defined]

    def ahead(then: Callable[[Any], None], args: tuple[Any, ...]) -> None:
        by_place, _ = of_one_type(args, {})
        parts = parted(by_place, {})

        def lower() -> Any:
            traced = alone().trace(*by_place)
            then(jax.tree.map(_shape, traced.out_info))
            return traced.lower()

        def compile_it() -> None:
            with suppress(Exception):
                if not are_kept() or kept_program(call, parts.fixed, parts.moving, lower) is None:
                    lower().compile()

        if (kinds := parts.kinds) not in over and kinds not in begun:
            begun[kinds] = _helpers().submit(compile_it)

    call.ahead = ahead  # type: ignore[attr-defined]
    return call


def compile_ahead(
    function: Callable[..., Any], *args: Any, then: Callable[[Any], None] = lambda _: None
) -> None:
    """Begin to compile a function in another thread; who calls it meanwhile waits.

    Parameters
    ----------
    function : callable
        Function that `compiled` has made; nothing is begun for any other.
    *args
        Arguments like those that it will be called with, by place alone; shapes and types are
        enough for those that are not compiled in. The same kinds begin once in a process.
    then : callable
        Called in that thread with the shapes of what the function returns, as soon as they are
        known.
    """
    if ahead := getattr(function, "ahead", None):
        ahead(then, args)


def memory_of(function: Callable[..., Any], *args: Any) -> int:
    """Memory that a call of a compiled function takes on each device.

    Parameters
    ----------
    function : callable
        Function that `compiled` has made.
    *args
        Arguments that it is compiled for; nothing is computed.

    Returns
    -------
    int
        Bytes of arguments, results and all that is between [B].
    """
    program = function.lower(*args).compile()  # type: ignore[attr-defined]
    memory = program.memory_analysis()
    return int(
        memory.argument_size_in_bytes + memory.output_size_in_bytes + memory.temp_size_in_bytes
    )


class _Parted(NamedTuple):
    """Arguments of a call, those that are compiled in apart from the others."""

    fixed: tuple[Hashable, ...]
    by_place: tuple[Any, ...]
    by_name: dict[str, Any]

    @property
    def moving(self) -> tuple[tuple[Any, ...], dict[str, Any]]:
        """What is not compiled in."""
        return self.by_place, self.by_name

    @property
    def kinds(self) -> Hashable:
        """All that a program is compiled for."""
        leaves, tree = jax.tree.flatten(self.moving)
        return self.fixed, tree, tuple(map(kind_of, leaves))


@cache
def _helpers() -> ThreadPoolExecutor:
    """Threads that trace; those that compile are XLA's own."""
    return ThreadPoolExecutor(max_workers=4, thread_name_prefix="compile ahead")


def _shape(result: Any) -> jax.ShapeDtypeStruct:
    return jax.ShapeDtypeStruct(result.shape, result.dtype)


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
def _options(optimisation: int) -> dict[str, Any] | None:
    """Options of XLA for the backend that is used; None where there are none to set.

    Of its two code generators for processors the older one compiles these functions in 0.55 of the
    time, and what it makes is as fast or faster: the lattice to 5 %, gradients 0.7 to 0.9, tones
    and flyovers 0.6 to 0.7 of the time (`benchmarks/`, XLA_FLAGS=--xla_cpu_use_fusion_emitters).
    """
    if jax.default_backend() != "cpu":
        return None
    options = {
        "xla_cpu_use_fusion_emitters": False,
        "xla_backend_optimization_level": optimisation,
    }
    try:
        jax.jit(lambda: 0.0, compiler_options=options)()
    except jax.errors.JaxRuntimeError:  # a version of XLA without the choice
        return None
    return options

"""Pure functions of arrays by name, compiled: values, values at many points, derivatives."""

from __future__ import annotations

from collections.abc import Callable, Collection, Hashable, Mapping
from functools import partial
from typing import Any, Protocol

import jax
import numpy as np

from propmdao.components.bases.packed_arrays import PackedArrays, packed
from propmdao.runtime.compilation import compile_ahead, compiled
from propmdao.runtime.side_by_side import at_all

Arrays = dict[str, Any]  # of NumPy or JAX, by variable name
Function = Callable[[Arrays, Any, Any], Arrays]  # of inputs, constants and what is static
Shapes = dict[str, tuple[int, ...]]


@partial(compiled, static_argnums=(0, 1))
def evaluate(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    """Return ``function(inputs, constants, static)``, compiled."""
    return function(inputs, constants, static)


@partial(compiled, static_argnums=(0, 1))
def evaluate_all(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    """Return the function's values where every input has a leading axis of points, compiled."""
    return at_all(lambda constants, point: function(point, constants, static), constants, inputs)


class Derivatives(Protocol):
    """Derivatives at one point, as products by seeds that are dictionaries of all variables."""

    def forward(self, seeds: Arrays, outputs: Collection[str]) -> Mapping[str, Any]:
        """Return derivatives of `outputs`, at least, along the direction `seeds` of all inputs."""

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives by every input of the sum of the outputs weighted with `seeds`."""

    def release(self) -> None:
        """Let go what takes much memory, if anything; a further product makes it again."""
        return


class FunctionDerivatives:
    """Derivatives of a function, linearised once for all reverse products.

    Parameters
    ----------
    function, static, constants, inputs
        Function and its arguments, in the order in which `evaluate` takes them.
    outputs : tuple of str
        Names of those of its results that are differentiated.
    """

    def __init__(
        self,
        function: Function,
        static: Hashable,
        constants: Any,
        inputs: Arrays,
        outputs: tuple[str, ...],
    ) -> None:
        self._linearisation = function, static, outputs, constants, inputs
        self._pull: PackedArrays | None = None

    def forward(self, seeds: Arrays, outputs: Collection[str]) -> Mapping[str, Any]:
        """Return derivatives of all outputs along the direction `seeds`, one for each input."""
        products: Arrays = _push(*self._linearisation, seeds)
        return products

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives by every input of the sum of the outputs weighted with `seeds`."""
        pull = self._pull  # which another thread may let go
        if pull is None:
            pull = self._pull = _linearise(*self._linearisation)
        return _pull_back(pull, seeds)

    def release(self) -> None:
        """Let the linearisation go."""
        self._pull = None


def compile_derivatives(
    function: Function, static: Hashable, constants: Any, inputs: Arrays, outputs: Shapes
) -> None:
    """Begin to compile what reverse products take, in other threads.

    Parameters
    ----------
    function, static, constants, inputs
        Function and its arguments, as `FunctionDerivatives` takes them.
    outputs : dict of tuples of int
        Shapes of those of its results that are differentiated, in their order there.
    """
    seeds = {name: np.zeros(shape) for name, shape in outputs.items()}

    def pull_back(pull: Any) -> None:
        compile_ahead(_pull_back, pull, seeds)

    linearisation = function, static, tuple(outputs), constants, inputs
    compile_ahead(_linearise, *linearisation, then=pull_back)


def _chosen(
    function: Function, static: Hashable, outputs: tuple[str, ...], constants: Any
) -> Callable[[Arrays], Arrays]:
    def chosen(inputs: Arrays) -> Arrays:
        values = function(inputs, constants, static)
        return {name: values[name] for name in outputs}

    return chosen


@partial(compiled, static_argnums=(0, 1, 2))
def _push(
    function: Function,
    static: Hashable,
    outputs: tuple[str, ...],
    constants: Any,
    inputs: Arrays,
    seeds: Arrays,
) -> Arrays:
    return jax.jvp(_chosen(function, static, outputs, constants), (inputs,), (seeds,))[1]


@partial(compiled, static_argnums=(0, 1, 2), optimisation=1)
def _linearise(
    function: Function,
    static: Hashable,
    outputs: tuple[str, ...],
    constants: Any,
    inputs: Arrays,
) -> PackedArrays:
    return packed(jax.vjp(_chosen(function, static, outputs, constants), inputs)[1])


@partial(compiled, optimisation=1)
def _pull_back(pull: PackedArrays, seeds: Arrays) -> Arrays:
    products: Arrays = pull.unpacked()(seeds)[0]
    return products

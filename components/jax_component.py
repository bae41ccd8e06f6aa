"""What the components share: a jitted function of arrays as compute and derivative products."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Mapping
from functools import partial
from typing import Any

import jax
import numpy as np
import openmdao.api as om

Arrays = dict[str, jax.Array]
Function = Callable[[Arrays, Any, Any], Arrays]


class JaxComponent(om.ExplicitComponent):
    """Explicit component around one pure function, with matrix-free exact derivatives.

    It declares nothing. A subclass declares its variables in ``setup`` and there gives

    - ``function(inputs, constants, static) -> outputs``: a module-level function of dictionaries of
      arrays by variable name, so that compiled code is shared by all instances;
    - ``constants``: arrays (any pytree) that are no inputs;
    - ``static``: what is hashable and fixed at compile time.
    """

    function: Function
    constants: Any = None
    static: Hashable = None

    def compute(self, inputs: Any, outputs: Any) -> None:
        values = _evaluate(self.function, self.static, self.constants, _arrays(inputs))
        self.check(inputs, values)
        for name in outputs:
            outputs[name] = values[name]

    def check(self, inputs: Any, values: Mapping[str, jax.Array]) -> None:
        """Raise ``om.AnalysisError`` where the values have no meaning; by default never.

        Parameters
        ----------
        inputs : mapping
            Inputs by name.
        values : mapping
            What ``function`` returned: the outputs, and whatever the check needs beside them.
        """

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        at = self.function, self.static, self.constants, _arrays(inputs)
        if mode == "fwd":
            seeds = {n: d_inputs[n] if n in d_inputs else np.zeros_like(inputs[n]) for n in inputs}
            for name, product in _forward(*at, tuple(d_outputs), seeds).items():
                d_outputs[name] += product
        else:
            products = _reverse(*at, {name: np.array(d_outputs[name]) for name in d_outputs})
            for name in d_inputs:
                d_inputs[name] += products[name]


def _arrays(vector: Any) -> dict[str, np.ndarray]:
    """Copy: OpenMDAO's views change while JAX may still read them."""
    return {name: np.array(vector[name]) for name in vector}


@partial(jax.jit, static_argnums=(0, 1))
def _evaluate(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    return function(inputs, constants, static)


@partial(jax.jit, static_argnums=(0, 1, 4))
def _forward(
    function: Function,
    static: Hashable,
    constants: Any,
    inputs: Arrays,
    of: tuple[str, ...],
    seeds: Arrays,
) -> Arrays:
    def chosen(x: Arrays) -> Arrays:
        values = function(x, constants, static)
        return {name: values[name] for name in of}

    return jax.jvp(chosen, (inputs,), (seeds,))[1]


@partial(jax.jit, static_argnums=(0, 1))
def _reverse(
    function: Function, static: Hashable, constants: Any, inputs: Arrays, seeds: Arrays
) -> Arrays:
    def chosen(x: Arrays) -> Arrays:
        values = function(x, constants, static)
        return {name: values[name] for name in seeds}

    return jax.vjp(chosen, inputs)[1](seeds)[0]

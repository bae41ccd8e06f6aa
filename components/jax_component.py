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
        values = evaluate(self.function, self.static, self.constants, arrays(inputs))
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
        # Every output always takes part, if only with zeros: compiling for each combination that
        # OpenMDAO asks for would take far longer than the products.
        outputs = self.get_io_metadata(iotypes="output", metadata_keys=["shape"])
        at = self.function, self.static, self.constants, arrays(inputs)
        if mode == "fwd":
            seeds = {
                n: np.array(d_inputs[n]) if n in d_inputs else np.zeros_like(inputs[n])
                for n in inputs
            }
            products = forward(*at, tuple(outputs), seeds)
            for name in d_outputs:
                d_outputs[name] += products[name]
        else:
            seeds = {
                name: np.array(d_outputs[name]) if name in d_outputs else np.zeros(meta["shape"])
                for name, meta in outputs.items()
            }
            products = reverse(*at, seeds)
            for name in d_inputs:
                d_inputs[name] += products[name]


def arrays(vector: Any) -> dict[str, Any]:
    """Copy a vector's values, because its views change while JAX may still read them.

    Parameters
    ----------
    vector : mapping
        OpenMDAO vector.

    Returns
    -------
    dict of arrays
        Values by name.
    """
    return {name: np.array(vector[name]) for name in vector}


@partial(jax.jit, static_argnums=(0, 1))
def evaluate(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    """Return ``function(inputs, constants, static)``, compiled."""
    return function(inputs, constants, static)


@partial(jax.jit, static_argnums=(0, 1, 4))
def forward(
    function: Function,
    static: Hashable,
    constants: Any,
    inputs: Arrays,
    of: tuple[str, ...],
    seeds: Arrays,
) -> Arrays:
    """Return derivatives of the outputs `of` along the direction `seeds`, one for each input."""

    def chosen(x: Arrays) -> Arrays:
        values = function(x, constants, static)
        return {name: values[name] for name in of}

    return jax.jvp(chosen, (inputs,), (seeds,))[1]


@partial(jax.jit, static_argnums=(0, 1))
def reverse(
    function: Function, static: Hashable, constants: Any, inputs: Arrays, seeds: Arrays
) -> Arrays:
    """Return derivatives by every input of the sum of the outputs weighted with `seeds`."""

    def chosen(x: Arrays) -> Arrays:
        values = function(x, constants, static)
        return {name: values[name] for name in seeds}

    return jax.vjp(chosen, inputs)[1](seeds)[0]

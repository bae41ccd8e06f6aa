"""Base class of the components: a jitted function as compute and derivative products."""

from __future__ import annotations

from collections.abc import Hashable, Mapping, Sequence
from operator import itemgetter
from typing import Any

import jax
import numpy as np
import openmdao.api as om

from propmdao.components.bases.array_function import (
    Arrays,
    Derivatives,
    Function,
    FunctionDerivatives,
    Shapes,
    evaluate,
    evaluate_all,
)
from propmdao.components.bases.last_points import LastPoints


class JaxComponent(om.ExplicitComponent):
    """Explicit component around one pure function, with matrix-free exact derivatives.

    It declares nothing. A subclass declares its variables in ``setup`` and there gives

    - ``function(inputs, constants, static) -> outputs``: a module-level function of dictionaries of
      arrays by variable name, so that compiled code is shared by all instances;
    - ``constants``: arrays (any pytree) that are no inputs;
    - ``static``: what is hashable and fixed at compile time.

    Every output always takes part in derivatives, if only with zeros: compiling for each
    combination that OpenMDAO asks for would take far longer than the products.
    """

    function: Function
    constants: Any = None
    static: Hashable = None

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._linearised = LastPoints(self._derivatives_to_keep, self.n_points)

    def compute(self, inputs: Any, outputs: Any) -> None:
        values = self.values_at(copied(inputs))
        for name in outputs:
            outputs[name] = values[name]

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        point = copied(inputs)
        derivatives = self._linearised(point)
        if mode == "fwd":
            shapes: Shapes = {name: value.shape for name, value in point.items()}
            products = derivatives.forward(complete_seeds(d_inputs, shapes))
            for name in d_outputs:
                d_outputs[name] += products[name]
        else:
            products = derivatives.reverse(complete_seeds(d_outputs, self.output_shapes()))
            for name in d_inputs:
                d_inputs[name] += products[name]

    def evaluate_designs(
        self, designs: Sequence[Arrays], batch_size: int
    ) -> list[Arrays | om.AnalysisError]:
        """Outputs at several designs, from one call of the compiled function.

        Parameters
        ----------
        designs : sequence of dicts of arrays
            Inputs by name, of each design.
        batch_size : int
            Number of designs that the code is compiled for; there are no more than these.

        Returns
        -------
        list of dicts of arrays, or of om.AnalysisError
            Outputs by name of each design, or why it has none.
        """
        return self._evaluate_points(designs, batch_size)

    def _evaluate_points(
        self, points: Sequence[Arrays], batch_size: int
    ) -> list[Arrays | om.AnalysisError]:
        if not points:
            return []
        batch = [*points, *[points[-1]] * (batch_size - len(points))]
        inputs = {name: np.stack([point[name] for point in batch]) for name in points[0]}
        function, constants = self.evaluated()
        values = jax.device_get(evaluate_all(function, self.static, constants, inputs))
        return [
            self._checked(point, jax.tree.map(itemgetter(place), values))
            for place, point in enumerate(points)
        ]

    def _checked(self, inputs: Arrays, values: Arrays) -> Arrays | om.AnalysisError:
        try:
            self.check(inputs, values)
        except om.AnalysisError as error:
            return error
        return {name: values[name] for name in self.output_shapes()}

    def evaluated(self) -> tuple[Function, Any]:
        """Function that `compute` calls, and its constants; a `RootComponent` searches first."""
        return self.function, self.constants

    def n_points(self) -> int:
        """Number of points that the component works at before it comes back to the first.

        Returns
        -------
        int
            One, unless a subclass knows better.
        """
        return 1

    def output_shapes(self) -> Shapes:
        """Shapes of the outputs that `function` returns.

        Returns
        -------
        dict of tuples of int
            Shapes by output name.
        """
        outputs = self.get_io_metadata(iotypes="output", metadata_keys=["shape"])
        return {name: meta["shape"] for name, meta in outputs.items()}

    def values_at(self, inputs: Arrays) -> Mapping[str, Any]:
        """Evaluate the function and check what it returns.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name.

        Returns
        -------
        mapping
            Outputs by name, and whatever else the function returns.

        Raises
        ------
        om.AnalysisError
            When `check` raises it.
        """
        function, constants = self.evaluated()
        values = evaluate(function, self.static, constants, inputs)
        self.check(inputs, values)
        return values

    def derivatives_at(self, inputs: Arrays) -> Derivatives:
        """Derivatives of the outputs by the inputs.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name.

        Returns
        -------
        Derivatives
            Derivatives for any number of products at these inputs.
        """
        outputs = tuple(self.output_shapes())
        return FunctionDerivatives(self.function, self.static, self.constants, inputs, outputs)

    def _derivatives_to_keep(self, inputs: Arrays) -> Derivatives:
        """Derivatives in the form that is kept for further products at the same inputs."""
        return self.derivatives_at(inputs)

    def check(self, inputs: Any, values: Mapping[str, Any]) -> None:
        """Raise ``om.AnalysisError`` where the values have no meaning; by default never.

        Parameters
        ----------
        inputs : mapping
            Inputs by name.
        values : mapping
            Results of ``function`` by name: the outputs, and whatever the check needs beside them.
        """


def copied(vector: Any) -> Arrays:
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


def complete_seeds(vector: Any, shapes: Shapes) -> Arrays:
    """Seeds of all variables, zero where OpenMDAO gives none.

    Parameters
    ----------
    vector : mapping
        OpenMDAO vector of the seeds.
    shapes : dict of tuples of int
        Shapes of all variables by name.

    Returns
    -------
    dict of arrays
        Seeds by name.
    """
    return {
        name: np.array(vector[name]) if name in vector else np.zeros(shape)
        for name, shape in shapes.items()
    }

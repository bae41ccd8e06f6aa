"""Base class of the components: a jitted function as compute and derivative products."""

from __future__ import annotations

from typing import Any
from weakref import WeakSet

import numpy as np

from propmdao.components.bases.array_function import (
    Arrays,
    Derivatives,
    FunctionDerivatives,
    Shapes,
    compile_derivatives,
)
from propmdao.components.bases.function_at_points import FunctionAtPoints, copied
from propmdao.components.bases.last_points import LastPoints
from propmdao.components.bases.refusals import (
    require_finite_products,
    require_real,
)
from propmdao.components.bases.variable_meanings import MEANINGS

_components: WeakSet[JaxComponent] = WeakSet()


class JaxComponent(FunctionAtPoints):
    """Explicit component around one pure function, with matrix-free exact derivatives.

    It declares nothing. A subclass declares its variables in ``setup`` and there gives

    - ``function(inputs, constants, static) -> outputs``: a module-level function of dictionaries of
      arrays by variable name, so that compiled code is shared by all instances;
    - ``constants``: arrays (any pytree) that are no inputs;
    - ``static``: what is hashable and fixed at compile time.

    Every output always takes part in derivatives, if only with zeros: compiling for each
    combination that OpenMDAO asks for would take far longer than the products.
    """

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._linearised = LastPoints(self._derivatives_to_keep, self.n_points)
        self._has_begun = False  # with its derivatives
        _components.add(self)

    def add_input(self, name: str, *values: Any, **metadata: Any) -> Any:
        """Declare an input, as in OpenMDAO, with what its name means."""
        return super().add_input(name, *values, **{"desc": MEANINGS.get(name, "")} | metadata)

    def add_output(self, name: str, *values: Any, **metadata: Any) -> Any:
        """Declare an output, as in OpenMDAO, with what its name means."""
        return super().add_output(name, *values, **{"desc": MEANINGS.get(name, "")} | metadata)

    def compute(self, inputs: Any, outputs: Any) -> None:
        require_real(self)
        values = self.values_at(copied(inputs))
        for name in outputs:
            outputs[name] = values[name]

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        require_real(self)
        point = copied(inputs)
        if mode == "rev":
            self.begin_reverse()
        derivatives = self._linearised(point)
        if mode == "fwd":
            shapes: Shapes = {name: value.shape for name, value in point.items()}
            seeds = complete_seeds(d_inputs, shapes)
            products, sums = derivatives.forward(seeds, tuple(d_outputs)), d_outputs
        else:
            seeds = complete_seeds(d_outputs, self.output_shapes())
            products, sums = derivatives.reverse(seeds), d_inputs
        require_finite_products(products, seeds)
        for name in sums:
            sums[name] += products[name]

    def compile_derivatives(self, inputs: Arrays) -> None:
        """Begin to compile the derivatives in other threads, at inputs with a result.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name, of one point.
        """
        shapes = self.output_shapes()
        compile_derivatives(self.function, self.static, self.constants, inputs, shapes)

    def begin_reverse(self) -> None:
        """Begin to compile the derivatives of all components of the model that are asked for.

        They are independent of each other, and so are compiled side by side.
        """
        if self._has_begun:
            return
        of_model = [other for other in _components if other._problem_meta is self._problem_meta]
        with self._relevance.all_seeds_active():
            asked = [c for c in of_model if self._relevance.is_relevant_system(c.pathname)]
        for component in asked:
            if not component._has_begun:
                component._has_begun = True
                component.compile_derivatives(component.first_point())

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

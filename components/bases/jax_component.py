"""Base class of the components: a jitted function as compute and derivative products."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
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
from propmdao.components.bases.refusals import (
    require_finite_products,
    require_numbers,
    require_real,
)
from propmdao.components.bases.variable_meanings import MEANINGS
from propmdao.runtime.finite import Axis


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
    #: Words for the axes of outputs, for messages.
    axes: Mapping[str, tuple[Axis, ...]] = {}

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._linearised = LastPoints(self._derivatives_to_keep, self.n_points)

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
        derivatives = self._linearised(point)
        if mode == "fwd":
            shapes: Shapes = {name: value.shape for name, value in point.items()}
            seeds = complete_seeds(d_inputs, shapes)
            products, sums = derivatives.forward(seeds), d_outputs
        else:
            seeds = complete_seeds(d_outputs, self.output_shapes())
            products, sums = derivatives.reverse(seeds), d_inputs
        require_finite_products(products, seeds)
        for name in sums:
            sums[name] += products[name]

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
        refusals = [_error(self.check_inputs, point) for point in points]
        good = [point for point, refusal in zip(points, refusals, strict=True) if not refusal]
        evaluated = iter(self._evaluate_good_points(good, batch_size))
        return [refusal or next(evaluated) for refusal in refusals]

    def _evaluate_good_points(
        self, points: Sequence[Arrays], batch_size: int
    ) -> list[Arrays | om.AnalysisError]:
        if not points:
            return []
        results: list[Arrays | om.AnalysisError] = []
        for point, here in zip(points, self.found_at_all(points, batch_size), strict=True):
            outputs = {name: here[name] for name in self.output_shapes()}
            results.append(_error(self._check_results, point, here) or outputs)
        return results

    def _check_results(self, inputs: Arrays, values: Mapping[str, Any]) -> None:
        self.check(inputs, values)
        self.require_numbers(inputs, values)

    def evaluated(self) -> tuple[Function, Any]:
        """Function that `compute` calls, and its constants; a `RootComponent` searches first."""
        return self.function, self.constants

    def found_at(self, inputs: Arrays) -> Mapping[str, Any]:
        """Evaluate the function at inputs that have been checked.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name.

        Returns
        -------
        mapping
            What the function returns.
        """
        function, constants = self.evaluated()
        return evaluate(function, self.static, constants, inputs)

    def found_at_all(
        self, points: Sequence[Arrays], batch_size: int
    ) -> Iterable[Mapping[str, Any]]:
        """Evaluate the function at several points at once.

        Parameters
        ----------
        points : sequence of dicts of arrays
            Inputs by name that have been checked, at one point at least.
        batch_size : int
            Number of points that the code is compiled for; there are no more than these.

        Returns
        -------
        iterable of mappings
            What the function returns at each point.
        """
        batch = [*points, *[points[-1]] * (batch_size - len(points))]
        inputs = {name: np.stack([point[name] for point in batch]) for name in points[0]}
        function, constants = self.evaluated()
        values = jax.device_get(evaluate_all(function, self.static, constants, inputs))
        return (jax.tree.map(itemgetter(place), values) for place in range(len(points)))

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
        """Check the inputs, evaluate the function and check what it returns.

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
            When `check_inputs` or `check` raises it, or an output is not finite.
        """
        self.check_inputs(inputs)
        values = self.found_at(inputs)
        self._check_results(inputs, values)
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

    def check_inputs(self, inputs: Arrays) -> None:
        """Raise ``om.AnalysisError`` for inputs that mean nothing, before the work.

        By default for those that are not finite; subclasses add theirs.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name.
        """
        require_numbers("input ", inputs)

    def require_numbers(self, inputs: Arrays, values: Mapping[str, Any]) -> None:
        """Raise ``om.AnalysisError`` where an output is not finite.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs by name; rotation and flight speed are named in the message.
        values : mapping
            Results of ``function`` by name.
        """
        outputs = {name: values[name] for name in self.output_shapes()}
        known = {**outputs, **inputs}
        point = [
            f"{np.asarray(known[name]).item():g} {unit}"
            for name, unit in (("rpm", "rpm"), ("speed", "m/s"))
            if name in known
        ]
        where = f", at {' and '.join(point)}" if point else ""
        require_numbers("", outputs, self.axes, where)

    def check(self, inputs: Any, values: Mapping[str, Any]) -> None:
        """Raise ``om.AnalysisError`` where the values have no meaning; by default never.

        Parameters
        ----------
        inputs : mapping
            Inputs by name.
        values : mapping
            Results of ``function`` by name: the outputs, and whatever the check needs beside them.
        """


def _error(check: Callable[..., None], *values: Any) -> om.AnalysisError | None:
    """Error that a check raises, or None."""
    try:
        check(*values)
    except om.AnalysisError as error:
        return error
    return None


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

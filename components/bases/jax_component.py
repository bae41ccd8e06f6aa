"""What the components share: a jitted function of arrays as compute and derivative products."""

from __future__ import annotations

from collections import deque
from collections.abc import Callable, Hashable, Mapping, Sequence
from functools import partial
from operator import itemgetter
from typing import Any, Generic, Protocol, TypeVar

import jax
import numpy as np
import openmdao.api as om

from propmdao.runtime.compilation import compiled

Arrays = dict[str, Any]  # of NumPy or JAX, by variable name
Function = Callable[[Arrays, Any, Any], Arrays]
Shapes = dict[str, tuple[int, ...]]
Result = TypeVar("Result")


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
        self._linearised = LastPoints(self.derivatives_at, self.n_points)

    def compute(self, inputs: Any, outputs: Any) -> None:
        values = self.values_at(arrays(inputs))
        for name in outputs:
            outputs[name] = values[name]

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        at = arrays(inputs)
        derivatives = self._linearised(at)
        if mode == "fwd":
            shapes: Shapes = {name: value.shape for name, value in at.items()}
            products = derivatives.forward(seeds_of(d_inputs, shapes))
            for name in d_outputs:
                d_outputs[name] += products[name]
        else:
            products = derivatives.reverse(seeds_of(d_outputs, self.output_shapes()))
            for name in d_inputs:
                d_inputs[name] += products[name]

    def at_designs(
        self, designs: Sequence[Arrays], at_once: int
    ) -> list[Arrays | om.AnalysisError]:
        """Outputs at several designs, from one call of the compiled function.

        Parameters
        ----------
        designs : sequence of dicts of arrays
            Inputs by name, of each design.
        at_once : int
            Number of designs that the code is compiled for; there are no more than these.

        Returns
        -------
        list of dicts of arrays, or of om.AnalysisError
            Outputs by name of each design, or why it has none.
        """
        return self._at_points(designs, at_once)

    def _at_points(self, points: Sequence[Arrays], at_once: int) -> list[Arrays | om.AnalysisError]:
        if not points:
            return []
        filled = [*points, *[points[-1]] * (at_once - len(points))]
        inputs = {name: np.stack([point[name] for point in filled]) for name in points[0]}
        values = jax.device_get(evaluate_all(self.evaluated(), self.static, self.constants, inputs))
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

    def evaluated(self) -> Function:
        """Return what is evaluated for the outputs: `function`, or a search that precedes it."""
        return self.function

    def n_points(self) -> int:
        """Points at which the component works at a time.

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
            By name.
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
            As `check` does.
        """
        values = evaluate(self.evaluated(), self.static, self.constants, inputs)
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
            For any number of products at these inputs.
        """
        outputs = tuple(self.output_shapes())
        return FunctionDerivatives(self.function, self.static, self.constants, inputs, outputs)

    def check(self, inputs: Any, values: Mapping[str, Any]) -> None:
        """Raise ``om.AnalysisError`` where the values have no meaning; by default never.

        Parameters
        ----------
        inputs : mapping
            Inputs by name.
        values : mapping
            What ``function`` returned: the outputs, and whatever the check needs beside them.
        """


class Derivatives(Protocol):
    """Derivatives at one point, as products by seeds that are dictionaries of all variables."""

    def forward(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives of the outputs along the direction `seeds`, one for each input."""

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives by every input of the sum of the outputs weighted with `seeds`."""


class FunctionDerivatives:
    """Derivatives of a function, linearised once for all reverse products.

    Parameters
    ----------
    function, static, constants, inputs
        As `evaluate` takes them.
    outputs : tuple of str
        Which of its results are differentiated.
    """

    def __init__(
        self,
        function: Function,
        static: Hashable,
        constants: Any,
        inputs: Arrays,
        outputs: tuple[str, ...],
    ) -> None:
        self._at = function, static, outputs, constants, inputs
        self._pull: Any = None

    def forward(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives of the outputs along the direction `seeds`, one for each input."""
        products: Arrays = _push(*self._at, seeds)
        return products

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        """Return derivatives by every input of the sum of the outputs weighted with `seeds`."""
        if self._pull is None:
            self._pull = _linearise(*self._at)
        return _pull_back(self._pull, seeds)


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


def seeds_of(given: Any, shapes: Shapes) -> dict[str, Any]:
    """Seeds of all variables, zero where OpenMDAO gives none.

    Parameters
    ----------
    given : mapping
        OpenMDAO vector of the seeds.
    shapes : dict of tuples of int
        Of all variables by name.

    Returns
    -------
    dict of arrays
        Seeds by name.
    """
    return {
        name: np.array(given[name]) if name in given else np.zeros(shape)
        for name, shape in shapes.items()
    }


class LastPoints(Generic[Result]):
    """A function of a point that remembers its results for the last points it was asked for.

    Points are the same where all values are equal to the last bit: nothing stale is ever returned.

    Parameters
    ----------
    function : callable
        Of a dictionary of arrays.
    n_points : callable
        Returns the number of points that are remembered.
    """

    def __init__(self, function: Callable[[Arrays], Result], n_points: Callable[[], int]) -> None:
        self._function, self._n_points = function, n_points
        self._results: deque[tuple[Arrays, Result]] = deque()

    def __call__(self, inputs: Arrays) -> Result:
        """Return the function's result, computed where the inputs are not those of a last point."""
        for point, result in self._results:
            if _same(point, inputs):
                return result
        result = self._function(inputs)
        self._results.append((inputs, result))
        while len(self._results) > self._n_points():
            self._results.popleft()
        return result


def _same(a: Arrays, b: Arrays) -> bool:
    # The small ones, as the speed, first: they tell points of one mesh apart.
    return all(np.array_equal(a[name], b[name]) for name in sorted(a, key=lambda n: a[n].size))


@partial(compiled, static_argnums=(0, 1))
def evaluate(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    """Return ``function(inputs, constants, static)``, compiled."""
    return function(inputs, constants, static)


@partial(compiled, static_argnums=(0, 1))
def evaluate_all(function: Function, static: Hashable, constants: Any, inputs: Arrays) -> Arrays:
    """Return the function's values where every input has a leading axis of points, compiled."""
    return jax.vmap(lambda at: function(at, constants, static))(inputs)


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


@partial(compiled, static_argnums=(0, 1, 2))
def _linearise(
    function: Function,
    static: Hashable,
    outputs: tuple[str, ...],
    constants: Any,
    inputs: Arrays,
) -> Any:
    return jax.vjp(_chosen(function, static, outputs, constants), inputs)[1]


@compiled
def _pull_back(pull: Any, seeds: Arrays) -> Arrays:
    products: Arrays = pull(seeds)[0]
    return products

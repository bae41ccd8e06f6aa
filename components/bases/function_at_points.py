"""Values of a component's function: at one point, or at several in one call, checked."""

from __future__ import annotations

from collections.abc import Callable, Hashable, Iterable, Mapping, Sequence
from typing import Any

import numpy as np
import openmdao.api as om

from propmdao.components.bases.array_function import (
    Arrays,
    Function,
    Shapes,
    evaluate,
    evaluate_all,
)
from propmdao.components.bases.refusals import require_numbers
from propmdao.runtime.compilation import memory_of
from propmdao.runtime.finite import Axis
from propmdao.runtime.side_by_side import side_by_side, stacked, taken_apart


class FunctionAtPoints(om.ExplicitComponent):
    """Explicit component around one pure function of arrays, without derivatives.

    What it is around, `JaxComponent` says.
    """

    function: Function
    constants: Any = None
    static: Hashable = None
    #: Words for the axes of outputs, for messages.
    axes: Mapping[str, tuple[Axis, ...]] = {}

    def first_point(self) -> Arrays:
        """Inputs of the first of the points that the component works at.

        Returns
        -------
        dict of arrays
            Inputs by name.
        """
        return copied(self._inputs)

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
        return [self._outputs_of(values) for values in self.values_at_all(designs, batch_size)]

    def _outputs_of(self, values: Mapping[str, Any] | om.AnalysisError) -> Any:
        """Outputs alone of what the function returns, or the error that it has instead."""
        if isinstance(values, om.AnalysisError):
            return values
        return {name: values[name] for name in self.output_shapes()}

    def values_at_all(
        self, points: Sequence[Arrays], batch_size: int
    ) -> list[Mapping[str, Any] | om.AnalysisError]:
        """Do at several points at once what `values_at` does at one.

        Parameters
        ----------
        points : sequence of dicts of arrays
            Inputs by name.
        batch_size : int
            Number of points that the code is compiled for; there are no more than these.

        Returns
        -------
        list of mappings, or of om.AnalysisError
            What the function returns at each point, or why it returns nothing.
        """
        refusals = [_error(self.check_inputs, point) for point in points]
        good = [point for point, refusal in zip(points, refusals, strict=True) if not refusal]
        results = self.found_at_all(good, batch_size) if good else []
        evaluated = (
            _error(self._check_results, point, result) or result
            for point, result in zip(good, results, strict=True)
        )
        return [refusal or next(evaluated) for refusal in refusals]

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
        if not self.in_one_call():
            return side_by_side(self.found_at, points)
        function, constants = self.evaluated()
        inputs = stacked(points, batch_size)
        return taken_apart(evaluate_all(function, self.static, constants, inputs), len(points))

    def batch_memory(self, batch_size: int) -> int:
        """Memory that `evaluate_designs` takes on each device, by the code that is compiled for it.

        Parameters
        ----------
        batch_size : int
            Number of designs that the code is compiled for.

        Returns
        -------
        int
            Bytes; 0 where designs are not evaluated in one call.
        """
        return self._points_memory(batch_size)

    def _points_memory(self, batch_size: int) -> int:
        if not self.in_one_call():
            return 0
        function, constants = self.evaluated()
        inputs = stacked([self.first_point()], batch_size)
        return memory_of(evaluate_all, function, self.static, constants, inputs)

    def in_one_call(self) -> bool:
        """Whether several points are evaluated in one call of the compiled function.

        Returns
        -------
        bool
            True, unless a subclass knows better.
        """
        return True

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

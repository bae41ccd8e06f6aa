"""Components whose function holds a scalar state, found by a search of the physics."""

from __future__ import annotations

from collections.abc import Collection, Mapping, Sequence
from functools import cached_property
from typing import Any, NamedTuple

import numpy as np
import openmdao.api as om

from propmdao.components.bases.array_function import (
    Arrays,
    Derivatives,
    Function,
    FunctionDerivatives,
    Shapes,
    compile_derivatives,
)
from propmdao.components.bases.jax_component import JaxComponent
from propmdao.components.bases.last_points import LastPoints


class RootComponent(JaxComponent):
    """Component around a function of inputs and a state, at the root of its residual.

    A subclass gives, beside what `JaxComponent` asks for,

    - ``function``: takes the state, a number (1,), among its inputs, and returns the residual, also
      (1,), among its outputs; both names are no variables of the component;
    - ``state``, ``residual``: these two names;
    - ``state_outputs``: outputs (1,) that are the state in other units, with what it is multiplied
      by;
    - ``search``: a function like ``function`` that finds the state: it takes the inputs alone, and
      returns the outputs, the state and whatever ``check`` needs;
    - ``search_constants``: its constants, those of ``function`` and whatever bounds the search.
      Where `found_at` chooses among several, it returns those of ``function``, under the name
      "constants", with what it has found.

    Derivatives are those of the implicit function: with the function linearised once at the root,
    whose gradient of the residual serves all products, no search is repeated or differentiated.
    """

    search: Function
    search_constants: Any
    state: str
    residual: str
    state_outputs: Mapping[str, float] = {}

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._searched = LastPoints(super().values_at, self.n_points)

    def evaluated(self) -> tuple[Function, Any]:
        return self.search, self.search_constants

    def values_at(self, inputs: Arrays) -> Mapping[str, Any]:
        return self._searched(inputs)  # which derivatives ask for again

    def values_at_all(
        self, points: Sequence[Arrays], batch_size: int
    ) -> list[Mapping[str, Any] | om.AnalysisError]:
        known = [self._searched.known(point) for point in points]
        new = [point for point, values in zip(points, known, strict=True) if values is None]
        solutions = super().values_at_all(new, batch_size)
        for point, values in zip(new, solutions, strict=True):
            if not isinstance(values, om.AnalysisError):
                self._searched.keep(point, values)
        searched = iter(solutions)
        return [next(searched) if values is None else values for values in known]

    def constants_of(self, solution: Mapping[str, Any]) -> Any:
        """Constants of ``function`` that go with what was found.

        Parameters
        ----------
        solution : mapping
            What `found_at` returned.

        Returns
        -------
        pytree
            Constants with which the state is a root.
        """
        return solution.get("constants", self.constants)

    def compile_derivatives(self, inputs: Arrays) -> None:
        if solution := self._searched.last():
            root = {**inputs, self.state: solution[self.state]}
            outputs = {**self.output_shapes(), self.residual: (1,)}
            compile_derivatives(
                self.function, self.static, self.constants_of(solution), root, outputs
            )

    def derivatives_at(self, inputs: Arrays) -> Derivatives:
        solution = self._searched(inputs)
        root = {**inputs, self.state: solution[self.state]}
        shapes = self.output_shapes()
        derivatives = FunctionDerivatives(
            self.function, self.static, self.constants_of(solution), root, (*shapes, self.residual)
        )
        return _RootDerivatives(derivatives, shapes, self.state, self.residual, self.state_outputs)


class _Gradient(NamedTuple):
    """Derivatives of a scalar by every input and by the state."""

    by_inputs: Arrays
    by_state: float


class _RootDerivatives:
    """Derivatives of the implicit function: dx = -(r_p dp) / r_x with the residual r(p, x) = 0."""

    def __init__(
        self,
        function: Derivatives,
        shapes: Shapes,
        state: str,
        residual: str,
        state_outputs: Mapping[str, float],
    ) -> None:
        self._function, self._shapes = function, shapes
        self._state, self._residual, self._state_outputs = state, residual, state_outputs

    def forward(self, seeds: Arrays, outputs: Collection[str]) -> Mapping[str, Any]:
        by_inputs, by_state = self._residual_gradient
        change = sum(np.vdot(by_inputs[name], np.asarray(seed)) for name, seed in seeds.items())
        direction = {**seeds, self._state: np.array([-change / by_state])}
        return self._function.forward(direction, outputs)

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        residual = self._residual_gradient
        if any(np.any(seed) for name, seed in seeds.items() if name not in self._state_outputs):
            products, by_root = self._pull(seeds, 0.0)
        else:  # the root alone is asked for
            products = {name: np.zeros_like(value) for name, value in residual.by_inputs.items()}
            by_root = sum(scale * seeds[n].item() for n, scale in self._state_outputs.items())
        factor = -by_root / residual.by_state
        return {name: value + factor * residual.by_inputs[name] for name, value in products.items()}

    def release(self) -> None:
        self._function.release()

    @cached_property
    def _residual_gradient(self) -> _Gradient:
        return self._pull({name: np.zeros(shape) for name, shape in self._shapes.items()}, 1.0)

    def _pull(self, seeds: Arrays, residual_seed: float) -> _Gradient:
        """Gradient of the outputs and the residual, weighted with their seeds."""
        seeds = {**seeds, self._residual: np.array([residual_seed])}
        products = {n: np.asarray(v) for n, v in self._function.reverse(seeds).items()}
        (by_state,) = products.pop(self._state)
        return _Gradient(products, by_state)

"""Components whose function holds a scalar state, found by a search of the physics."""

from __future__ import annotations

from collections.abc import Mapping
from functools import cached_property
from typing import Any

import numpy as np

from propmdao.components.bases.jax_component import (
    Arrays,
    Derivatives,
    Function,
    FunctionDerivatives,
    JaxComponent,
    LastPoints,
    Shapes,
)


class RootComponent(JaxComponent):
    """Component around a function of inputs and a state, at the root of its residual.

    A subclass gives, beside what `JaxComponent` asks for,

    - ``function``: takes the state, a number (1,), among its inputs, and returns the residual, also
      (1,), among its outputs; both names are no variables of the component;
    - ``state``, ``residual``: these two names;
    - ``of_state``: outputs (1,) that are the state in other units, with what it is multiplied by;
    - ``search``: a function like ``function`` that finds the state: it takes the inputs alone, and
      returns the outputs, the state and whatever ``check`` needs.

    Derivatives are those of the implicit function: with the function linearised once at the root,
    whose gradient of the residual serves all products, no search is repeated or differentiated.
    """

    search: Function
    state: str
    residual: str
    of_state: Mapping[str, float] = {}

    def __init__(self, **options: Any) -> None:
        super().__init__(**options)
        self._found = LastPoints(super().values_at, self.n_points)

    def evaluated(self) -> Function:
        return self.search

    def values_at(self, inputs: Arrays) -> Mapping[str, Any]:
        return self._found(inputs)  # which derivatives ask for again

    def derivatives_at(self, inputs: Arrays) -> Derivatives:
        at = {**inputs, self.state: self._found(inputs)[self.state]}
        shapes = self.output_shapes()
        function = self.function, self.static, self.constants
        of_function = FunctionDerivatives(*function, at, (*shapes, self.residual))
        return _AtRoot(of_function, shapes, self.state, self.residual, self.of_state)


class _AtRoot:
    """Derivatives of the implicit function: dx = -(r_p dp) / r_x with the residual r(p, x) = 0."""

    def __init__(
        self,
        of_function: Derivatives,
        shapes: Shapes,
        state: str,
        residual: str,
        of_state: Mapping[str, float],
    ) -> None:
        self._function, self._shapes = of_function, shapes
        self._state, self._residual, self._of_state = state, residual, of_state

    def forward(self, seeds: Arrays) -> Mapping[str, Any]:
        by_inputs, by_state = self._gradient_of_residual
        change = sum(np.vdot(by_inputs[name], np.asarray(seed)) for name, seed in seeds.items())
        along = {**seeds, self._state: np.array([-change / by_state])}
        return self._function.forward(along)

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        by_inputs, by_state = self._gradient_of_residual
        if any(np.any(seed) for name, seed in seeds.items() if name not in self._of_state):
            products, by_root = self._pull(seeds, 0.0)
        else:  # the root alone is asked for
            products = {name: np.zeros_like(value) for name, value in by_inputs.items()}
            by_root = sum(scale * seeds[n].item() for n, scale in self._of_state.items())
        factor = -by_root / by_state
        return {name: value + factor * by_inputs[name] for name, value in products.items()}

    @cached_property
    def _gradient_of_residual(self) -> tuple[dict[str, Any], float]:
        return self._pull({name: np.zeros(shape) for name, shape in self._shapes.items()}, 1.0)

    def _pull(self, seeds: Arrays, of_residual: float) -> tuple[dict[str, Any], float]:
        seeds = {**seeds, self._residual: np.array([of_residual])}
        products = {n: np.asarray(v) for n, v in self._function.reverse(seeds).items()}
        (by_state,) = products.pop(self._state)
        return products, by_state

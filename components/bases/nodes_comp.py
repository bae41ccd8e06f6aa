"""Components at one operating point or at many, as missions and multi-point design ask."""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from itertools import compress
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.components.bases.jax_component import (
    Arrays,
    Derivatives,
    JaxComponent,
    LastPoints,
    Shapes,
    arrays,
    seeds_of,
)

#: Tells Dymos that an input has no axis of nodes.
STATIC = ["dymos.static_target"]
Shape = tuple[int, ...]


def declare_num_nodes(options: OptionsDictionary) -> None:
    """Declare the number of operating points.

    Parameters
    ----------
    options : OptionsDictionary
        Of a component or group.
    """
    options.declare(
        "num_nodes",
        None,
        types=int,
        lower=1,
        allow_none=True,
        desc="Operating points, the leading axis of all that belongs to one; None: no such axis.",
    )


class OperatingPointsComp(JaxComponent):
    """Function of one operating point, evaluated at ``num_nodes`` of them.

    A subclass declares with `add_point_input` and `add_point_output` what belongs to an operating
    point, with OpenMDAO's own methods inputs that all of them share and outputs that never change.
    Its ``function`` knows of one point only. The points are gone through one by one: the compiled
    code is that of one point, whatever their number, so is the memory of an evaluation, and a point
    that no seed touches is not differentiated. A point that is differentiated keeps its
    linearisation until its inputs change; where all its outputs are scalars, their gradients alone:
    missions ask for many products at the same points.

    Options
    -------
    num_nodes : int or None
        Number of operating points, the leading axis of everything that belongs to one, also where
        it is 1. None: a single point without that axis.
    """

    def __init__(self, **options: Any) -> None:
        self._input_shapes: Shapes = {}
        self._output_shapes: Shapes = {}
        super().__init__(**options)
        self._linearised = LastPoints(self._linearise, self.n_points)

    def initialize(self) -> None:
        declare_num_nodes(self.options)

    def add_point_input(
        self, name: str, val: float = 0.0, *, shape: Shape = (), **metadata: Any
    ) -> None:
        """Declare an input of each operating point.

        Parameters
        ----------
        name : str
            Its name.
        val : float
            Initial value.
        shape : tuple of int
            At one point; () is a scalar, which ``function`` gets and returns as (1,).
        **metadata
            What ``add_input`` takes beside these.
        """
        self._input_shapes[name] = shape or (1,)
        self.add_input(name, val=np.full(self._full_shape(shape), val), **metadata)

    def add_point_output(
        self, name: str, val: float = 1.0, *, shape: Shape = (), **metadata: Any
    ) -> None:
        """Declare an output of each operating point, one that ``function`` returns.

        Parameters
        ----------
        name : str
            Its name.
        val : float
            Initial value.
        shape : tuple of int
            At one point; () is a scalar, which ``function`` gets and returns as (1,).
        **metadata
            What ``add_output`` takes beside these.
        """
        self._output_shapes[name] = shape or (1,)
        self.add_output(name, val=np.full(self._full_shape(shape), val), **metadata)

    def compute(self, inputs: Any, outputs: Any) -> None:
        still = dict.fromkeys(self._output_shapes, 0.0)
        for point, at in self._points(inputs):
            try:
                values = still if self.at_rest(at) else self.values_at(at)
            except om.AnalysisError as error:
                self._name_node(point, error)
                raise
            for name in self._output_shapes:
                self._at(point, name, outputs)[:] = values[name]

    def at_designs(
        self, designs: Sequence[Arrays], at_once: int
    ) -> list[Arrays | om.AnalysisError]:
        n = self.n_points()
        points = [at for design in designs for _, at in self._points(design)]
        moves = [not self.at_rest(at) for at in points]
        found = iter(self._at_points(list(compress(points, moves)), at_once * n))
        still: Arrays = dict.fromkeys(self._output_shapes, 0.0)
        values = [next(found) if moving else still for moving in moves]
        return [self._together(values[i : i + n]) for i in range(0, len(values), n)]

    def _together(self, values: Sequence[Arrays | om.AnalysisError]) -> Arrays | om.AnalysisError:
        """Outputs from those of all points, or the first error of one."""
        outputs = {name: np.zeros_like(self._outputs[name]) for name in self._output_shapes}
        for point, of_point in enumerate(values):
            if isinstance(of_point, om.AnalysisError):
                self._name_node(point, of_point)
                return of_point
            for name in outputs:
                self._at(point, name, outputs)[:] = of_point[name]
        return outputs

    def _name_node(self, point: int, error: om.AnalysisError) -> None:
        """Put the node into the message of an error, where there are several."""
        if self.options["num_nodes"] is not None:
            error.args = (f"node {point}: {error}",)

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        start, end = (d_inputs, d_outputs) if mode == "fwd" else (d_outputs, d_inputs)
        given = arrays(start)
        for point, at in self._points(inputs):
            shapes = {n: v.shape for n, v in at.items()} if mode == "fwd" else self._output_shapes
            seeds = seeds_of({name: self._at(point, name, given) for name in given}, shapes)
            if self.at_rest(at) or not any(seed.any() for seed in seeds.values()):
                continue
            derivatives = self._linearised(at)
            products = (derivatives.forward if mode == "fwd" else derivatives.reverse)(seeds)
            for name in end:
                if name in products:  # outputs that never change have none
                    self._at(point, name, end)[:] += products[name]

    def n_points(self) -> int:
        return self.options["num_nodes"] or 1

    def output_shapes(self) -> Shapes:
        return self._output_shapes

    def at_rest(self, inputs: Arrays) -> bool:
        """Whether all outputs and all derivatives of a point are zero without a calculation.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs of the point by name.

        Returns
        -------
        bool
            By default never.
        """
        return False

    def _linearise(self, inputs: Arrays) -> Derivatives:
        derivatives = self.derivatives_at(inputs)
        if all(shape == (1,) for shape in self._output_shapes.values()):
            return _Gradients(derivatives, tuple(self._output_shapes))
        return derivatives

    def _points(self, inputs: Any) -> Iterator[tuple[int, Arrays]]:
        """Points by number, and their inputs with those that all points share."""
        values = arrays(inputs)
        for point in range(self.n_points()):
            yield point, {name: self._at(point, name, values) for name in values}

    def _full_shape(self, shape: Shape) -> Shape:
        """Shape with the axis of nodes."""
        n = self.options["num_nodes"]
        return (shape or (1,)) if n is None else (n, *shape)

    def _at(self, point: int, name: str, values: Any) -> Any:
        """View of the part of a variable that belongs to a point, or of one that all share."""
        shape = self._input_shapes.get(name) or self._output_shapes.get(name)
        return values[name] if shape is None else values[name].reshape(-1, *shape)[point]


class _Gradients:
    """Derivatives of scalars as gradients, one product back for each."""

    def __init__(self, derivatives: Derivatives, scalars: tuple[str, ...]) -> None:
        zero = {name: np.zeros(1) for name in scalars}
        rows = [derivatives.reverse({**zero, of: np.ones(1)}) for of in scalars]
        self._scalars = scalars
        self._by = {name: np.stack([np.asarray(row[name]) for row in rows]) for name in rows[0]}

    def forward(self, seeds: Arrays) -> Mapping[str, Any]:
        # Most seeds are zero, and those of the blade, the large ones, where it is no variable.
        products = sum(
            np.tensordot(self._by[name], seed, axes=np.ndim(seed))
            for name, seed in seeds.items()
            if seed.any()
        )
        return dict(zip(self._scalars, np.atleast_1d(products), strict=True))

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        weights = np.concatenate([seeds[of] for of in self._scalars])
        return {name: np.tensordot(weights, by, axes=1) for name, by in self._by.items()}

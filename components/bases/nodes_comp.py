"""Components at one operating point or at many, as missions and multi-point design ask."""

from __future__ import annotations

import contextlib
from collections.abc import Collection, Iterator, Mapping, Sequence
from itertools import chain
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.components.bases.array_function import Arrays, Derivatives, Shapes
from propmdao.components.bases.function_at_points import copied
from propmdao.components.bases.jax_component import JaxComponent, complete_seeds
from propmdao.components.bases.refusals import require_finite_products, require_real
from propmdao.runtime.side_by_side import is_accelerated, side_by_side

#: Tells Dymos that an input has no axis of nodes.
STATIC = ["dymos.static_target"]
Shape = tuple[int, ...]


def declare_num_nodes(options: OptionsDictionary) -> None:
    """Declare the number of operating points.

    Parameters
    ----------
    options : OptionsDictionary
        Options of a component or group.
    """
    options.declare(
        "num_nodes",
        None,
        types=int,
        lower=1,
        allow_none=True,
        desc="Number of operating points, the leading axis of what belongs to one; None: no axis.",
    )


class NodesComp(JaxComponent):
    """Function of one operating point, evaluated at ``num_nodes`` of them.

    A subclass declares with `add_point_input` and `add_point_output` what belongs to an operating
    point, with OpenMDAO's own methods inputs that all of them share and outputs that never change.
    Its ``function`` knows of one point only. The points share the cores of the processor, one each:
    the compiled code is that of one point, whatever their number, so is the memory of an
    evaluation, and a point that no seed touches is not differentiated. `points_in_a_call` may put
    several into a call instead, and an accelerator has all of them in one. A point that is
    differentiated keeps its linearisation until its inputs change; where all its outputs are
    scalars and vectors in space, the gradients of those that have been asked for, for missions ask
    for many products at the same points.

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

    def initialize(self) -> None:
        declare_num_nodes(self.options)

    def add_point_input(
        self, name: str, val: float = 0.0, *, shape: Shape = (), **metadata: Any
    ) -> None:
        """Declare an input of each operating point.

        Parameters
        ----------
        name : str
            Name of the variable.
        val : float
            Initial value.
        shape : tuple of int
            Shape at one point; () is a scalar, which ``function`` gets and returns as (1,).
        **metadata
            Further arguments of ``add_input``: units, desc, tags ...
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
            Name of the variable.
        val : float
            Initial value.
        shape : tuple of int
            Shape at one point; () is a scalar, which ``function`` gets and returns as (1,).
        **metadata
            Further arguments of ``add_output``: units, desc, tags ...
        """
        self._output_shapes[name] = shape or (1,)
        self.add_output(name, val=np.full(self._full_shape(shape), val), **metadata)

    def compute(self, inputs: Any, outputs: Any) -> None:
        require_real(self)
        size = self.points_in_a_call()
        if size == 1:
            for node, values in enumerate(side_by_side(self._at_node, self._points(inputs))):
                for name in self._output_shapes:
                    self._view(node, name, outputs)[:] = values[name]
            return
        points = [point for _, point in self._points(inputs)]
        calls = [points[first : first + size] for first in range(0, len(points), size)]
        of_calls = side_by_side(lambda call: self._at_all_nodes(call, size), calls)
        together = self._together(list(chain.from_iterable(of_calls)))
        if isinstance(together, om.AnalysisError):
            raise together
        for name, value in together.items():
            outputs[name] = value

    def points_in_a_call(self) -> int:
        """Number of points that `compute` evaluates in a call, of which each core has its own.

        Returns
        -------
        int
            All on an accelerator; one on a processor, unless a subclass knows better.
        """
        return self.n_points() if is_accelerated() and self.in_one_call() else 1

    def _at_node(self, node_and_point: tuple[int, Arrays]) -> Mapping[str, Any]:
        """Values at a node's point."""
        node, point = node_and_point
        with self._naming(node):
            return self._at_rest(point) or self.values_at(point)

    def evaluate_designs(
        self, designs: Sequence[Arrays], batch_size: int
    ) -> list[Arrays | om.AnalysisError]:
        n = self.n_points()
        points = [point for design in designs for _, point in self._points(design)]
        values = self._at_all_nodes(points, batch_size * n)
        return [self._together(values[i : i + n]) for i in range(0, len(values), n)]

    def _at_all_nodes(
        self, points: Sequence[Arrays], batch_size: int
    ) -> list[Mapping[str, Any] | om.AnalysisError]:
        """Values at several points, or why a point has none, from one call."""
        resting = [self._at_rest_or_refused(point) for point in points]
        moving = [point for point, rest in zip(points, resting, strict=True) if rest is None]
        evaluated = iter(self.values_at_all(moving, batch_size))
        return [next(evaluated) if rest is None else rest for rest in resting]

    def batch_memory(self, batch_size: int) -> int:
        return self._points_memory(batch_size * self.n_points())

    def _at_rest(self, point: Arrays) -> Arrays | None:
        """Zeros for all outputs where nothing moves, inputs checked; None where something does."""
        if not self.at_rest(point):
            return None
        self.check_inputs(point)
        return dict.fromkeys(self._output_shapes, 0.0)

    def _at_rest_or_refused(self, point: Arrays) -> Arrays | om.AnalysisError | None:
        try:
            return self._at_rest(point)
        except om.AnalysisError as error:
            return error

    def _together(
        self, values: Sequence[Mapping[str, Any] | om.AnalysisError]
    ) -> Arrays | om.AnalysisError:
        """Outputs from those of all points, or the first error of one."""
        outputs = {name: np.zeros_like(self._outputs[name]) for name in self._output_shapes}
        for node, point_values in enumerate(values):
            if isinstance(point_values, om.AnalysisError):
                self._name_node(node, point_values)
                return point_values
            for name in outputs:
                self._view(node, name, outputs)[:] = point_values[name]
        return outputs

    def _name_node(self, node: int, error: om.AnalysisError) -> None:
        """Put the node into the message of an error, where there are several."""
        if self.options["num_nodes"] is not None:
            error.args = (f"node {node}: {error}",)

    @contextlib.contextmanager
    def _naming(self, node: int) -> Iterator[None]:
        """Put the node into the message of an error that is raised."""
        try:
            yield
        except om.AnalysisError as error:
            self._name_node(node, error)
            raise

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        require_real(self)
        if mode == "rev":
            self.begin_reverse()
        start, end = (d_inputs, d_outputs) if mode == "fwd" else (d_outputs, d_inputs)
        all_seeds = copied(start)
        outputs = [name for name in d_outputs if self._is_asked_for(name)]
        touched: list[tuple[int, Arrays, Arrays]] = []
        for node, point in self._points(inputs):
            node_seeds = {name: self._view(node, name, all_seeds) for name in all_seeds}
            input_shapes = {name: value.shape for name, value in point.items()}
            shapes = input_shapes if mode == "fwd" else self._output_shapes
            seeds = complete_seeds(node_seeds, shapes)
            if any(seed.any() for seed in seeds.values()) and not self.at_rest(point):
                touched.append((node, point, seeds))

        def products_at(node_and_seeds: tuple[int, Arrays, Arrays]) -> Mapping[str, Any]:
            node, point, seeds = node_and_seeds
            derivatives = self._linearised(point)
            products = (
                derivatives.forward(seeds, outputs) if mode == "fwd" else derivatives.reverse(seeds)
            )
            with self._naming(node):
                require_finite_products(products, seeds)
            return products

        for (node, *_), products in zip(touched, side_by_side(products_at, touched), strict=True):
            for name in end:
                if name in products:  # outputs that never change have none
                    self._view(node, name, end)[:] += products[name]

    def _is_asked_for(self, output: str) -> bool:
        """Whether derivatives of an output of points count for those of the model."""
        name = f"{self.pathname}.{output}" if self.pathname else output
        return output in self._output_shapes and bool(self._relevance.is_relevant(name))

    def first_point(self) -> Arrays:
        return next(point for _, point in self._points(self._inputs))

    def n_points(self) -> int:
        return self.options["num_nodes"] or 1

    def output_shapes(self) -> Shapes:
        return self._output_shapes

    def at_rest(self, inputs: Arrays) -> bool:
        """Return True where all outputs and derivatives of a point are zero without a calculation.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs of the point by name.

        Returns
        -------
        bool
            False, unless a subclass knows better.
        """
        return False

    def _derivatives_to_keep(self, inputs: Arrays) -> Derivatives:
        derivatives = super()._derivatives_to_keep(inputs)
        if all(shape in ((1,), (3,)) for shape in self._output_shapes.values()):
            return _Gradients(derivatives, self._output_shapes, self.n_points() == 1)
        return derivatives

    def _points(self, inputs: Any) -> Iterator[tuple[int, Arrays]]:
        """Each node with its point: the inputs of the node and those that all nodes share."""
        values = copied(inputs)
        for node in range(self.n_points()):
            yield node, {name: self._view(node, name, values) for name in values}

    def _full_shape(self, shape: Shape) -> Shape:
        """Shape with the axis of nodes."""
        n = self.options["num_nodes"]
        return (shape or (1,)) if n is None else (n, *shape)

    def _view(self, node: int, name: str, values: Any) -> Any:
        """View of the part of a variable that belongs to a node, or of a variable all share."""
        shape = self._input_shapes.get(name) or self._output_shapes.get(name)
        return values[name] if shape is None else values[name].reshape(-1, *shape)[node]


class _Gradients(Derivatives):
    """Derivatives of few numbers as gradients, each taken when it is first asked for.

    One takes a product back for each of its numbers. Several points that all kept their
    linearisations would take much memory: they make them again for what is asked for later.
    """

    def __init__(self, derivatives: Derivatives, shapes: Shapes, alone: bool) -> None:
        self._derivatives, self._shapes, self._alone = derivatives, shapes, alone
        self._known: dict[str, Arrays] = {}

    def forward(self, seeds: Arrays, outputs: Collection[str]) -> Mapping[str, Any]:
        # Most seeds are zero, and those of the blade, the large ones, where it is no variable.
        moved = {name: seed for name, seed in seeds.items() if seed.any()}
        return {
            output: sum(
                (np.tensordot(gradient[name], seed, np.ndim(seed)) for name, seed in moved.items()),
                start=np.zeros(self._shapes[output]),
            )
            for output, gradient in self._of(outputs).items()
        }

    def reverse(self, seeds: Arrays) -> Mapping[str, Any]:
        gradients = self._of([name for name, seed in seeds.items() if seed.any()])
        inputs = next(iter(gradients.values()))
        return {
            name: sum(np.tensordot(seeds[output], g[name], 1) for output, g in gradients.items())
            for name in inputs
        }

    def _of(self, outputs: Collection[str]) -> dict[str, Arrays]:
        """Gradients of outputs by every input, the numbers of an output leading."""
        new = [name for name in outputs if name not in self._known]
        zero = {name: np.zeros(shape) for name, shape in self._shapes.items()}
        for name in new:
            (size,) = self._shapes[name]
            rows = [self._derivatives.reverse({**zero, name: unit}) for unit in np.eye(size)]
            self._known[name] = {
                name_in: np.stack([np.asarray(row[name_in]) for row in rows]) for name_in in rows[0]
            }
        if new and not self._alone:
            self._derivatives.release()
        return {name: self._known[name] for name in outputs}

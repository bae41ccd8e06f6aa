"""Components at one operating point or at many, as missions and multi-point design ask."""

from __future__ import annotations

from collections.abc import Iterator, Mapping
from typing import Any

import numpy as np
import openmdao.api as om
from openmdao.utils.options_dictionary import OptionsDictionary

from propmdao.components.jax_component import JaxComponent, arrays, evaluate, forward, reverse

#: Tells Dymos that an input has no axis of nodes.
STATIC = ["dymos.static_target"]
Values = dict[str, Any]
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
    code is that of one point, whatever their number, so is the memory, and a point that no seed
    touches costs nothing.

    Options
    -------
    num_nodes : int or None
        Number of operating points, the leading axis of everything that belongs to one, also where
        it is 1. None: a single point without that axis.
    """

    def __init__(self, **options: Any) -> None:
        self._input_shapes: dict[str, Shape] = {}
        self._output_shapes: dict[str, Shape] = {}
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

    def add_point_output(self, name: str, *, shape: Shape = (), **metadata: Any) -> None:
        """Declare an output of each operating point, one that ``function`` returns.

        Parameters
        ----------
        name : str
            Its name.
        shape : tuple of int
            At one point; () is a scalar, which ``function`` gets and returns as (1,).
        **metadata
            What ``add_output`` takes beside these.
        """
        self._output_shapes[name] = shape or (1,)
        self.add_output(name, shape=self._full_shape(shape), **metadata)

    def compute(self, inputs: Any, outputs: Any) -> None:
        for point, at in self.points(inputs):
            try:
                values = self.compute_point(at)
            except om.AnalysisError as error:
                if self.options["num_nodes"] is None:
                    raise
                raise om.AnalysisError(f"node {point}: {error}") from error
            for name in self._output_shapes:
                self._at(point, name, outputs)[:] = values[name]

    def compute_point(self, inputs: Values) -> Mapping[str, Any]:
        """Outputs at one operating point.

        Parameters
        ----------
        inputs : dict of arrays
            Inputs of the point by name.

        Returns
        -------
        mapping
            Outputs by name.

        Raises
        ------
        om.AnalysisError
            Where they have no meaning.
        """
        values = evaluate(self.function, self.static, self.constants, inputs)
        self.check(inputs, values)
        return values

    def compute_jacvec_product(self, inputs: Any, d_inputs: Any, d_outputs: Any, mode: str) -> None:
        # Every variable always takes part, if only with zeros: to compile for each combination that
        # OpenMDAO asks for would take far longer than the products.
        given = arrays(d_inputs if mode == "fwd" else d_outputs)
        for point, at in self.points(inputs):
            blank = (
                at if mode == "fwd" else {n: np.zeros(s) for n, s in self._output_shapes.items()}
            )
            seeds = {
                name: self._at(point, name, given) if name in given else np.zeros_like(value)
                for name, value in blank.items()
            }
            if not any(seed.any() for seed in seeds.values()):
                continue
            function = self.function, self.static, self.constants, at
            if mode == "fwd":
                products, targets = forward(*function, tuple(self._output_shapes), seeds), d_outputs
            else:
                products, targets = reverse(*function, seeds), d_inputs
            for name in targets:
                if name in products:  # outputs that never change have none
                    self._at(point, name, targets)[:] += products[name]

    def points(self, inputs: Any) -> Iterator[tuple[int, Values]]:
        """Go through the operating points.

        Parameters
        ----------
        inputs : mapping
            OpenMDAO's vector of inputs.

        Yields
        ------
        point, inputs : int, dict of arrays
            Number of the point, and its inputs with those that all points share.
        """
        values = arrays(inputs)
        for point in range(self.options["num_nodes"] or 1):
            yield point, {name: self._at(point, name, values) for name in values}

    def _full_shape(self, shape: Shape) -> Shape:
        """Shape with the axis of nodes."""
        n = self.options["num_nodes"]
        return (shape or (1,)) if n is None else (n, *shape)

    def _at(self, point: int, name: str, values: Any) -> Any:
        """View of the part of a variable that belongs to a point, or of one that all share."""
        shape = self._input_shapes.get(name) or self._output_shapes.get(name)
        return values[name] if shape is None else values[name].reshape(-1, *shape)[point]

"""Hundreds of small arrays handed from one compiled function to another as one.

Each array that a call takes or returns costs some 3 us, whatever its size. What a linearisation of
the lattice keeps is more than 600 arrays, and nine tenths of them are small.
"""

from __future__ import annotations

import math
from typing import Any

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.records.pytrees import record, static

_SMALL = 4096  # elements; larger arrays take longer to be copied than to be handed over


@record
class PackedArrays:
    """A pytree of arrays with the small ones in a row.

    Attributes
    ----------
    row : (n,) array
        Elements of the small arrays of floats, one after the other.
    others : tuple of arrays
        All other arrays.
    tree : jax.tree_util.PyTreeDef
        Structure of the whole.
    shapes : tuple of tuples of int, or None
        Shapes of the small arrays in their places among all; None in those of the others.
    """

    row: Array
    others: tuple[Array, ...]
    tree: Any = static()
    shapes: tuple[tuple[int, ...] | None, ...] = static()

    def unpacked(self) -> Any:
        """Return the pytree that was packed."""
        sizes = [math.prod(shape) for shape in self.shapes if shape is not None]
        small = iter(jnp.split(self.row, np.cumsum(sizes)[:-1]))
        others = iter(self.others)
        leaves = [
            next(others) if shape is None else next(small).reshape(shape) for shape in self.shapes
        ]
        return jax.tree.unflatten(self.tree, leaves)


def packed(arrays: Any) -> PackedArrays:
    """Pack a pytree of arrays, within a compiled function.

    Parameters
    ----------
    arrays : pytree of arrays
        What is to be handed over.

    Returns
    -------
    PackedArrays
        The same in few arrays.
    """
    leaves, tree = jax.tree.flatten(arrays)
    small, others = [jnp.zeros(0)], []
    shapes: list[tuple[int, ...] | None] = []
    for leaf in leaves:
        if leaf.dtype == float and leaf.size < _SMALL:
            small.append(leaf.ravel())
            shapes.append(leaf.shape)
        else:
            others.append(leaf)
            shapes.append(None)
    return PackedArrays(jnp.concatenate(small), tuple(others), tree, tuple(shapes))

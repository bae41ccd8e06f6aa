"""Cells between the nodes of a grid: their corners, means and areas."""

from __future__ import annotations

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def corners(grid: Array) -> tuple[Array, Array, Array, Array]:
    """Values at the corners of each cell, around it.

    Parameters
    ----------
    grid : (..., j_max, i_max, n) array
        Values at the nodes.

    Returns
    -------
    tuple of four (..., j_max - 1, i_max - 1, n) arrays
        Values at the corners in order, from the lowest indices with i first.
    """
    low, high = grid[..., :-1, :, :], grid[..., 1:, :, :]
    return low[..., :-1, :], low[..., 1:, :], high[..., 1:, :], high[..., :-1, :]


def means(grid: Array) -> Array:
    """Mean of the corners of each cell.

    Parameters
    ----------
    grid : (..., j_max, i_max, n) array
        Values at the nodes.

    Returns
    -------
    (..., j_max - 1, i_max - 1, n) array
        Means in the cells.
    """
    a, b, c, d = corners(grid)
    return np.asarray(0.25 * (a + b + c + d))


def vector_areas(nodes: Array) -> Array:
    """Area of each cell times its normal.

    Parameters
    ----------
    nodes : (..., j_max, i_max, 3) array
        Positions of the nodes [m].

    Returns
    -------
    (..., j_max - 1, i_max - 1, 3) array
        Vector areas of the cells [m^2].
    """
    a, b, c, d = corners(nodes)
    return np.asarray(0.5 * np.cross(c - a, d - b))

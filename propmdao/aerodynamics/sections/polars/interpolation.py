"""Piecewise cubic interpolation, C1 in its argument, as nodes and their weights for each point."""

from __future__ import annotations

import jax
import jax.numpy as jnp

#: How far past the ends of a table a clamped argument goes on, in end cells.
MARGIN = 0.25


def _hermite_weights(nodes: jax.Array, x: jax.Array) -> jax.Array:
    """Weigh four node values for x between the middle two; slopes from three-point parabolas.

    The slope at a node depends on that node and its two neighbours alone, so both cells that meet
    there share it: the Catmull-Rom spline on uneven nodes.
    """
    h0, h, h2 = (nodes[:, k + 1] - nodes[:, k] for k in range(3))
    value, left, right = _hermite_basis((x - nodes[:, 1]) / h, h)
    left_before, left_after = -h / (h0 * (h0 + h)), h0 / (h * (h0 + h))
    right_before, right_after = -h2 / (h * (h + h2)), h / (h2 * (h + h2))
    return jnp.stack(
        [
            left * left_before,
            1.0 - value - left * (left_before + left_after) + right * right_before,
            value + left * left_after - right * (right_before + right_after),
            right * right_after,
        ],
        axis=1,
    )


def _hermite_basis(t: jax.Array, h: jax.Array) -> tuple[jax.Array, jax.Array, jax.Array]:
    """Weights of the right value and of both slopes at t of a cell; the left value has the rest."""
    return t * t * (3.0 - 2.0 * t), t * (1.0 - t) ** 2 * h, -t * t * (1.0 - t) * h


def _cell(nodes: jax.Array, x: jax.Array) -> jax.Array:
    """Find the cell that holds x; outside the nodes it is the first or the last."""
    # Tables are short: comparing with every node compiles and runs faster than a search.
    above = jnp.searchsorted(nodes, x, side="right", method="compare_all")
    return jnp.clip(above - 1, 0, nodes.size - 2)


def soft_clamp(nodes: jax.Array, x: jax.Array) -> jax.Array:
    """Hold an argument to the range of its nodes without a kink.

    Parameters
    ----------
    nodes : (n_nodes,) array
        Rising nodes.
    x : array
        Arguments.

    Returns
    -------
    array
        Arguments, `x` itself inside the range; outside they level off within `MARGIN` of an end
        cell, C1.
    """
    low, high = nodes[0], nodes[-1]
    below, above = MARGIN * (nodes[1] - low), MARGIN * (high - nodes[-2])
    inside = jnp.clip(x, low, high)
    under = below * jnp.tanh(jnp.minimum(x - low, 0.0) / below)
    over = above * jnp.tanh(jnp.maximum(x - high, 0.0) / above)
    return inside + under + over


def clamped_stencil(nodes: jax.Array, x: jax.Array) -> tuple[jax.Array, jax.Array]:
    """Find nodes and weights for arguments held to the range of the nodes by `soft_clamp`.

    Parameters
    ----------
    nodes : (n_nodes,) array
        Rising nodes, at least two.
    x : (n,) array
        Arguments.

    Returns
    -------
    index, weight : (n, 4) arrays
        Positions and weights of four nodes: values at `x` are the sum of weight * values[index],
        C1 in `x`.
    """
    x = soft_clamp(nodes, x)
    cell, last = _cell(nodes, x), nodes.size - 1
    # Beyond each end stands a node whose value continues the end cell's straight line.
    ghosts = jnp.concatenate([2 * nodes[:1] - nodes[1:2], nodes, 2 * nodes[-1:] - nodes[-2:-1]])
    weight = _hermite_weights(ghosts[cell[:, None] + jnp.arange(4)], x)
    first, final = (cell == 0) * weight[:, 0], (cell == last - 1) * weight[:, 3]
    weight = weight + jnp.stack([-first, 2 * first - final, 2 * final - first, -final], axis=1)
    return jnp.clip(cell[:, None] + jnp.arange(-1, 3), 0, last), weight


def periodic_slopes(nodes: jax.Array, values: jax.Array) -> jax.Array:
    """Slopes of curves over angles at their nodes, from three-point parabolas.

    Parameters
    ----------
    nodes : (n_nodes,) array
        Rising angles over a whole turn, both ends included.
    values : (..., n_nodes) array
        Values at the nodes, the last equal to the first.

    Returns
    -------
    (..., n_nodes) array
        Slopes at the nodes.
    """
    after = jnp.diff(nodes)
    before = jnp.roll(after, 1)
    rise = jnp.diff(values) / after
    slopes = (before * rise + after * jnp.roll(rise, 1, axis=-1)) / (before + after)
    return jnp.concatenate([slopes, slopes[..., :1]], axis=-1)


def periodic_cubic(
    nodes: jax.Array, angle: jax.Array
) -> tuple[jax.Array, tuple[jax.Array, jax.Array]]:
    """Find nodes and weights for angles of any size: Hermite's cubic between two nodes.

    With the slopes of `periodic_slopes` it is the Catmull-Rom spline on uneven nodes. For curves
    that are read often their slopes are better known than found from four nodes each time.

    Parameters
    ----------
    nodes : (n_nodes,) array
        Rising angles from -pi to pi, both included.
    angle : (n,) array
        Angles [rad].

    Returns
    -------
    index : (n, 2) array
        Positions of the two nodes.
    weights : two (n, 2) arrays
        Weights of the values and of the slopes there, whose sum is C1 and periodic.
    """
    turn = 2.0 * jnp.pi
    x = angle - turn * jnp.round(angle / turn)
    index = _cell(nodes, x)[:, None] + jnp.arange(2)
    ends = nodes[index]
    h = ends[:, 1] - ends[:, 0]
    value, left, right = _hermite_basis((x - ends[:, 0]) / h, h)
    return index, (jnp.stack([1.0 - value, value], axis=1), jnp.stack([left, right], axis=1))


def dense(index: jax.Array, weight: jax.Array, n_nodes: int) -> jax.Array:
    """Write a stencil as rows of a matrix.

    Parameters
    ----------
    index, weight : (n, 4) arrays
        Stencil, positions and weights of four nodes.
    n_nodes : int
        Number of nodes.

    Returns
    -------
    (n, n_nodes) array
        Matrix from node values to values at the arguments.
    """
    return jnp.einsum("nk,nkm->nm", weight, jax.nn.one_hot(index, n_nodes, dtype=weight.dtype))

"""Corners rounded off: the report's switches for an optimiser.

Each blend is exact outside a stated half width and has a continuous first derivative, so that the
report's own numbers stand everywhere else.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array
from jax.typing import ArrayLike


def ramp(x: ArrayLike, half_width: ArrayLike) -> Array:
    """``max(x, 0)`` with its corner replaced by a parabola.

    Parameters
    ----------
    x : array
        Values of any shape.
    half_width : float or array
        Distance from the corner at which the parabola ends, positive; the parabola lies at most a
        quarter of this above the corner.

    Returns
    -------
    array
        Values of the same shape.
    """
    x, w = jnp.asarray(x), jnp.asarray(half_width)
    inside = jnp.clip(x, -w, w)
    return (inside + w) ** 2 / (4 * w) + jnp.maximum(x - w, 0.0)


def at_least(x: ArrayLike, least: float) -> Array:
    """Values that a logarithm or a denominator can take, of what is positive but for its limits.

    Parameters
    ----------
    x : array
        Values of any shape.
    least : float
        Smallest value that comes out, positive.

    Returns
    -------
    array
        Values of the same shape; those above ``2 * least`` are as they were.
    """
    return least + ramp(jnp.asarray(x) - least, least)


def smooth_abs(x: ArrayLike, half_width: float) -> Array:
    """``abs(x)`` with its corner replaced by a parabola, half of `half_width` at zero.

    Parameters
    ----------
    x : array
        Values of any shape.
    half_width : float
        Distance from the corner at which the parabola ends.

    Returns
    -------
    array
        Values of the same shape.
    """
    inside = jnp.clip(x, -half_width, half_width)
    return (inside**2 / half_width + half_width) / 2 + jnp.maximum(jnp.abs(x) - half_width, 0.0)


def smooth_step(x: ArrayLike, half_width: float) -> Array:
    """Rise from 0 at ``-half_width`` to 1 at ``half_width``, level at both ends.

    Parameters
    ----------
    x : array
        Values of any shape.
    half_width : float
        Distance from 0 at which the rise begins and ends.

    Returns
    -------
    array
        Values of the same shape.
    """
    t = (jnp.clip(jnp.asarray(x) / half_width, -1.0, 1.0) + 1) / 2  # exactly 0 and 1 outside
    return t * t * (3 - 2 * t)

"""Circulation that the wake remembers in a march: what the blades had some time steps ago."""

from __future__ import annotations

import math

import jax.numpy as jnp
from jax import Array

_POINTS = 4  # of the interpolating cubic


def lag_weights(lag: Array) -> tuple[Array, Array]:
    """Time steps between which to interpolate, and their weights.

    The cubic goes through the two steps before and the two after the time wanted; next to the
    present, where nothing comes after, through the four youngest.

    Parameters
    ----------
    lag : array
        Time behind the present, in steps, not below 0.

    Returns
    -------
    step, weight : (..., 4) arrays
        Steps behind the present, whole numbers, and their weights, which add up to 1.
    """
    first = jnp.maximum(jnp.floor(lag) - 1.0, 0.0)
    t = lag - first
    weights = []
    for i in range(_POINTS):
        others = [j for j in range(_POINTS) if j != i]
        weights.append(math.prod((t - j) for j in others) / math.prod(i - j for j in others))
    step = first.astype(int)[..., None] + jnp.arange(_POINTS)
    return step, jnp.stack(weights, axis=-1)


def remembered(lag: Array, history: Array) -> tuple[Array, Array]:
    """Circulation of the wake's rings by that of the strips at the steps before.

    Parameters
    ----------
    lag : (ns, n_rings) array
        Time since the rings were shed, in steps.
    history : (n_lags, m, ns) array
        Circulation of the strips of m blades one step ago, two steps ago, and so on [m^2/s].

    Returns
    -------
    known : (m, ns, n_rings) array
        Part that follows from the history [m^2/s].
    now : (ns, n_rings) array
        Share of the present circulation of the strip.
    """
    step, weight = lag_weights(lag)
    with_present = jnp.pad(history, ((1, 0), (0, 0), (0, 0)))
    strips = jnp.arange(lag.shape[0])[:, None, None]
    read = with_present[jnp.minimum(step, history.shape[0]), :, strips]
    known = (weight[..., None] * read).sum(axis=2)
    return jnp.moveaxis(known, -1, 0), jnp.where(step == 0, weight, 0.0).sum(axis=-1)


def shed(ring: Array, present: Array) -> Array:
    """Circulation of the segments across the sheet, at the younger ends of the rings.

    Parameters
    ----------
    ring : (..., n_rings) array
        Circulation of the rings [m^2/s].
    present : array
        Circulation at the trailing edge [m^2/s].

    Returns
    -------
    (..., n_rings) array
        Change from one ring to the next; the first one what the trailing edge has less what is
        behind it.
    """
    ahead = jnp.concatenate(
        [jnp.broadcast_to(present, ring.shape[:-1])[..., None], ring[..., :-1]], axis=-1
    )
    return ring - ahead

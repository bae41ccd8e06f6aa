"""Circulation that the wake remembers in a march: what the blades had some time steps ago."""

from __future__ import annotations

import math

import jax.numpy as jnp
from jax import Array

_POINTS = 4  # of the interpolating cubic


def lag_weights(lag: Array, n_steps: int) -> tuple[Array, Array]:
    """Time steps between which to interpolate, and their weights.

    The cubic goes through the two steps before and the two after the time wanted; next to the
    present, where nothing comes after, through the four youngest, and at the other end likewise.

    Parameters
    ----------
    lag : array
        Time behind the present, in steps, not below 0.
    n_steps : int
        Steps that there are, the present among them.

    Returns
    -------
    step, weight : (..., 4) arrays
        Steps behind the present, whole numbers, and their weights, which add up to 1.
    """
    first = jnp.clip(jnp.floor(lag) - 1.0, 0.0, n_steps - _POINTS)
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
    with_present = jnp.pad(history, ((1, 0), (0, 0), (0, 0)))
    step, weight = lag_weights(lag, with_present.shape[0])
    return read(lag, with_present), jnp.where(step == 0, weight, 0.0).sum(axis=-1)


def read(lag: Array, strips: Array) -> Array:
    """Circulation of strips at times between the steps.

    Parameters
    ----------
    lag : (ns, n_rings) array
        Times wanted behind the first step, in steps.
    strips : (n_steps, m, ns) array
        Circulation of the strips of m blades, the latest first [m^2/s].

    Returns
    -------
    (m, ns, n_rings) array
        Circulation at those times [m^2/s].
    """
    step, weight = lag_weights(lag, strips.shape[0])
    number = jnp.arange(lag.shape[0])[:, None, None]
    return jnp.moveaxis((weight[..., None] * strips[step, :, number]).sum(axis=2), -1, 0)


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

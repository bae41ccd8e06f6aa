"""Circulation that the wake remembers: what the blades had when they shed it.

The circulation of a period is known at equally spaced azimuths of a blade, and the nodes of its
wake have ages of their own, fine near the trailing edge. Between the azimuths it is read by the
cubic through the four nearest ones, around the turn.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.vortices.cores import middles


def history_weights(ages: Array, n_azimuths: int, n_blades: int) -> tuple[Array, Array]:
    """Weights from circulation at azimuths to that of trailing and shed segments of the wake.

    A trailing segment carries the circulation of the time at which its middle was shed, a shed
    segment the change from one to the next; the first one what the trailing edge has now less what
    is behind it. The last ring is open: the wake goes on.

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuths of the wake nodes behind their blade, from 0 [rad].
    n_azimuths, n_blades : int
        Azimuths of the period, a multiple of the number of equally spaced blades.

    Returns
    -------
    trailing, shed : (n_blades * (n_nodes - 1), n_azimuths) arrays
        Weight, in each segment behind each blade, of the circulation that blade 1 has so many
        azimuths later; a shed segment lies at the younger node of its ring.
    """
    ahead = n_azimuths // n_blades * jnp.arange(n_blades)
    place = ahead[:, None] - middles(ages) * n_azimuths / (2.0 * jnp.pi)
    cell = jnp.floor(place)
    t = place - cell
    cubic = (
        -t * (t - 1.0) * (t - 2.0) / 6.0,
        (t + 1.0) * (t - 1.0) * (t - 2.0) / 2.0,
        -(t + 1.0) * t * (t - 2.0) / 2.0,
        (t + 1.0) * t * (t - 1.0) / 6.0,
    )

    def at(azimuth: Array) -> Array:
        return jax.nn.one_hot(azimuth.astype(int) % n_azimuths, n_azimuths)

    ring = sum(weight[..., None] * at(cell + j) for j, weight in zip(range(-1, 3), cubic, strict=True))
    before = jnp.concatenate([at(ahead)[:, None], ring[:, :-1]], axis=1)
    shape = -1, n_azimuths
    return ring.reshape(shape), (ring - before).reshape(shape)

"""Circulation that the wake remembers: what the blades had when they shed it.

The circulation of a period is known at equally spaced azimuths of a blade, and the nodes of its
wake have ages of their own, fine near the trailing edge. Between the azimuths it is read by the
cubic through the four nearest ones, around the turn.

Where blade and wake meet, both have to be one sheet. The last bound vortex stands for the sheet up
to the last collocation point, x_c, which is a quarter of its panel D ahead of the trailing edge;
the wake begins a quarter behind it, at x_c + D / 2. So what is there was not shed just now: with a
first step h of the wake, its circulation is older than its nodes by

    delay / D = 1 - h / (2 D) + log((1 + h / D) / 2) / 2,

1/2 for h = D, where wake and lattice go on with the same step, and 0.65 for small h. It is that
with which a sheet of constant strength, the last bound vortex at x_c - D / 2, the first shed one
at x_c + D / 2 and the wake from there on, induces nothing at x_c, as a sheet does on itself.
Without it the error of Theodorsen's lift at a reduced frequency of 0.2 with eight panels is 6 %.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.vortices.cores import middles


def shedding_delay(panel: Array, first_step: Array) -> Array:
    """Distance by which the circulation of the wake is older than its nodes.

    Parameters
    ----------
    panel : (ns,) array
        Chordwise length of the last panel of each strip, D [m].
    first_step : (ns,) array
        Length of the first step of its wake, h [m].

    Returns
    -------
    (ns,) array
        Delay [m], not below 0.
    """
    ratio = first_step / panel
    return panel * jnp.maximum(1.0 - 0.5 * ratio + 0.5 * jnp.log(0.5 * (1.0 + ratio)), 0.0)


def history_weights(
    ages: Array, delay: Array, n_azimuths: int, n_blades: int
) -> tuple[Array, Array]:
    """Weights from circulation at azimuths to that of the rings and shed segments of the wake.

    A ring carries the circulation of the time at which its middle was shed, a shed segment the
    change from one ring to the next; the first one what the trailing edge has now less what is
    behind it. The last ring is open: the wake goes on.

    Parameters
    ----------
    ages : (n_nodes,) array
        Azimuths of the wake nodes behind their blade, from 0 [rad].
    delay : (ns,) array
        Azimuth by which the circulation of each strip's wake is older [rad].
    n_azimuths, n_blades : int
        Azimuths of the period, a multiple of the number of equally spaced blades.

    Returns
    -------
    ring, shed : (ns, n_azimuths, n_blades * (n_nodes - 1)) arrays
        Weight of the circulation that blade 1 has so many azimuths later in each ring behind each
        blade and in the shed segment at its younger end (last axis: sums over it are the products
        that take time).
    """
    ahead = n_azimuths // n_blades * jnp.arange(n_blades)
    behind = (middles(ages) + delay[:, None]) * n_azimuths / (2.0 * jnp.pi)
    place = ahead[:, None] - behind[:, None, :]
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

    ring = jnp.zeros((*place.shape, n_azimuths))
    for j, weight in zip(range(-1, 3), cubic, strict=True):
        ring += weight[..., None] * at(cell + j)
    now = jnp.broadcast_to(at(ahead)[:, None], (*ring.shape[:2], 1, n_azimuths))
    before = jnp.concatenate([now, ring[:, :, :-1]], axis=2)

    def over_segments(weight: Array) -> Array:
        return weight.reshape(delay.size, -1, n_azimuths).swapaxes(1, 2)

    return over_segments(ring), over_segments(ring - before)

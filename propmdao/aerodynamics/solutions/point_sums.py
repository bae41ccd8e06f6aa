"""Point forces of a blade, summed over the panels and the strips of its lattice.

The points are, in this order, those of `LatticeLoads` and `PeriodBladeLoads`: bound segments
(nc * ns), chordwise segments (nc * (ns + 1)), in unsteady flow middles of the rings (nc * ns), and
the sections' quarter points (ns). A chordwise segment belongs half to either side; the outermost
ones have one side only.
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array


def panel_sums(of_point: Array, n_chordwise: int, n_spanwise: int) -> Array:
    """Sum what belongs to each panel; profile drag, which belongs to strips, is left out.

    Parameters
    ----------
    of_point : (n, ...) array
        Force, moment or a component of one at every point.
    n_chordwise, n_spanwise : int
        Panels of the lattice, nc and ns.

    Returns
    -------
    (nc, ns, ...) array
        Sums over the panels.
    """
    nc, ns = n_chordwise, n_spanwise
    n_bound, n_edges, rest = nc * ns, nc * (ns + 1), of_point.shape[1:]
    bound = of_point[:n_bound].reshape(nc, ns, *rest)
    edge = of_point[n_bound : n_bound + n_edges].reshape(nc, ns + 1, *rest)
    share = jnp.full(ns + 1, 0.5).at[jnp.array([0, ns])].set(1.0)
    edge = edge * share.reshape(-1, *(1,) * len(rest))
    rings = of_point[n_bound + n_edges : -ns]
    rings = rings.reshape(rings.shape[0] // n_bound, nc, ns, *rest)
    return bound + edge[:, :-1] + edge[:, 1:] + rings.sum(axis=0)


def strip_sums(of_point: Array, n_chordwise: int, n_spanwise: int) -> Array:
    """Sum what belongs to each strip, profile drag included.

    Parameters
    ----------
    of_point : (n, ...) array
        Force, moment or a component of one at every point.
    n_chordwise, n_spanwise : int
        Panels of the lattice, nc and ns.

    Returns
    -------
    (ns, ...) array
        Sums over the strips, which add up to that over all points.
    """
    return panel_sums(of_point, n_chordwise, n_spanwise).sum(axis=0) + of_point[-n_spanwise:]


def strip_loads(position: Array, force: Array, n_chordwise: int, n_spanwise: int) -> Array:
    """Thrust and torque of each strip.

    Parameters
    ----------
    position, force : (n, 3) arrays
        Points in the frame of the blade [m], and forces on the blade there [N].
    n_chordwise, n_spanwise : int
        Panels of the lattice, nc and ns.

    Returns
    -------
    (2, ns) array
        Thrust [N] and torque [N m] of each strip, which add up to the blade's.
    """
    torque = position[:, 1] * force[:, 0] - position[:, 0] * force[:, 1]
    both = jnp.stack([force[:, 2], torque], axis=1)
    return strip_sums(both, n_chordwise, n_spanwise).T

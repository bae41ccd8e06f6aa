"""Velocity induced by straight vortex segments with a smooth viscous core.

A segment from A to B of circulation 1, seen from P with a = P - A, b = P - B, induces
(Katz and Plotkin 2001, eq. 2.68b, in the form of van Garrel 2003, eq. B.20)

    v = (|a| + |b|) / (4 pi |a||b| (|a||b| + a.b)) a x b.

The core is that of Vatistas et al. 1991 with n = 2: v is multiplied by h^2 / sqrt(h^4 + rc^4),
where h is the distance from the line and rc the core radius.

Why the kernel looks as it does: with q = |a||b| and d = a.b, 1/(q + d) = (q - d)/|a x b|^2 and
|a| + |b| = sqrt(a.a + b.b + 2 q), so that one division and two roots are left and the core enters
beside |a x b|^4. Coordinates are separate contiguous arrays, and the blocks stay in cache: the
same formula on (n, 3) arrays costs several times as much.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

_FOUR_PI = 4.0 * jnp.pi


def _kernel(
    p: tuple[Array, Array, Array], a: Array, b: Array, core4: Array
) -> tuple[Array, Array, Array, Array]:
    """K such that v = K (a x b), for segments in rows and points in columns; and P."""
    px, py, pz = (x[None, :] for x in p)
    ux, uy, uz = px - a[0][:, None], py - a[1][:, None], pz - a[2][:, None]
    wx, wy, wz = px - b[0][:, None], py - b[1][:, None], pz - b[2][:, None]
    aa = ux * ux + uy * uy + uz * uz
    bb = wx * wx + wy * wy + wz * wz
    d = ux * wx + uy * wy + uz * wz
    qq = aa * bb
    q = jnp.sqrt(qq)
    cross2 = qq - d * d
    k = (q - d) * jnp.sqrt((aa + bb + 2.0 * q) / (qq * (cross2 * cross2 + core4[:, None])))
    return k / _FOUR_PI, px, py, pz


def _core4(a: Array, b: Array, core_radius: Array) -> Array:
    """rc^4 L^4: the core term beside |a x b|^4 = h^4 L^4."""
    length2 = jnp.sum((b - a) ** 2, axis=0)
    return (core_radius * core_radius * length2) ** 2


def segment_velocities(points: Array, start: Array, end: Array, core_radius: Array) -> Array:
    """Velocity of each segment of unit circulation at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Where the velocity is wanted [m].
    start, end : (n_segments, 3) array
        Ends of the segments; circulation is positive from start to end [m].
    core_radius : (n_segments,) array
        Vortex core radius, positive [m].

    Returns
    -------
    (n_segments, n_points, 3) array
        Velocity per unit circulation [1/m].
    """
    a, b = start.T, end.T
    k, px, py, pz = _kernel((points[:, 0], points[:, 1], points[:, 2]), a, b, _core4(a, b, core_radius))
    # a x b = P x (A - B) + A x B
    mx, my, mz = (m[:, None] for m in a - b)
    cx, cy, cz = (c[:, None] for c in jnp.cross(start, end).T)
    return jnp.stack(
        [
            k * (py * mz - pz * my + cx),
            k * (pz * mx - px * mz + cy),
            k * (px * my - py * mx + cz),
        ],
        axis=-1,
    )


def filament_velocities(points: Array, nodes: Array, core_radius: Array) -> Array:
    """Velocity of each filament (a chain of segments of unit circulation) at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Where the velocity is wanted [m].
    nodes : (n_filaments, n_chains, n_nodes, 3) array
        Chains of nodes whose velocities are added, as the same filament of all blades; circulation
        is positive along the chain [m].
    core_radius : (n_nodes - 1,) array
        Core radius of the segments along a chain, positive [m].

    Returns
    -------
    (n_filaments, n_points, 3) array
        Velocity per unit circulation [1/m].
    """
    px, py, pz = points[:, 0], points[:, 1], points[:, 2]
    n_chains = nodes.shape[1]

    # One filament at a time: the block of segments x points stays in cache, and the sum over
    # segments is a matrix product. The checkpoint keeps reverse mode from storing every block.
    @jax.checkpoint
    def one(chains: Array) -> Array:
        start = chains[:, :-1].reshape(-1, 3)
        end = chains[:, 1:].reshape(-1, 3)
        a, b = start.T, end.T
        core4 = _core4(a, b, jnp.tile(core_radius, n_chains))
        k, *_ = _kernel((px, py, pz), a, b, core4)
        moments = jnp.concatenate([(start - end).T, jnp.cross(start, end).T])
        return moments @ k

    mx, my, mz, cx, cy, cz = jnp.moveaxis(jax.lax.map(one, nodes), 1, 0)
    return jnp.stack(
        [py * mz - pz * my + cx, pz * mx - px * mz + cy, px * my - py * mx + cz], axis=-1
    )

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

from typing import NamedTuple

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar

_FOUR_PI = 4.0 * jnp.pi
# Least |a|^2 |b|^2: where a point is an end of the segment, which then induces nothing there. In
# single precision lengths have to be of order one.
_LEAST = {"float32": 1.0e-12, "float64": 1.0e-300}


def _products(p: Array, a: Array, b: Array) -> tuple[Array, Array, Array]:
    """|P - A|^2, |P - B|^2 and their scalar product: segments in rows, points in columns."""
    px, py, pz = (x[None, :] for x in p)
    ux, uy, uz = px - a[0][:, None], py - a[1][:, None], pz - a[2][:, None]
    wx, wy, wz = px - b[0][:, None], py - b[1][:, None], pz - b[2][:, None]
    aa = ux * ux + uy * uy + uz * uz
    bb = wx * wx + wy * wy + wz * wz
    return aa, bb, ux * wx + uy * wy + uz * wz


@jax.custom_jvp
def _kernel(p: Array, a: Array, b: Array, core4: Array) -> Array:
    """K such that v = K (a x b), (n_segments, n_points), of p, a, b: (3, n), core4: (n,)."""
    aa, bb, d = _products(p, a, b)
    qq = jnp.maximum(aa * bb, _LEAST[aa.dtype.name])
    q = jnp.sqrt(qq)
    cross2 = qq - d * d
    k = (q - d) * jnp.sqrt((aa + bb + 2.0 * q) / (qq * (cross2 * cross2 + core4[:, None])))
    return k / _FOUR_PI


@_kernel.defjvp
def _kernel_derivative(
    primals: tuple[Array, Array, Array, Array], tangents: tuple[Array, Array, Array, Array]
) -> tuple[Array, Array]:
    # The scalar product of P - A and P - B is (|P - A|^2 + |P - B|^2 - |B - A|^2) / 2, so that K
    # depends on the points by two squares alone. Its slopes are elementwise, kept by reverse mode
    # and used by every product; the changes of the squares are matrix products, forward and
    # transposed.
    p, a, b, core4 = primals
    dp, da, db, dcore4 = tangents
    aa, bb, d = _products(p, a, b)
    qq = aa * bb
    q = jnp.sqrt(qq)
    cross2 = qq - d * d
    n, e = aa + bb + 2.0 * q, cross2 * cross2 + core4[:, None]
    inverse = 1.0 / (qq * n * e)
    one_over_n, one_over_e, one_over_q = inverse * qq * e, inverse * qq * n, inverse * q * n * e
    root = n * jnp.sqrt(inverse) / _FOUR_PI  # sqrt(n / (qq e))
    k = (q - d) * root
    by_core4 = -0.5 * k * one_over_e
    by_d = -root - 4.0 * by_core4 * cross2 * d
    by_q = root * d * one_over_q + k * (one_over_n - 2.0 * cross2 * q * one_over_e)
    same, half = 0.5 * (k * one_over_n + by_d), 0.5 * by_q * one_over_q
    by_aa, by_bb = half * bb + same, half * aa + same

    # |P - A|^2 / 2 = (1, -A).(P.P / 2, P) + A.A / 2, so that the sums over points and over segments
    # in the transpose are matrix products, not slow reductions.
    ones, p1, dp1 = jnp.ones_like(p[:1]), _with_row(p, 1.0), _with_row(dp, (p * dp).sum(0))

    def change(x: Array, dx: Array) -> Array:
        return 2.0 * (_with_row(-x, 1.0).T @ dp1 + _with_row(-dx, (x * dx).sum(0)).T @ p1)

    length = ((b - a) * (db - da)).sum(0)[:, None]
    dk = by_aa * change(a, da) + by_bb * change(b, db)
    dk += by_core4 * (dcore4[:, None] @ ones) - by_d * (length @ ones)
    return k, dk


def _with_row(x: Array, row: Array | float) -> Array:
    """Coordinates (3, n) and a fourth row."""
    return jnp.concatenate([x, jnp.broadcast_to(row, x[:1].shape)])


def _core4(a: Array, b: Array, core_radius: Scalar) -> Array:
    """rc^4 L^4: the core term beside |a x b|^4 = h^4 L^4."""
    return (core_radius * core_radius * jnp.sum((b - a) ** 2, axis=0)) ** 2


def _moments(a: Array, b: Array) -> Array:
    """A - B and A x B, (6, n_segments), for a x b = P x (A - B) + A x B."""
    # In the order z, x, y first, which needs three rotations of rows and not four.
    cross = a * jnp.roll(b, -1, axis=0) - jnp.roll(a, -1, axis=0) * b
    return jnp.concatenate([a - b, jnp.roll(cross, -1, axis=0)])


def _velocity(p: Array, m: Array) -> Array:
    """P x M + C for M, C in m[:3], m[3:]."""
    px, py, pz = p
    return jnp.stack(
        [py * m[2] - pz * m[1] + m[3], pz * m[0] - px * m[2] + m[4], px * m[1] - py * m[0] + m[5]]
    )


def segment_velocities(points: Array, start: Array, end: Array, core_radius: Scalar) -> Array:
    """Compute the velocity of each segment of unit circulation at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    start, end : (n_chains, n_segments, 3) array
        Ends of the segments [m]. Velocities are added over the chains, for example over
        the blades, of which each has the same segment; circulation is positive from start to end.
    core_radius : float
        Vortex core radius, positive [m].

    Returns
    -------
    (3, n_segments, n_points) array
        Velocity per unit circulation [1/m].
    """
    p = points.T

    def add(total: Array, ends: tuple[Array, Array]) -> tuple[Array, None]:
        a, b = (x.T for x in ends)
        k = _kernel(p, a, b, _core4(a, b, core_radius))
        return total + k * _velocity(p, _moments(a, b)[:, :, None]), None

    total = jnp.zeros((3, start.shape[1], points.shape[0]))
    return jax.lax.scan(add, total, (start, end))[0]


class SegmentKernels(NamedTuple):
    """Segments seen from fixed points, kept so that any circulation of them gives the velocity.

    Three components of the velocity of each segment would take three times the memory, and writing
    them three times as long.

    Attributes
    ----------
    points : (3, n_points) array
        Points at which the velocity is wanted [m].
    kernel : (n_chains, n_segments, n_points) array
        K such that a segment of unit circulation induces K (a x b) [1/m^3].
    moments : (n_chains, 6, n_segments) array
        A - B and A x B [m, m^2].
    """

    points: Array
    kernel: Array
    moments: Array

    def velocities(self, circulation: Array) -> Array:
        """Velocity at the points.

        Parameters
        ----------
        circulation : (n_segments,) array
            Circulation of the segments, the same in all chains [m^2/s].

        Returns
        -------
        (3, n_points) array
            Velocity [m/s].
        """
        # One row of segments of all chains: a sum over two axes, as einsum has it, is transposed
        # into a copy of the kernel.
        moments = jnp.moveaxis(circulation * self.moments, 1, 0).reshape(6, -1)
        return _velocity(self.points, moments @ self.kernel.reshape(moments.shape[1], -1))

    def without_own(self) -> SegmentKernels:
        """The same where each point lies on the segment of its number in the first chain.

        It induces nothing there, but in this form only as the difference of two large numbers.
        """
        own = jnp.arange(self.kernel.shape[1])
        return self._replace(kernel=self.kernel.at[0, own, own].set(0.0))


def segment_kernels(points: Array, start: Array, end: Array, core_radius: Scalar) -> SegmentKernels:
    """Compute what is needed of segments for the velocity at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    start, end : (n_chains, n_segments, 3) array
        Ends of the segments [m]; velocities are added over the chains.
    core_radius : float
        Vortex core radius, positive [m].

    Returns
    -------
    SegmentKernels
        The segments as the points see them.
    """
    p = points.T

    def chain(ends: tuple[Array, Array]) -> tuple[Array, Array]:
        a, b = (x.T for x in ends)
        return _kernel(p, a, b, _core4(a, b, core_radius)), _moments(a, b)

    return SegmentKernels(p, *jax.lax.map(chain, (start, end)))


def filament_velocities(points: Array, start: Array, end: Array, core_radius: Array) -> Array:
    """Compute the velocity of each filament, segments of unit circulation, at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    start, end : (n_filaments, n_segments, 3) arrays
        Ends of the segments whose velocities are added to that of a filament, for example those of
        all blades, of which each has the same filament [m]; circulation is positive from start to
        end.
    core_radius : (n_segments,) array
        Core radius of the segments of a filament, positive [m].

    Returns
    -------
    (3, n_filaments, n_points) array
        Velocity per unit circulation [1/m].
    """
    p = points.T

    # One filament at a time: the block of segments x points stays in cache, and the sum over
    # segments is a matrix product. Reverse mode keeps five numbers of each pair: computing them
    # anew for each product takes 2 to 3.5 times as long, all the more where there are several.
    def filament(ends: tuple[Array, Array]) -> Array:
        a, b = (x.T for x in ends)
        return _moments(a, b) @ _kernel(p, a, b, _core4(a, b, core_radius))

    return _velocity(p, jnp.moveaxis(jax.lax.map(filament, (start, end)), 1, 0))


def segment_normalwash(
    points: Array, normals: Array, start: Array, end: Array, core_radius: Scalar
) -> Array:
    """Compute the velocity of each segment of unit circulation along the normal at each point.

    Parameters
    ----------
    points, normals : (n_points, 3) arrays
        Points [m], and unit vectors along which the velocity is wanted.
    start, end : (n_segments, 3) arrays
        Ends of the segments [m]; circulation is positive from start to end.
    core_radius : float or (n_segments,) array
        Vortex core radius, positive [m].

    Returns
    -------
    (n_segments, n_points) array
        Normal velocity per unit circulation [1/m].
    """
    p, a, b = points.T, start.T, end.T
    # (P x M + C).n = M.(n x P) + C.n
    arms = jnp.concatenate([jnp.cross(normals, points).T, normals.T])
    return _products_of_six(_moments(a, b), arms) * _kernel(p, a, b, _core4(a, b, core_radius))


@jax.custom_jvp
def _products_of_six(m: Array, arms: Array) -> Array:
    """m.T @ arms, of (6, n_segments) and (6, n_points).

    A matrix product of so few terms takes longer than the kernel; written out, it is a part of it.
    """
    total = m[0][:, None] * arms[0]
    for k in range(1, 6):
        total += m[k][:, None] * arms[k]
    return total


@_products_of_six.defjvp
def _change_of_products(
    primals: tuple[Array, Array], tangents: tuple[Array, Array]
) -> tuple[Array, Array]:
    (m, arms), (dm, darms) = primals, tangents
    return _products_of_six(m, arms), dm.T @ arms + m.T @ darms


def summed_velocities(
    points: Array, start: Array, end: Array, core_radius: Array, circulation: Array
) -> Array:
    """Compute the velocity of segments of known circulation at each point.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    start, end : (n_segments, 3) arrays
        Ends of the segments [m].
    core_radius : (n_segments,) array
        Vortex core radius, positive [m].
    circulation : (n_segments,) array
        Circulation, positive from start to end [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    p, a, b = points.T, start.T, end.T
    moments = circulation * _moments(a, b)
    return _velocity(p, moments @ _kernel(p, a, b, _core4(a, b, core_radius)))

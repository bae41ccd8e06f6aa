"""Sources of a turning blade gathered on rings about its shaft: what makes full surfaces cheap.

In steady axial flight a source at the azimuth theta of the blade sounds like one at azimuth 0, as
much earlier as it is ahead: its tone of order n is turned by exp(-1j n theta). What is left, the
tone f_n(r, z) of a source of strength 1 that runs around on a ring, is smooth in two coordinates,
and a polynomial through a few rings tells it for all sources::

    sum_j q_j exp(-1j n theta_j) f_n(r_j, z_j) = sum_k w_nk f_n(r_k, z_k)
    w_nk = sum_j q_j exp(-1j n theta_j) L_k(r_j, z_j)

with Lagrange's polynomials L_k. The weights ask for no observer and no time. 98 rings stand for
5,200 panels, at any shape of the blade, since what is interpolated is the field and not the blade.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import NamedTuple

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.acoustics.sources.harmonic_sums import cos_sin

_MARGIN = 1e-3  # of the largest radius: rings that hold sources on one circle have a width, too
_AT_THE_HUB = 1e-6  # m, the least that is taken for the largest radius
_WITHIN = 1.0 - 1e-6  # of the half width; the margin is more


class Sources(NamedTuple):
    """Sources of one kind on a blade.

    Attributes
    ----------
    position : (n, 3) array
        Positions in the blade's frame at azimuth 0 [m].
    strengths : (n_components, n) array
        Strengths; of vectors the components along radius, azimuth and shaft.
    """

    position: Array
    strengths: Array


class Rings(NamedTuple):
    """Rings about the shaft, and what of the sources is on each.

    Attributes
    ----------
    radius, height : (n_rings,) arrays
        Where the rings are [m].
    weights : (n_rings, n_components, n_harmonics) complex array
        Strengths of all sources with their phases; the components of all kinds of sources.
    """

    radius: Array
    height: Array
    weights: Array


def rings_needed(highest_order: int) -> tuple[int, int]:
    """Rings along the radius and along the shaft that tell the field of a blade.

    Parameters
    ----------
    highest_order : int
        Highest multiple n of the rotation frequency that is heard.

    Returns
    -------
    n_radii, n_heights : int
        Numbers of rings.

    Notes
    -----
    Over the radius the field is like r^n in the limit of a slow rotor, whose Chebyshev series falls
    as exp(-k^2 / n) at the k-th term; along the shaft like exp(1j n M z / R), on a short way.
    """
    return 5 + int(np.ceil(2.0 * np.sqrt(highest_order))), 6 + highest_order // 16


def gathered(kinds: Sequence[Sources], n_blades: int, n_harmonics: int) -> Rings:
    """Gather sources of several kinds on the same rings.

    Parameters
    ----------
    kinds : sequence of Sources
        Sources of each kind.
    n_blades, n_harmonics : int
        Harmonics of the blade passage are those that are heard (static).

    Returns
    -------
    Rings
        Rings of `rings_needed` about all that have a strength, or one for each source where sources
        are fewer.
    """
    places = [_cylindrical(kind.position) for kind in kinds]
    orders = n_blades * np.arange(1, n_harmonics + 1)
    numbers = rings_needed(int(orders[-1]))
    if sum(place.radius.size for place in places) <= np.prod(numbers):
        radius, height, at_rings = _own_rings(places)
    else:
        strengths = [kind.strengths for kind in kinds]
        radius, height, at_rings = _common_rings(places, strengths, *numbers)
    weights = []
    for kind, place, pieces in zip(kinds, places, at_rings, strict=True):
        phases = jnp.concatenate(cos_sin(-orders[:, None] * place.azimuth))
        turned = (kind.strengths[:, None] * phases).reshape(-1, place.radius.size)
        turned = jax.lax.optimization_barrier(turned)
        on_rings = jnp.concatenate([piece @ turned.T for piece in pieces])
        weights.append(on_rings.reshape(radius.size, -1, 2, n_harmonics))
    real, imag = jnp.moveaxis(jnp.concatenate(weights, axis=1), 2, 0)
    return Rings(radius, height, real + 1j * imag)


class _Place(NamedTuple):
    """Cylindrical coordinates of sources; arrays (n,)."""

    radius: Array
    azimuth: Array
    height: Array


def _cylindrical(position: Array) -> _Place:
    """Radius, azimuth and height; sources on the shaft are at azimuth 0."""
    x, y, on_shaft = from_shaft(position)
    radius = jnp.where(on_shaft, 0.0, jnp.sqrt(x**2 + y**2))
    return _Place(radius, jnp.arctan2(y, x), position[:, 2])


def from_shaft(position: Array) -> tuple[Array, Array, Array]:
    """Coordinates across the shaft that have a direction, with derivatives, for every source.

    Parameters
    ----------
    position : (n, 3) array
        Positions in the blade's frame at azimuth 0 [m].

    Returns
    -------
    x, y, on_shaft : (n,) arrays
        Coordinates [m], 1 and 0 for sources on the shaft, and whether a source is one of these.
    """
    x, y, _ = position.T
    on_shaft = (x == 0.0) & (y == 0.0)
    return jnp.where(on_shaft, 1.0, x), jnp.where(on_shaft, 0.0, y), on_shaft


# Radii and heights of the rings; for each kind of sources the matrix that takes sources to rings,
# in pieces of some rings each.
_RingsOfSources = tuple[Array, Array, list[list[Array]]]


def _own_rings(places: list[_Place]) -> _RingsOfSources:
    """One ring for each source."""
    every = jax.tree.map(lambda *q: jnp.concatenate(q), *places)
    first_of_kind = np.cumsum([place.radius.size for place in places])[:-1]
    to_rings = jnp.split(jnp.eye(every.radius.size), first_of_kind, axis=1)
    return every.radius, every.height, [[matrix] for matrix in to_rings]


def _common_rings(
    places: list[_Place], strengths: list[Array], n_radii: int, n_heights: int
) -> _RingsOfSources:
    """Rings between all sources that have a strength."""
    every = jax.tree.map(lambda *q: jnp.concatenate(q), *places)
    audible = jnp.concatenate([jnp.any(kind != 0.0, axis=0) for kind in strengths])
    reach = jnp.max(jnp.where(audible, every.radius, _AT_THE_HUB))
    radii = _Nodes.about(every.radius, audible, _MARGIN * reach)
    heights = _Nodes.about(every.height, audible, _MARGIN * reach)
    height, radius = jnp.meshgrid(heights.places(n_heights), radii.places(n_radii), indexing="ij")
    pieces = []
    for place in places:
        at_radii = radii.polynomials(place.radius, n_radii)
        # Height by height: one product over all rings has a reverse derivative four times as slow.
        pieces.append(
            [at_radii * height_k for height_k in heights.polynomials(place.height, n_heights)]
        )
    return radius.ravel(), height.ravel(), pieces


class _Nodes(NamedTuple):
    """Chebyshev's nodes on a part of a line."""

    middle: Array
    half: Array

    @classmethod
    def about(cls, places: Array, audible: Array, margin: Array) -> _Nodes:
        """Take the part that holds all places where something is heard, or all where nothing is."""
        audible = audible | ~jnp.any(audible)
        first = jnp.min(jnp.where(audible, places, jnp.inf))
        last = jnp.max(jnp.where(audible, places, -jnp.inf))
        # Where the nodes are makes no difference, but for what interpolation leaves of the sum.
        return jax.lax.stop_gradient(cls(0.5 * (first + last), 0.5 * (last - first) + margin))

    def places(self, n: int) -> Array:
        """Places of n nodes."""
        return self.middle + self.half * np.cos(_angles(n))

    def polynomials(self, places: Array, n: int) -> Array:
        """Lagrange's polynomials of n nodes at places, (n, n_places)."""
        degree = np.arange(n)
        to_nodes = np.where(degree == 0, 1.0, 2.0) / n * np.cos(np.outer(_angles(n), degree))
        # What is not heard may lie anywhere.
        within = jnp.clip((places - self.middle) / self.half, -_WITHIN, _WITHIN)
        chebyshev, _ = cos_sin(degree[:, None] * jnp.arccos(within))
        return jax.lax.optimization_barrier(to_nodes @ jax.lax.optimization_barrier(chebyshev))


def _angles(n: int) -> np.ndarray:
    return np.pi * (np.arange(n) + 0.5) / n

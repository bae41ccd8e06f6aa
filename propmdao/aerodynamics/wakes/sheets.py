"""What the sheets behind the blades induce: rings of known circulation, and of that of the moment.

A sheet is rings between neighbouring filaments. Along a filament runs the difference of the strips
on its sides, across a strip the change from one ring to the next; the last ring is open, for the
wake goes on.
"""

from __future__ import annotations

import jax
import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.vortices.biot_savart import segment_normalwash, summed_velocities
from propmdao.aerodynamics.wakes.lags import shed
from propmdao.records.pytrees import record


@record
class Sheets:
    """Sheets behind all blades, at one moment.

    Attributes
    ----------
    nodes : (n_filaments, n_blades, n_nodes, 3) array
        Nodes of the filaments, from the trailing edge [m].
    trailing_core, shed_core : (n_nodes - 1,) arrays
        Core radius of the segments along the filaments, and across them at their younger end [m].
    """

    nodes: Array
    trailing_core: Array
    shed_core: Array

    def youngest(self, n_rings: int) -> Sheets:
        """The part of the sheets next to the blades, so many rings long."""
        return Sheets(
            self.nodes[:, :, : n_rings + 1],
            self.trailing_core[:n_rings],
            self.shed_core[:n_rings],
        )


def sheet_velocities(points: Array, sheets: Sheets, ring: Array, present: Array) -> Array:
    """Velocity at points by sheets of known circulation.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    sheets : Sheets
        Sheets of ns strips behind all blades.
    ring : (n_blades, ns, n_rings) array
        Circulation of their rings [m^2/s].
    present : (n_blades, ns) array
        Circulation of the strips of the blades [m^2/s].

    Returns
    -------
    (3, n_points) array
        Velocity [m/s].
    """
    n_blades = ring.shape[0]
    padded = jnp.pad(ring, ((0, 0), (1, 1), (0, 0)))
    along = (padded[:, :-1] - padded[:, 1:]).swapaxes(0, 1)
    across = shed(ring, present).swapaxes(0, 1)
    trailing_core, shed_core = (
        jnp.tile(core, n_blades) for core in (sheets.trailing_core, sheets.shed_core)
    )

    def of_filament(filament: tuple[Array, Array]) -> Array:
        nodes, strength = filament
        start, end = nodes[:, :-1].reshape(-1, 3), nodes[:, 1:].reshape(-1, 3)
        return summed_velocities(points, start, end, trailing_core, strength.ravel())

    def of_strip(strip: tuple[Array, Array, Array]) -> Array:
        start, end, strength = strip
        return summed_velocities(
            points, start.reshape(-1, 3), end.reshape(-1, 3), shed_core, strength.ravel()
        )

    of_filaments = jax.lax.map(of_filament, (sheets.nodes, along))
    edges = sheets.nodes[:, :, :-1]
    of_strips = jax.lax.map(of_strip, (edges[:-1], edges[1:], across))
    return of_filaments.sum(axis=0) + of_strips.sum(axis=0)


def normalwash_of_strips(points: Array, normals: Array, sheets: Sheets, now: Array) -> Array:
    """Normalwash by sheets per unit of the circulation that the strips have at the moment.

    Parameters
    ----------
    points, normals : (n_points, 3) arrays
        Points [m], and unit vectors along which the velocity is wanted.
    sheets : Sheets
        Sheets of ns strips behind all blades.
    now : (ns, n_rings) array
        Share of the strips' present circulation in their rings.

    Returns
    -------
    (n_blades, ns, n_points) array
        Normalwash per unit circulation of the strips of each blade [1/m].
    """
    n_blades = sheets.nodes.shape[1]
    trailing_core, shed_core = (
        jnp.tile(core, n_blades) for core in (sheets.trailing_core, sheets.shed_core)
    )

    def summed(nodes: tuple[Array, Array], core: Array, strength: Array) -> Array:
        start, end = (ends.reshape(-1, 3) for ends in nodes)
        unit = segment_normalwash(points, normals, start, end, core)
        return jnp.einsum("j,bjp->bp", strength, unit.reshape(n_blades, -1, points.shape[0]))

    def of_strip(strip: tuple[Array, Array, Array, Array]) -> Array:
        root, tip, ring, change = strip
        outer, inner = (
            summed((edge[:, :-1], edge[:, 1:]), trailing_core, ring) for edge in (tip, root)
        )
        return outer - inner + summed((root[:, :-1], tip[:, :-1]), shed_core, change)

    strips = sheets.nodes[:-1], sheets.nodes[1:], now, shed(now, jnp.ones(now.shape[0]))
    return jax.lax.map(of_strip, strips).swapaxes(0, 1)

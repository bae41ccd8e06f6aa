"""Loads of a blade and boundary layers of its sections, as sources of sound."""

from __future__ import annotations

import jax

from propmdao.records.pytrees import record


@record
class PointLoads:
    """Point forces on blade 1, constant in the rotating frame.

    Attributes
    ----------
    position : (n, 3) array
        Points at which the forces act, blade frame at azimuth 0 [m].
    force : (n, 3) array
        Force ON THE FLUID, blade frame at azimuth 0 [N].
    """

    position: jax.Array
    force: jax.Array


@record
class PeriodicLoads:
    """Forces of a blade that repeat every turn.

    Attributes
    ----------
    position : (n, 3) array
        Points at which the forces act, in the blade's frame [m].
    force : (n_azimuths, n, 3) array
        Force ON THE FLUID, components in the blade's frame [N], at equally spaced azimuths of the
        blade from 0; the last row is not the first again.
    """

    position: jax.Array
    force: jax.Array


@record
class EdgeSide:
    """Boundary layer of one side of sections at the trailing edge.

    Attributes
    ----------
    momentum_over_chord : array
        Momentum thickness theta over chord.
    shape_factor : array
        Shape factor H, displacement over momentum thickness.
    transition : array
        x/c of transition, 1 for a layer that is laminar up to the edge.
    edge_speed : array
        Velocity at the outer edge of the layer over that of the stream.
    """

    momentum_over_chord: jax.Array
    shape_factor: jax.Array
    transition: jax.Array
    edge_speed: jax.Array

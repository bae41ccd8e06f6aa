"""Loads of a blade, as sources of sound."""

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

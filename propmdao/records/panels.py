"""Panels of a closed surface, as sources of sound."""

from __future__ import annotations

import jax

from propmdao.records.pytrees import record


@record
class Panels:
    """Flat panels of a closed surface.

    Attributes
    ----------
    center : (n, 3) array
        Mean of the corners, blade frame at azimuth 0 [m].
    vector_area : (n, 3) array
        Area times the outward normal [m^2]; they sum to zero.
    """

    center: jax.Array
    vector_area: jax.Array

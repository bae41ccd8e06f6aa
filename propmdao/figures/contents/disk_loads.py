"""Loads of a blade at every azimuth of the disk."""

from __future__ import annotations

import jax
import numpy as np

from propmdao.aerodynamics.solutions.point_sums import strip_loads
from propmdao.aerodynamics.solutions.result import TiltedLoads
from propmdao.figures.contents.palette import Floats


def loads_over_disk(loads: TiltedLoads) -> dict[str, Floats]:
    """Thrust and angle of attack of a blade over the disk.

    Parameters
    ----------
    loads : TiltedLoads
        Loads of a turn.

    Returns
    -------
    dict of str to (n_azimuths, n_strips) array
        Thrust per span [N/m] and effective angle of attack [deg] of the blade that stands at each
        azimuth, by their name with its unit.
    """
    strips, (nc, ns) = loads.strips, loads.circulation.shape[1:]
    position, force = loads.point_loads.position, -loads.point_loads.force
    thrust = jax.vmap(lambda on_blade: strip_loads(position, on_blade, nc, ns)[0])(force)
    return {
        "thrust of a blade per span, N/m": np.asarray(thrust / strips.width),
        "effective angle of attack, deg": np.degrees(np.asarray(loads.sections.angle_of_attack)),
    }

"""Shape of the trailing edge, which broadband noise needs."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt

from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION

# The angle of Brooks, Pope and Marcolini is that of the surfaces upstream of the trailing edge
# (NASA RP-1218, figure 3). The last per cent of chord is where scanned and moulded blades are
# rounded, and where a spline through a sharp edge overshoots.
_SLOPING_PART = 0.945, 0.992


def _slope_weights() -> npt.NDArray[np.float64]:
    """Weights of the thickness on the shared grid that give its slope over the sloping part."""
    first, last = _SLOPING_PART
    x = np.where((first < CHORD_FRACTION) & (last > CHORD_FRACTION), CHORD_FRACTION, np.nan)
    deviation = np.nan_to_num(x - np.nanmean(x))
    weights: npt.NDArray[np.float64] = deviation / np.sum(deviation**2)
    return weights


def trailing_edge(blade: Blade, span: SpanInterpolation) -> tuple[jax.Array, jax.Array]:
    """Compute thickness and angle of the trailing edge.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        Interpolation to the n radii wanted.

    Returns
    -------
    thickness_over_chord : (n,) array
        Thickness of the blunt edge over chord, as described; that of the sections otherwise, 0
        where they are sharp or rounded.
    angle : (n,) array
        Angle between upper and lower surface ahead of the edge [rad], as described; that of a
        straight line through the thickness of the sections from 0.945 to 0.992 of the chord
        otherwise, negative where it grows toward the edge.
    """
    maximum = span.linear @ blade.thickness_over_chord
    edge = (span.linear @ blade.thickness_shape[:, -1]) * maximum
    if blade.edge_over_R is not None:
        edge = (span.linear @ blade.edge_over_R) / (span.smooth @ blade.chord_over_R)
    slope = (span.linear @ (blade.thickness_shape @ _slope_weights())) * maximum
    angle = 2.0 * jnp.arctan(-0.5 * slope)
    if blade.edge_angle is not None:
        angle = span.linear @ blade.edge_angle
    return edge, angle

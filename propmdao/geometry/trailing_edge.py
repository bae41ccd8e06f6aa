"""Shape of the trailing edge, which broadband noise needs."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION


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
        Thickness of the blunt edge over chord, 0 where the sections are sharp.
    angle : (n,) array
        Angle between upper and lower surface at the edge [rad].
    """
    maximum = span.linear @ blade.thickness_over_chord
    before, edge = ((span.linear @ blade.thickness_shape[:, k]) * maximum for k in (-2, -1))
    return edge, jnp.arctan((before - edge) / (1.0 - CHORD_FRACTION[-2]))

"""Shape of the trailing edge, which broadband noise asks for."""

from __future__ import annotations

import jax
import jax.numpy as jnp

from propmdao.geometry.blade import Blade, SpanInterpolation
from propmdao.propeller.airfoils.airfoil import CHORD_FRACTION


def trailing_edge(blade: Blade, span: SpanInterpolation) -> tuple[jax.Array, jax.Array]:
    """Thickness and angle of the trailing edge.

    Parameters
    ----------
    blade : Blade
        The blade.
    span : SpanInterpolation
        The n radii wanted.

    Returns
    -------
    thickness_over_chord : (n,) array
        Of the blunt edge, 0 where the sections are sharp.
    angle : (n,) array
        Between upper and lower surface [rad].
    """
    maximum = span.linear @ blade.thickness_over_chord
    before, at = ((span.linear @ blade.thickness_shape[:, k]) * maximum for k in (-2, -1))
    return at, jnp.arctan((before - at) / (1.0 - CHORD_FRACTION[-2]))

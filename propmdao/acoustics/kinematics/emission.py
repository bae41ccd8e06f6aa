"""Distance that sound travels to observers who fly on meanwhile, without iteration."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar


def emission_distance(ahead: Array, square: Array, mach_square: Scalar) -> Array:
    """Distance from a source at emission to an observer in uniform motion at reception.

    The distance is the root of d = |D + M d|, with D the vector from the source to the observer at
    emission and M the observer's velocity over the speed of sound.

    Parameters
    ----------
    ahead : array
        Scalar product M . D [m].
    square : array
        Squared distance at emission, D . D [m^2].
    mach_square : scalar
        Squared Mach number of the observer, M . M, below 1.

    Returns
    -------
    array
        Distance d that the sound travels [m].

    References
    ----------
    D. Casalino, An advanced time approach for acoustic analogy predictions, J. Sound Vib. 261
    (2003) 583-612.
    """
    beta2 = 1 - mach_square
    return (ahead + jnp.sqrt(ahead**2 + beta2 * square)) / beta2

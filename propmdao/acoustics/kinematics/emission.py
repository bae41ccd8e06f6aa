"""How far sound travels to observers that fly on meanwhile: the one root without iteration."""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.records.pytrees import Scalar


def emission_distance(ahead: Array, square: Array, mach_square: Scalar) -> Array:
    """Distance from a source at emission to an observer in uniform motion at reception.

    It is the root of d = |D + M d| with the vector D from the source to the observer at emission,
    and M the observer's velocity over the speed of sound.

    Parameters
    ----------
    ahead : array
        Product M . D [m].
    square : array
        Squared distance at emission, D . D [m^2].
    mach_square : scalar
        Squared Mach number of the observer, M . M, below 1.

    Returns
    -------
    array
        Distance d [m], the way of the sound.

    References
    ----------
    D. Casalino, An advanced time approach for acoustic analogy predictions, J. Sound Vib. 261
    (2003) 583-612.
    """
    beta2 = 1 - mach_square
    return (ahead + jnp.sqrt(ahead**2 + beta2 * square)) / beta2

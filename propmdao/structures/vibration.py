"""Small vibrations of a blade about an equilibrium."""

from __future__ import annotations

import jax
import jax.numpy as jnp
import numpy as np
import numpy.typing as npt
from jax import Array
from scipy.linalg import eigh

from propmdao.records.pytrees import Scalar
from propmdao.runtime.compilation import compiled
from propmdao.structures.beam import Beam, deformed, potential
from propmdao.structures.shapes import N_RADII, N_SHAPES, gauss

_, _WEIGHTS = gauss(N_RADII)


def natural_frequencies(
    beam: Beam, rotation_speed: Scalar, amplitudes: Array
) -> npt.NDArray[np.float64]:
    """Compute the natural frequencies of a blade, without air and without Coriolis forces.

    Parameters
    ----------
    beam : Beam
        The blade.
    rotation_speed : scalar
        Rotation speed [rad/s].
    amplitudes : (4, N_SHAPES) array
        Deflection about which it vibrates, of `equilibrium`.

    Returns
    -------
    (4 N_SHAPES,) array
        Frequencies [rad/s], rising; 0 for each way in which the blade does not stand, and the
        higher half is no more than a bound.

    Raises
    ------
    scipy.linalg.LinAlgError
        If a section has no mass.
    """
    stiffness, mass = _matrices(beam, jnp.asarray(rotation_speed, float), amplitudes.ravel())
    squares = eigh(np.asarray(stiffness), np.asarray(mass), eigvals_only=True)
    frequencies: npt.NDArray[np.float64] = np.sqrt(np.maximum(squares, 0.0))
    return frequencies


@compiled
def _matrices(beam: Beam, rotation_speed: Array, q: Array) -> tuple[Array, Array]:
    """Stiffness and mass matrices at the flat amplitudes q."""

    def stored(q: Array) -> Array:
        return potential(beam, rotation_speed, q.reshape(4, N_SHAPES))

    def moving(rate: Array) -> Array:
        """Kinetic energy of a small motion from the rates of the amplitudes [J]."""

        def displacement(q: Array) -> Array:
            return deformed(beam, q.reshape(4, N_SHAPES)).displacement

        velocity = jax.jvp(displacement, (q,), (rate,))[1]
        square = (beam.areas * (velocity**2).sum(-1)).sum(-1)
        return 0.5 * beam.material.density * beam.length * (jnp.asarray(_WEIGHTS) @ square)

    return jax.hessian(stored)(q), jax.hessian(moving)(jnp.zeros_like(q))

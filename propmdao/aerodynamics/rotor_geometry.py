"""A rotor as the lattice sees it: the corner points of one blade, and how many there are."""

from __future__ import annotations

import numpy as np
from jax import Array

from propmdao.records.pytrees import Scalar, record, static


@record
class RotorGeometry:
    """Equally spaced blades that are all alike.

    Attributes
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1, leading edge and root first [m].
    radius : scalar
        Tip radius [m].
    n_blades : int
        Number of blades, fixed at compile time.
    """

    nodes: Array
    radius: Scalar
    n_blades: int = static()

    @property
    def disk_area(self) -> Scalar:
        """Area that the blades sweep [m^2]."""
        return np.pi * self.radius**2

    @property
    def azimuths(self) -> np.ndarray:
        """Azimuths of the blades when blade 1 is at 0, (n_blades,) [rad]."""
        return 2.0 * np.pi / self.n_blades * np.arange(self.n_blades)

"""The lattice over a period of the rotor: what the blades induce at every azimuth of blade 1.

All is seen from blade 1. The blades around it stand still there, and each carries the circulation
that blade 1 has some azimuths later. So the unknowns are those of one blade, at all azimuths.
"""

from __future__ import annotations

import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE, blade_influence
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.lattice_loads import LatticeGeometry, lattice_geometry
from propmdao.geometry.lattice import strip_middle
from propmdao.records.pytrees import record
from propmdao.runtime import linear_algebra


@record
class PeriodLattice:
    """Part of the lattice that neither azimuth nor operating point changes.

    Attributes
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    influence : (n_blades, 3, n_panels, n_points) array
        Velocity at the lattice's points per unit circulation of the rings of each blade [1/m].
    ring_area, ring_middle : (n_panels, 3) arrays
        Vector area of the rings as far as the trailing edge, toward the suction side [m^2], and the
        middle of their corners [m].
    last_panel : (ns,) array
        Chordwise length of the last panels [m].
    """

    lattice: LatticeGeometry
    influence: Array
    ring_area: Array
    ring_middle: Array
    last_panel: Array

    @property
    def n_chordwise(self) -> int:
        """Chordwise panels."""
        return self.ring_middle.shape[0] // self.last_panel.shape[0]

    @property
    def load_positions(self) -> Array:
        """Points at which forces act: segments, middles of the rings, sections, (n, 3) [m]."""
        segments = self.lattice.points[self.ring_middle.shape[0] :]
        return jnp.concatenate([segments, self.ring_middle, self.lattice.strips.quarter_chord])


def period_lattice(rotor: RotorGeometry) -> PeriodLattice:
    """Lattice of blade 1 and what the rings of each blade induce there.

    Parameters
    ----------
    rotor : RotorGeometry
        Blade and number of blades.

    Returns
    -------
    PeriodLattice
        The lattice.
    """
    lattice = lattice_geometry(rotor)
    core = BOUND_CORE * rotor.radius

    def induced(azimuth: float) -> Array:
        return blade_influence(lattice.points, lattice.rings, np.array([azimuth]), core)

    influence = jnp.stack([induced(azimuth) for azimuth in rotor.azimuths])
    n_panels = lattice.rings.normal.shape[0]
    # The last ring reaches into the wake, a quarter of the panel beyond the trailing edge.
    corner, edge = lattice.rings.corner, rotor.nodes[-1:]
    corner = jnp.concatenate([corner[:-1], edge])
    first, second = corner[1:, 1:] - corner[:-1, :-1], corner[:-1, 1:] - corner[1:, :-1]
    middle = 0.25 * (corner[1:, 1:] + corner[:-1, :-1] + corner[:-1, 1:] + corner[1:, :-1])
    return PeriodLattice(
        lattice,
        influence.reshape(rotor.n_blades, 3, n_panels, -1),
        0.5 * jnp.cross(first, second).reshape(-1, 3),
        middle.reshape(-1, 3),
        _last_panel(rotor.nodes),
    )


def _last_panel(nodes: Array) -> Array:
    """Chordwise length of the last panels in the middle of their strips, (ns,) [m]."""
    length = jnp.linalg.norm(nodes[-1] - nodes[-2], axis=-1)
    f = jnp.asarray(strip_middle(nodes.shape[1] - 1))
    return (1.0 - f) * length[:-1] + f * length[1:]


def at_the_blades(of_azimuth: Array, n_blades: int) -> Array:
    """What each blade has where blade 1 stands at an azimuth, of what blade 1 has there.

    Parameters
    ----------
    of_azimuth : (n_azimuths, ...) array
        Anything of blade 1.
    n_blades : int
        Number of equally spaced blades.

    Returns
    -------
    (n_blades, n_azimuths, ...) array
        The same of each blade, the first of them blade 1.
    """
    step = of_azimuth.shape[0] // n_blades
    return jnp.stack([jnp.roll(of_azimuth, -step * b, axis=0) for b in range(n_blades)])


def bound_inverse(lattice: PeriodLattice) -> Array:
    """Circulation of the rings per normalwash on the blades, wake left out.

    The blades are alike, so their equations are circulant, and a Fourier transform over the blades
    leaves one matrix for each of its harmonics.

    Parameters
    ----------
    lattice : PeriodLattice
        Lattice of blade 1.

    Returns
    -------
    (n_blades, n_panels, n_panels) array
        Circulation of the rings of blade 1 (rows) per normalwash taken off at the panels of each
        blade [m].
    """
    normal = lattice.lattice.rings.normal
    on_panels = lattice.influence[..., : normal.shape[0]]
    # At the panels of blade 1 (rows) per unit circulation of each blade's rings.
    normalwash = jnp.einsum("bcrp,pc->bpr", on_panels, normal)
    n_blades = normalwash.shape[0]
    by_harmonic = n_blades * jnp.fft.ifft(normalwash, axis=0)
    return jnp.fft.fft(linear_algebra.inverse(by_harmonic), axis=0).real / n_blades

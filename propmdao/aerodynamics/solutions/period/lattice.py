"""The lattice over a period of the rotor: what blades and wake induce at every azimuth of blade 1.

All is seen from blade 1. The blades around it stand still there, and each carries the circulation
that blade 1 has some azimuths later; the wake is a rigid one for each azimuth, whose segments carry
circulation of the past. So the unknowns are those of one blade, at all azimuths.

What the wake induces is folded on the circulation of the strips at the azimuths before anything is
solved: with N azimuths, ns strips and np panels N^2 ns np numbers (50 MB for 36, 24 and 192).
"""

from __future__ import annotations

import dataclasses

import jax
import jax.numpy as jnp
import numpy as np
from jax import Array

from propmdao.aerodynamics.lattice.rings import BOUND_CORE, blade_influence
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.lattice_loads import LatticeGeometry, lattice_geometry
from propmdao.aerodynamics.vortices.biot_savart import segment_normalwash
from propmdao.aerodynamics.wakes.history import history_weights
from propmdao.aerodynamics.wakes.sheets import Sheets, velocities_of_strips
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
    def load_positions(self) -> Array:
        """Points at which forces act: segments, middles of the rings, sections, (n, 3) [m]."""
        segments = self.lattice.points[self.ring_middle.shape[0] :]
        return jnp.concatenate([segments, self.ring_middle, self.lattice.strips.quarter_chord])


@record
class PeriodWake:
    """Wake of all blades at every azimuth of blade 1.

    Attributes
    ----------
    sheets : Sheets
        Sheets behind all blades before they drift sideways.
    drift : (n_azimuths, n_nodes, 3) array
        Sideways displacement at each azimuth [m].
    ages : (n_nodes,) array
        Azimuths of the nodes behind their blade [rad].
    delay : (ns,) array
        Azimuth by which the circulation of each strip's wake is older than its nodes [rad].
    """

    sheets: Sheets
    drift: Array
    ages: Array
    delay: Array

    @property
    def weights(self) -> tuple[Array, Array]:
        """Weights of `history_weights`, of rings and shed segments."""
        n_blades = self.sheets.nodes.shape[1]
        return history_weights(self.ages, self.delay, self.drift.shape[0], n_blades)


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


def wake_normalwash(lattice: LatticeGeometry, wake: PeriodWake) -> Array:
    """Normalwash at the collocation points by the wake.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    wake : PeriodWake
        Wake of all blades.

    Returns
    -------
    (n_azimuths, n_azimuths, ns, n_panels) array
        Normalwash at an azimuth (first axis) per unit circulation of a strip at another [1/m].
    """
    points, normals = lattice.rings.collocation, lattice.rings.normal
    (ring, shed), (trailing_core, shed_core) = wake.weights, wake.sheets.cores
    n_azimuths = ring.shape[1]

    # One strip at a time: the block of segments x points stays in cache. The checkpoint keeps
    # reverse mode from storing every block.
    @jax.checkpoint
    def by_filament(nodes: Array) -> Array:
        start, end = nodes[:, :-1].reshape(-1, 3), nodes[:, 1:].reshape(-1, 3)
        return segment_normalwash(points, normals, start, end, trailing_core)

    @jax.checkpoint
    def of_strip(inner: Array, strip: tuple[Array, ...]) -> tuple[Array, Array]:
        root, tip, ring, shed = strip
        outer = by_filament(tip)
        start, end = (edge[:, :-1].reshape(-1, 3) for edge in (root, tip))
        across = segment_normalwash(points, normals, start, end, shed_core)
        return outer, ring @ (outer - inner) + shed @ across

    def at_azimuth(place: tuple[Array, Array]) -> Array:
        number, drift = place
        nodes = wake.sheets.nodes + drift
        strips = nodes[:-1], nodes[1:], ring, shed
        later = jax.lax.scan(of_strip, by_filament(nodes[0]), strips)[1]
        # From so many azimuths later to the azimuth itself.
        return later.swapaxes(0, 1)[(jnp.arange(n_azimuths) - number) % n_azimuths]

    return jax.lax.map(at_azimuth, (jnp.arange(n_azimuths), wake.drift))


def wake_velocities(points: Array, wake: PeriodWake, circulation: Array) -> Array:
    """Velocity at points of blade 1 by the wake of known circulation.

    Parameters
    ----------
    points : (n_points, 3) array
        Points at which the velocity is wanted [m].
    wake : PeriodWake
        Wake of all blades.
    circulation : (n_azimuths, ns) array
        Circulation of the strips at the azimuths of blade 1 [m^2/s].

    Returns
    -------
    (n_azimuths, 3, n_points) array
        Velocity at each azimuth [m/s].
    """
    of_rings, of_shed = wake.weights
    n_azimuths = of_rings.shape[1]

    def at_azimuth(place: tuple[Array, Array]) -> Array:
        number, drift = place
        later = circulation[(jnp.arange(n_azimuths) + number) % n_azimuths]
        ring, shed = (jnp.einsum("snc,ns->sc", weights, later) for weights in (of_rings, of_shed))
        sheets = dataclasses.replace(wake.sheets, nodes=wake.sheets.nodes + drift)
        return velocities_of_strips(points, sheets, ring, shed)

    return jax.lax.map(at_azimuth, (jnp.arange(n_azimuths), wake.drift))

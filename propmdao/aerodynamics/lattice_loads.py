"""Circulation and forces of the lattice for a wake that is already known.

Neumann condition at the collocation points, Kutta-Joukowski force on every bound and chordwise
segment with the total local velocity (Katz and Plotkin 2001, sections 12.3 and 3.11).
"""

from __future__ import annotations

import jax.numpy as jnp
from jax import Array

from propmdao.aerodynamics.rings import (
    Rings,
    blade_influence,
    bound_segments,
    chordwise_segments,
    segment_circulation,
    strip_middle,
    vortex_rings,
    wake_influence,
)
from propmdao.records import Scalar, record


@record
class LatticeGeometry:
    """What of the lattice does not change with the operating point.

    Attributes
    ----------
    rings : Rings
        Lattice of blade 1.
    points : (n_panels + n_segments, 3) array
        Collocation points, then points of the bound and chordwise segments' forces [m].
    segment : (n_segments, 3) array
        Bound, then chordwise segments, in the direction of positive circulation [m].
    influence : (3, nc, ns, n_panels + n_segments) array
        Velocity at the points per unit circulation of the rings of all blades, without
        wake [1/m].
    """

    rings: Rings
    points: Array
    segment: Array
    influence: Array


@record
class LatticeLoads:
    """Loads of blade 1.

    Attributes
    ----------
    circulation : (nc, ns) array
        Circulation of the rings [m^2/s].
    position : (n_segments, 3) array
        Where the forces act, bound segments (nc * ns) first, then chordwise (nc * (ns + 1)) [m].
    force : (n_segments, 3) array
        Force on the blade [N].
    """

    circulation: Array
    position: Array
    force: Array

    @property
    def thrust(self) -> Array:
        """Thrust of the blade [N]."""
        return self.force[:, 2].sum()

    @property
    def torque(self) -> Array:
        """Shaft torque the blade needs [N m]."""
        x, y = self.position[:, 0], self.position[:, 1]
        return -(x * self.force[:, 1] - y * self.force[:, 0]).sum()


def lattice_geometry(nodes: Array, n_blades: int, radius: Scalar) -> LatticeGeometry:
    """Rings, points and the part of the influence that no wake changes.

    Parameters
    ----------
    nodes : (nc + 1, ns + 1, 3) array
        Corner points of the lattice of blade 1 [m].
    n_blades : int
        Number of equally spaced blades.
    radius : float
        Tip radius [m].

    Returns
    -------
    LatticeGeometry
        The lattice.
    """
    rings = vortex_rings(nodes)
    (root, tip), (ahead, behind) = bound_segments(rings), chordwise_segments(rings)
    f = jnp.asarray(strip_middle(nodes.shape[1] - 1))[None, :, None]
    on_bound = (1.0 - f) * root + f * tip
    on_chordwise = 0.5 * (ahead + behind)
    points = jnp.concatenate(
        [rings.collocation, on_bound.reshape(-1, 3), on_chordwise.reshape(-1, 3)]
    )
    segment = jnp.concatenate([(tip - root).reshape(-1, 3), (behind - ahead).reshape(-1, 3)])
    influence = blade_influence(points, rings, n_blades, radius)
    return LatticeGeometry(rings, points, segment, influence)


def loads_with_wake(
    lattice: LatticeGeometry,
    wake_nodes: Array,
    wake_core_radius: Array,
    rotation_speed: Scalar,
    speed: Scalar,
    density: Scalar,
) -> LatticeLoads:
    """Solve for the circulation in a given wake and take the forces.

    Parameters
    ----------
    lattice : LatticeGeometry
        Lattice of blade 1.
    wake_nodes : (ns + 1, n_blades, n_nodes, 3) array
        Trailing filaments of all blades [m].
    wake_core_radius : (n_nodes - 1,) array
        Core radius along the filaments [m].
    rotation_speed, speed, density : float
        Rotation speed [rad/s], axial flight speed [m/s], air density [kg/m^3].

    Returns
    -------
    LatticeLoads
        Loads of blade 1.
    """
    nc, ns = lattice.influence.shape[1:3]
    points, normal = lattice.points, lattice.rings.normal
    n_panels = nc * ns
    by_wake = wake_influence(points, wake_nodes, wake_core_radius)
    influence = lattice.influence.at[:, -1].add(by_wake).reshape(3, n_panels, -1)

    # Velocity of the air relative to the turning and climbing blade: -Omega x r - V.
    x, y = points[:, 0], points[:, 1]
    apparent = jnp.stack([rotation_speed * y, -rotation_speed * x, jnp.full_like(x, -speed)])
    downwash = (influence[:, :, :n_panels] * normal.T[:, None, :]).sum(axis=0)
    onset = (apparent[:, :n_panels] * normal.T).sum(axis=0)
    circulation = jnp.linalg.solve(downwash.T, -onset)
    induced = jnp.tensordot(circulation, influence[:, :, n_panels:], axes=(0, 1))
    velocity = (apparent[:, n_panels:] + induced).T

    circulation = circulation.reshape(nc, ns)
    strength = jnp.concatenate([g.ravel() for g in segment_circulation(circulation)])
    force = density * strength[:, None] * jnp.cross(velocity, lattice.segment)
    return LatticeLoads(circulation, points[n_panels:], force)

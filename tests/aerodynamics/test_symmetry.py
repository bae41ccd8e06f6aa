"""One blade solved for B is all B blades solved."""

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.lattice.rings import Rings, blade_influence, wake_influence
from propmdao.aerodynamics.solutions.axial import WAKE_AGES, Flow, loads_at
from propmdao.aerodynamics.solutions.lattice_loads import lattice_geometry
from propmdao.aerodynamics.vortices.cores import core_radius
from propmdao.aerodynamics.wakes.helical import helical_wake

B = 3
OMEGA, SPEED, INDUCED, DENSITY = 420.0, 5.0, 3.0, 1.2


def turned(vectors, blade):
    angle = 2 * np.pi * blade / B
    matrix = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    return vectors @ jnp.asarray(matrix.T)


def test_one_blade_for_all_is_all_blades_solved(slow_flyer):
    nodes, radius = slow_flyer.nodes(3, 6), slow_flyer.radius
    lattice = lattice_geometry(nodes, B, radius)
    flow = Flow(lattice, radius, OMEGA, SPEED, DENSITY, None)
    by_symmetry = loads_at(flow, B, INDUCED).circulation

    # All blades on their own: unknowns of every blade, each with its own single-bladed influence.
    rings = [
        Rings(*(turned(a, b) for a in (lattice.rings.corner, *_points_and_normals(lattice.rings))))
        for b in range(B)
    ]
    ages = jnp.asarray(WAKE_AGES)
    core = core_radius(ages, OMEGA, 1.46e-5, 1e-4 * radius)
    rows = []
    for at in rings:
        row = []
        for of in rings:
            influence = blade_influence(at.collocation, of, 1, radius)
            wake = helical_wake(of.corner[-1], ages, B, radius, OMEGA, SPEED, INDUCED)[:, :1]
            influence = influence.at[:, -1].add(wake_influence(at.collocation, wake, core))
            row.append(jnp.einsum("cijp,pc->pij", influence, at.normal).reshape(18, 18))
        rows.append(row)
    onset = [
        OMEGA * (r.collocation[:, 1] * r.normal[:, 0] - r.collocation[:, 0] * r.normal[:, 1])
        - SPEED * r.normal[:, 2]
        for r in rings
    ]
    all_blades = np.linalg.solve(np.block(rows), -np.concatenate(onset)).reshape(B, 3, 6)
    for blade in range(B):
        np.testing.assert_allclose(all_blades[blade], by_symmetry, rtol=1e-9)


def _points_and_normals(rings):
    return rings.collocation, rings.normal

"""One blade solved for B is all B blades solved."""

import jax.numpy as jnp
import numpy as np

from propmdao.aerodynamics.lattice.rings import (
    Rings,
    blade_influence,
    blade_normalwash,
    segment_circulation,
)
from propmdao.aerodynamics.lattice.steady_wake import wake_influence
from propmdao.aerodynamics.solutions.axial import flow_at, loads_at
from propmdao.aerodynamics.vortices.cores import core_radius, middles
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
    case = slow_flyer.case(OMEGA, SPEED, DENSITY, n_blades=B, nodes=nodes)
    flow = flow_at(case)
    lattice = flow.lattice
    by_symmetry = loads_at(flow, INDUCED).circulation

    # All blades on their own: unknowns of every blade, each with its own single-bladed influence.
    rings = [
        Rings(*(turned(a, b) for a in (lattice.rings.corner, *_points_and_normals(lattice.rings))))
        for b in range(B)
    ]
    core = core_radius(middles(jnp.asarray(case.wake.ages)), case.state, 1e-4 * radius)
    rows = []
    for felt in rings:
        row = []
        for inducing in rings:
            influence = blade_influence(felt.collocation, inducing, np.zeros(1), 1e-4 * radius)
            wake = helical_wake(inducing.corner[-1], case.wake, case.rotor, case.state, INDUCED)[
                :, :1
            ]
            influence = influence.at[:, -1].add(wake_influence(felt.collocation, wake, core))
            row.append(jnp.einsum("cijp,pc->pij", influence, felt.normal).reshape(18, 18))
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


def test_blades_summed_in_one_call_are_the_sum_of_their_own(slow_flyer):
    flow = flow_at(slow_flyer.case(OMEGA, SPEED, n_blades=B, nodes=slow_flyer.nodes(3, 6)))
    rotor, rings = flow.case.rotor, flow.lattice.rings
    core = 1e-4 * slow_flyer.radius
    each = [
        blade_influence(flow.lattice.points, rings, azimuth[None], core)
        for azimuth in rotor.azimuths
    ]
    normalwash = jnp.einsum("cijp,pc->ijp", sum(each)[..., :18], rings.normal)
    together = blade_normalwash(rings, rotor.azimuths, core)
    np.testing.assert_allclose(together, normalwash, rtol=1e-11, atol=1e-11)
    circulation = jnp.asarray(np.random.default_rng(0).normal(size=(3, 6)))
    velocity = jnp.tensordot(circulation, sum(each)[..., 18:], axes=((0, 1), (1, 2)))
    of_segments = flow.blades.segments.velocities(segment_circulation(circulation))
    # Summed one by one, what segments induce on themselves is the rounding of large numbers, 1e-9.
    np.testing.assert_allclose(of_segments, velocity, atol=1e-7)

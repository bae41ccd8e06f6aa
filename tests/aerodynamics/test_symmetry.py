"""One blade solved for B is all B blades solved."""

from functools import partial

import jax
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
from propmdao.runtime.compilation import compiled

B = 3
OMEGA, SPEED, INDUCED, DENSITY = 420.0, 5.0, 3.0, 1.2


def turned(vectors, blade):
    angle = 2 * np.pi * blade / B
    matrix = np.array(
        [[np.cos(angle), -np.sin(angle), 0], [np.sin(angle), np.cos(angle), 0], [0, 0, 1]]
    )
    return vectors @ jnp.asarray(matrix.T)


@partial(compiled, optimisation=0)
def by_symmetry_and_each(case):
    """Circulation of one blade solved for all, and of all blades with unknowns of their own."""
    flow = flow_at(case)
    lattice, radius = flow.lattice, case.rotor.radius
    by_symmetry = loads_at(flow, INDUCED).circulation
    of_one = lattice.rings
    rings = [
        Rings(*(turned(a, b) for a in (of_one.corner, of_one.collocation, of_one.normal)))
        for b in range(B)
    ]
    each = jax.tree.map(lambda *of_blades: jnp.stack(of_blades), *rings)
    core = core_radius(middles(jnp.asarray(case.wake.ages)), case.state, 1e-4 * radius)

    @partial(jax.vmap, in_axes=(0, None))
    @partial(jax.vmap, in_axes=(None, 0))
    def normalwash(felt, inducing):
        influence = blade_influence(felt.collocation, inducing, np.zeros(1), 1e-4 * radius)
        wake = helical_wake(inducing.corner[-1], case.wake, case.rotor, case.state, INDUCED)[:, :1]
        influence = influence.at[:, -1].add(wake_influence(felt.collocation, wake, core))
        return jnp.einsum("cijp,pc->pij", influence, felt.normal).reshape(18, 18)

    matrix = normalwash(each, each).swapaxes(1, 2).reshape(18 * B, 18 * B)
    onset = [
        OMEGA * (r.collocation[:, 1] * r.normal[:, 0] - r.collocation[:, 0] * r.normal[:, 1])
        - SPEED * r.normal[:, 2]
        for r in rings
    ]
    all_blades = jnp.linalg.solve(matrix, -jnp.concatenate(onset)).reshape(B, 3, 6)
    return by_symmetry, all_blades


def test_one_blade_for_all_is_all_blades_solved(slow_flyer):
    nodes = slow_flyer.nodes(3, 6)
    case = slow_flyer.case(OMEGA, SPEED, DENSITY, n_blades=B, nodes=nodes)
    by_symmetry, all_blades = by_symmetry_and_each(case)
    for blade in range(B):
        np.testing.assert_allclose(all_blades[blade], by_symmetry, rtol=1e-9)


@partial(compiled, optimisation=0)
def together_and_each(case, circulation):
    """Normalwash and velocities on segments of all blades in one call, and of each by itself."""
    flow = flow_at(case)
    azimuths, rings, core = case.rotor.azimuths, flow.lattice.rings, 1e-4 * case.rotor.radius
    each = [
        blade_influence(flow.lattice.points, rings, azimuth[None], core) for azimuth in azimuths
    ]
    together = blade_normalwash(rings, azimuths, core)
    of_segments = flow.blades.segments.velocities(segment_circulation(circulation))
    return together, of_segments, jnp.stack(each), rings.normal


def test_blades_summed_in_one_call_are_the_sum_of_their_own(slow_flyer):
    case = slow_flyer.case(OMEGA, SPEED, n_blades=B, nodes=slow_flyer.nodes(3, 6))
    circulation = np.random.default_rng(0).normal(size=(3, 6))
    found = together_and_each(case, jnp.asarray(circulation))
    together, of_segments, each, normal = (np.asarray(q) for q in found)
    normalwash = np.einsum("cijp,pc->ijp", each.sum(axis=0)[..., :18], normal)
    np.testing.assert_allclose(together, normalwash, rtol=1e-11, atol=1e-11)
    velocity = np.tensordot(circulation, each.sum(axis=0)[..., 18:], axes=((0, 1), (1, 2)))
    # Summed one by one, what segments induce on themselves is the rounding of large numbers, 1e-9.
    np.testing.assert_allclose(of_segments, velocity, atol=1e-7)

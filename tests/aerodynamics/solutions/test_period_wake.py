"""What the wake of a period induces: against sums over all its segments at every point."""

import dataclasses
from functools import partial

import jax.numpy as jnp
import numpy as np
import pytest

from propmdao.aerodynamics.lattice.steady_wake import steady_wake
from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.period.lattice import period_lattice
from propmdao.aerodynamics.solutions.period.onset import azimuths_of
from propmdao.aerodynamics.solutions.period.wake import (
    PeriodWake,
    wake_normalwash,
    wake_velocities,
)
from propmdao.aerodynamics.vortices.biot_savart import segment_velocities
from propmdao.aerodynamics.vortices.cores import middles
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.sheets import Sheets
from propmdao.records.wake_law import WakeGrid
from propmdao.runtime.compilation import compiled

B, NC, NS, CORE, NEAR = 2, 4, 8, 1e-3, 12
AGES = wake_azimuths(WakeGrid(1.25, 1.0, 1.4, 20.0))
DELAY = jnp.linspace(0.0, 0.05, NS)


lattice_of = compiled(period_lattice, optimisation=0)


velocities_of = compiled(segment_velocities, optimisation=0)
normalwash_by = compiled(wake_normalwash, optimisation=0)
velocities_by = compiled(wake_velocities, optimisation=0)


@partial(compiled, static_argnums=(2, 3), optimisation=0)
def steady_flow(lattice, sheets, rings, n_panels, circulation):
    """Normalwash and velocities on segments of the steady lattice's wake."""
    steady = steady_wake(lattice.points, lattice.lines, sheets.nodes, sheets.trailing_core, rings)
    normalwash = circulation @ steady.normalwash(lattice.rings.normal, lattice.lines)
    return normalwash, steady.velocities(circulation, n_panels)


@pytest.fixture(scope="module")
def blade(slow_flyer):
    return lattice_of(RotorGeometry(slow_flyer.nodes(NC, NS), slow_flyer.radius, B))


def circulation_of(n):
    span, psi = np.sin(np.pi * (np.arange(NS) + 0.5) / NS), azimuths_of(n)[:, None]
    return span * (1.0 + 0.3 * np.cos(psi) + 0.1 * np.sin(2.0 * psi + span))


def wake_of(lattice, n, drifting, near, pitch):
    """A helix that leaves by a pitch in radii per turn, and drifts sideways or not."""
    edge, psi = np.asarray(lattice.lattice.rings.corner[-1]), azimuths_of(n)
    radius = np.hypot(*edge[-1, :2])
    turn = 2 * np.pi / B * np.arange(B)[:, None] - AGES
    x = np.cos(turn) * edge[:, 0, None, None] - np.sin(turn) * edge[:, 1, None, None]
    y = np.sin(turn) * edge[:, 0, None, None] + np.cos(turn) * edge[:, 1, None, None]
    z = edge[:, 2, None, None] - pitch * radius * AGES / (2 * np.pi) + 0.0 * turn
    backward = np.stack([-np.cos(psi), np.sin(psi), 0.0 * psi], axis=-1)
    core = jnp.full(AGES.size - 1, CORE * radius)
    return PeriodWake(
        sheets=Sheets(jnp.asarray(np.stack([x, y, z], axis=-1)), core, core),
        drift=jnp.asarray(0.1 * drifting * radius * AGES[:, None] * backward[:, None]),
        ages=jnp.asarray(AGES),
        delay=DELAY,
        n_near=near,
    )


def summed(points, wake, circulation, numbers):
    """Velocity (n_numbers, 3, n_points) at some azimuths by every ring, one by one."""
    n, n_rings, core = len(circulation), AGES.size - 1, float(wake.sheets.trailing_core[0])
    behind = np.asarray(middles(AGES)) + np.asarray(DELAY)[:, None]
    total = []
    for k in numbers:
        nodes, velocity = np.asarray(wake.sheets.nodes + wake.drift[k]), 0.0
        for b in range(B):
            # The cubic through the four nearest azimuths.
            place = (k + n // B * b - behind * n / (2 * np.pi))[..., None]
            near = np.floor(place).astype(int) + np.arange(-1, 3)
            weight = np.ones_like(near, dtype=float)
            for i in range(4):
                for j in set(range(4)) - {i}:
                    at = near[..., i] - near[..., j]
                    weight[..., i] *= (place[..., 0] - near[..., j]) / at
            ring = (weight * circulation[near % n, np.arange(NS)[:, None, None]]).sum(axis=-1)
            now = circulation[(k + n // B * b) % n]
            change = np.diff(np.column_stack([now, ring]), axis=1)
            along = np.diff(np.pad(-ring, ((1, 1), (0, 0))), axis=0)
            of_blade = nodes[:, b]
            ends = (
                (of_blade[:, :-1], of_blade[:, 1:], along),
                (of_blade[:-1, :n_rings], of_blade[1:, :n_rings], change),
            )
            for start, end, strength in ends:
                start, end = (jnp.asarray(x.reshape(1, -1, 3)) for x in (start, end))
                unit = velocities_of(points, start, end, core)
                velocity = velocity + np.einsum("csp,s->cp", unit, strength.ravel())
        total.append(velocity)
    return np.array(total)


def by_lattice(lattice, wake, circulation):
    """Normalwash at the collocation points, and velocity at the segments, by the solution's way."""
    folded = np.einsum("kqsp,qs->kp", normalwash_by(lattice, wake), circulation)
    return folded, np.asarray(velocities_by(lattice, wake, jnp.asarray(circulation)))


@pytest.mark.parametrize(
    ("n", "near", "drifting", "constant", "pitch"),
    [
        (8, NEAR, False, True, 0.2),  # the steady wake
        (8, None, True, False, 0.2),  # every ring at every point
        (8, NEAR, True, False, 0.2),  # flow that is read between the points of a strip
        (36, None, True, False, 0.6),  # and between azimuths, from which wakes nearby are too far
    ],
)
def test_the_wake_induces_what_all_its_rings_induce(blade, n, near, drifting, constant, pitch):
    circulation = circulation_of(n)
    if constant:
        circulation = np.broadcast_to(circulation[0], circulation.shape)
    wake, geometry = wake_of(blade, n, drifting, near, pitch), blade.lattice
    numbers = [0, 1, n // 4 + 2, n - 1]
    direct = summed(geometry.points, wake, circulation, numbers)
    folded, velocity = (x[np.array(numbers)] for x in by_lattice(blade, wake, circulation))
    n_panels = NC * NS
    normalwash = np.einsum("kcp,pc->kp", direct[:, :, :n_panels], geometry.rings.normal)
    # Where chordwise segments lie between strips as coarse as what is under them, loads tell.
    exact = near is None and n == 8
    tolerance, n_read = (1e-11, None) if exact else (0.01, n_panels if near else None)
    on_segments = direct[:, :, n_panels:]
    for read, all_rings in (
        (folded, normalwash),
        (velocity[:, :, :n_read], on_segments[:, :, :n_read]),
    ):
        np.testing.assert_allclose(read, all_rings, atol=tolerance * np.abs(all_rings).max())


def test_the_wake_of_axial_flight_is_that_of_the_steady_lattice(slow_flyer):
    # Fine enough that what is older than a turn is read more coarsely there.
    n, nc, ns, rings = 4, 6, 16, (NEAR, AGES.size - 5)
    nodes = slow_flyer.nodes(nc, ns)
    lattice = lattice_of(RotorGeometry(nodes, slow_flyer.radius, B))
    wake = dataclasses.replace(
        wake_of(lattice, n, False, NEAR, 0.2), delay=jnp.zeros(ns), n_turn=rings[1]
    )
    circulation = np.broadcast_to(np.sin(np.pi * (np.arange(ns) + 0.5) / ns), (n, ns))
    geometry, sheets = lattice.lattice, wake.sheets
    normalwash, on_segments = steady_flow(
        geometry, sheets, rings, nc * ns, jnp.asarray(circulation[0])
    )
    folded, velocity = by_lattice(lattice, wake, circulation)
    for k in range(n):
        for read, expected in ((folded[k], normalwash), (velocity[k], on_segments)):
            np.testing.assert_allclose(read, expected, atol=1e-11 * np.abs(expected).max())

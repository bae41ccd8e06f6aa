"""Unsteady Kutta condition, shed wake and Bernoulli's term on a wing: Theodorsen's function.

The period of a rotor is that of a wing that heaves in its own stream: one blade, a straight wake.
T. Theodorsen, General theory of aerodynamic instability and the mechanism of flutter, NACA Report
496, 1935: with the half chord b, k = omega b / U and the upwash w exp(i omega t) of heave,

    L = pi rho b^2 dw/dt + 2 pi rho U b C(k) w.
"""

import jax
import jax.numpy as jnp
import numpy as np
import pytest
from scipy.special import hankel2

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.period.lattice import period_lattice
from propmdao.aerodynamics.solutions.period.loads import period_loads
from propmdao.aerodynamics.solutions.period.onset import PeriodOnset, azimuths_of
from propmdao.aerodynamics.solutions.period.wake import PeriodWake
from propmdao.aerodynamics.wakes.ages import wake_azimuths
from propmdao.aerodynamics.wakes.history import shedding_delay
from propmdao.aerodynamics.wakes.sheets import Sheets
from propmdao.geometry.lattice import lattice_chord_fraction
from propmdao.records.air import Air
from propmdao.records.wake_law import WakeGrid

SPEED, DENSITY, CHORD, HEAVE = 10.0, 1.2, 1.0, 0.1
SPAN, NC, NS, N = 400.0, 8, 11, 24
MIDDLE = NS // 2


@pytest.fixture(scope="module")
def lift():
    """Lift per span in the middle of a long flat wing, (N,), as a function of the frequency."""
    eta = -np.cos(np.linspace(0.0, np.pi, NS + 1))
    # Leading to trailing edge along -z, span along x: the suction side looks to -y.
    z = -CHORD * lattice_chord_fraction(NC)[:, None] + 0.0 * eta
    nodes = jnp.asarray(np.stack([0.5 * SPAN * eta + 0.0 * z, 0.0 * z, z], axis=-1))
    lattice = period_lattice(RotorGeometry(nodes, 1.0, 1))
    ages = jnp.asarray(wake_azimuths(WakeGrid(10.0, 0.5, 1.2, 15.0)))
    edge = lattice.lattice.rings.corner[-1]
    width = float(nodes[0, MIDDLE + 1, 0] - nodes[0, MIDDLE, 0])
    upwash = HEAVE * np.cos(azimuths_of(N))

    @jax.jit
    def solve(omega):
        behind = SPEED / omega * ages[:, None] * jnp.array([0.0, 0.0, -1.0])
        delay = shedding_delay(lattice.last_panel, SPEED / omega * ages[1]) / SPEED * omega
        core = jnp.full(ages.size - 1, 1e-6)
        wake = PeriodWake(
            sheets=Sheets(edge[:, None, None, :] + behind, core, core),
            drift=jnp.zeros((N, ages.size, 3)),
            ages=ages,
            delay=delay,
        )
        velocity = jnp.zeros((N, 3, lattice.lattice.points.shape[0])).at[:, 2].set(-SPEED)
        onset = PeriodOnset(
            velocity=velocity.at[:, 1].set(-upwash[:, None]),
            relative_speed=jnp.full((N, NS), SPEED),
            attached=jnp.ones((N, NS)),
            motion_angle=jnp.zeros((N, NS)),
            turning_share=jnp.ones(NS),
        )
        loads = period_loads(lattice, wake, onset, omega, Air(density=DENSITY), None)
        segments, rings = loads.force[:, : NC * NS], loads.force[:, -NS - NC * NS : -NS]
        normal = -(segments + rings)[..., 1].reshape(N, NC, NS)
        return normal[:, :, MIDDLE].sum(axis=1) / width

    return solve


@pytest.mark.parametrize("k", [0.05, 0.2, 0.6])
def test_lift_of_a_heaving_wing_is_theodorsens(lift, k):
    half = 0.5 * CHORD
    omega = k * SPEED / half
    found = 2.0 / N * np.sum(np.asarray(lift(omega)) * np.exp(-1j * azimuths_of(N)))
    h0, h1 = hankel2(0, k), hankel2(1, k)
    circulatory = 2.0 * np.pi * DENSITY * SPEED * half * h1 / (h1 + 1j * h0)
    expected = HEAVE * (np.pi * DENSITY * half**2 * 1j * omega + circulatory)
    assert abs(found / expected - 1.0) < 0.02

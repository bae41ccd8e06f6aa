"""How far the default lattice and wake are from finer ones: as docs/verification.md shows."""

import numpy as np
import pytest

from propmdao.aerodynamics.solutions.axial import WAKE_AGES, solve_steady
from propmdao.aerodynamics.wakes.ages import wake_azimuths

OMEGA, SPEED = 440.0, 8.0
DEG = np.pi / 180.0


@pytest.fixture(scope="module")
def loads(slow_flyer):
    """Thrust and torque on the lattice (nc, ns) with the wake's nodes at given ages."""

    def solve(n_chordwise=8, n_spanwise=24, ages=WAKE_AGES, speed=SPEED):
        nodes = slow_flyer.nodes(n_chordwise, n_spanwise)
        solution = solve_steady(nodes, 2, slow_flyer.radius, OMEGA, speed, 1.225, wake_ages=ages)
        return np.array([solution.thrust, solution.torque])

    return solve


@pytest.mark.parametrize(
    ("lattice", "error"), [((4, 24), 0.12), ((12, 24), 0.009), ((8, 12), 0.002), ((8, 36), 0.001)]
)
def test_lattice(loads, lattice, error):
    np.testing.assert_allclose(loads(*lattice), loads(), rtol=error)


@pytest.mark.parametrize(("speed", "error"), [(0.0, 0.015), (SPEED, 0.003)])
def test_helix_step_and_wake_length(loads, speed, error):
    # Hover is the hardest: the wake leaves slowly, so that turns are close and many count.
    reference = loads(ages=wake_azimuths(16.0, 2 * DEG, 1.03, 10 * DEG), speed=speed)
    np.testing.assert_allclose(loads(speed=speed), reference, rtol=error)

"""How far the default lattice and wake are from finer ones: as docs/verification.md shows."""

import dataclasses

import numpy as np
import pytest

from propmdao.aerodynamics.solutions.axial import solve
from propmdao.aerodynamics.wakes.helical import wake_transport
from propmdao.records.wake_law import WakeGrid

SPEED = 8.0


@pytest.fixture(scope="module")
def loads(slow_flyer):
    """Thrust and torque on the lattice (nc, ns) with the wake's nodes on a grid."""

    def thrust_and_torque(n_chordwise=8, n_spanwise=24, grid=WakeGrid(), speed=SPEED):  # noqa: B008
        case = slow_flyer.case(speed=speed, nodes=slow_flyer.nodes(n_chordwise, n_spanwise))
        solution = solve(dataclasses.replace(case, wake=wake_transport(grid=grid)))
        return np.array([solution.thrust, solution.torque])

    return thrust_and_torque


@pytest.mark.parametrize(
    ("lattice", "error"),
    [
        pytest.param((4, 24), 0.12, marks=pytest.mark.slow),
        ((12, 24), 0.009),
        ((8, 12), 0.002),
        pytest.param((8, 36), 0.001, marks=pytest.mark.slow),
    ],
)
def test_lattice(loads, lattice, error):
    np.testing.assert_allclose(loads(*lattice), loads(), rtol=error)


@pytest.mark.parametrize(("speed", "error"), [(0.0, 0.015), (SPEED, 0.003)])
def test_helix_step_and_wake_length(loads, speed, error):
    # Hover is the hardest: the wake leaves slowly, so that turns are close and many count.
    reference = loads(grid=WakeGrid(16.0, 2.0, 1.03, 10.0), speed=speed)
    np.testing.assert_allclose(loads(speed=speed), reference, rtol=error)

"""Blades and air that the aerodynamics tests share."""

import pytest

from propmdao.aerodynamics.rotor_geometry import RotorGeometry
from propmdao.aerodynamics.solutions.case import RotorCase
from propmdao.formats.propellers import load_propeller
from propmdao.geometry.blade import Blade
from propmdao.geometry.lattice import lattice_interpolation, lattice_nodes
from propmdao.records.air import Air
from propmdao.records.states import RotorState


class SlowFlyer:
    """APC-SF 11x4.7 as an array maker: `nodes(nc, ns)`."""

    radius = 0.1397
    n_blades = 2
    density = 1.225

    def __init__(self) -> None:
        propeller = load_propeller("apcsf_11x4.7_uiuc")
        self.stations = propeller.r_over_R
        self.blade = Blade.from_propeller(propeller)

    def nodes(self, n_chordwise: int = 4, n_spanwise: int = 10):
        """Lattice of the blade, coarse by default so that the tests are quick."""
        span = lattice_interpolation(self.stations, n_spanwise)
        return lattice_nodes(self.blade, span, n_chordwise)

    def case(self, rotation_speed=440.0, speed=8.0, density=1.225, n_blades=2, nodes=None):
        """The rotor as the solvers take it, in inviscid flow."""
        nodes = self.nodes() if nodes is None else nodes
        state = RotorState(rotation_speed, speed, Air(density=density))
        return RotorCase(RotorGeometry(nodes, self.radius, n_blades), state)


@pytest.fixture(scope="session")
def slow_flyer() -> SlowFlyer:
    return SlowFlyer()
